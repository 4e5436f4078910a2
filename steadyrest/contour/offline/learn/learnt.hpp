// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// What records of parts have taught, by original path length: how the command must be displaced
/// for the tool at that place, and what the model does not know of the tool's error there.
class Learnt {
 public:
  struct Knot {
    double at_mm = 0.0;
    kernel::signal::Point shift_mm{};    ///< of the command
    kernel::signal::Point unknown_mm{};  ///< from the tool to its foot, beyond the model
    double weight = 1.0;                 ///< falls to 0 beside what was left out
  };
  /// A part of the path without a corner or a gap; between two knots it is interpolated.
  struct Stretch {
    double from_mm = 0.0;
    double to_mm = 0.0;
    std::vector<Knot> knots;  ///< ascending, at least one
  };

  /// The stretches of one record, ascending, not overlapping.
  void add(std::vector<Stretch> stretches) { parts_.push_back(std::move(stretches)); }

  /// A displacement on top of the records': refinements add up.
  void refine(std::vector<Stretch> stretches) { refinements_.push_back(std::move(stretches)); }
  [[nodiscard]] std::size_t refinements() const noexcept { return refinements_.size(); }
  /// Takes the later ones back.
  void unrefine(std::size_t keep) { refinements_.resize(keep); }

  [[nodiscard]] bool empty() const noexcept { return parts_.empty(); }
  /// A record has shown what the tool does there.
  [[nodiscard]] bool covers(double at_mm) const noexcept { return mean(at_mm).weight > 0.0; }
  /// 0 where nothing was learnt; of several records the mean by their weights.
  [[nodiscard]] kernel::signal::Point shift_mm(double at_mm) const noexcept;
  [[nodiscard]] kernel::signal::Point unknown_mm(double at_mm) const noexcept;

 private:
  [[nodiscard]] Knot mean(double at_mm) const noexcept;

  std::vector<std::vector<Stretch>> parts_;
  std::vector<std::vector<Stretch>> refinements_;
};

}  // namespace steadyrest::contour::offline
