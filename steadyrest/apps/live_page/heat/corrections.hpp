// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::apps::live_page {

/// One move of an axis's offset against heat.
struct Correction {
  double from_s = 0.0;  ///< when its first step was complete
  double to_s = 0.0;    ///< and its last
  std::size_t axis = 0;
  double from_mm = 0.0;
  double to_mm = 0.0;
};

/// Lists what an offset does. The layer has it follow the displacement without steps, so a
/// correction is each whole micrometre of it, from 0 on; changes of the same axis and direction
/// less than two seconds apart are one.
class Corrections {
 public:
  static constexpr double kStep_mm = 0.001;
  static constexpr std::size_t kMost = 500;

  /// In order of time.
  void see(double time_s, const kernel::signal::AxisValues& offset_mm, std::size_t axes);
  [[nodiscard]] const std::deque<Correction>& list() const noexcept { return list_; }
  /// With the same offsets, but nothing listed yet.
  [[nodiscard]] Corrections from_here() const {
    Corrections out;
    out.listed_mm_ = listed_mm_;
    return out;
  }

 private:
  [[nodiscard]] Correction* still_moving(std::size_t axis, double time_s, double change_mm);

  kernel::signal::AxisValues listed_mm_{};
  std::deque<Correction> list_;  ///< the newest kMost
};

}  // namespace steadyrest::apps::live_page
