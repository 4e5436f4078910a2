// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>

namespace steadyrest::nc::rewrite {

/// In a mask of axes.
[[nodiscard]] constexpr std::uint32_t axis_bit(std::size_t axis) noexcept {
  return std::uint32_t{1} << axis;
}

/// What a line says about how its positions are meant.
struct Frames {
  bool incremental = false;        ///< G91
  bool machine = false;            ///< G53, SUPA, G28, G30
  std::uint32_t acts_at_once = 0;  ///< axes whose new correction must act in this line, a mask
};

/// How far the machine of the changed program is from that of the original, move by move.
///
/// A move must end at the shift that is wanted; or, where the original leaves the axis alone or
/// moves it by increments, at the shift that it began with; or at none, where the original goes to
/// machine coordinates. Arcs, splines, threads and probes keep what they begin with.
class Shifts {
 public:
  explicit Shifts(const Plan& plan);

  /// A pair of moves: the fault, empty when there is none.
  [[nodiscard]] std::string pair(const interpret::Move& before, const interpret::Move& after,
                                 const Frames& frames);
  /// A move that the original has not: a rapid of planned axes, by `most_mm` at most.
  [[nodiscard]] std::string add(const interpret::Move& move, double most_mm);

  [[nodiscard]] double now(std::size_t axis) const noexcept { return shift_[axis]; }
  [[nodiscard]] bool any() const noexcept {
    return std::ranges::any_of(shift_, [](double mm) { return !same(mm, 0.0); });
  }
  [[nodiscard]] double largest_error_mm() const noexcept { return largest_error_mm_; }

  interpret::Axes wanted{};  ///< the correction that stands by the plan

 private:
  /// Where a pair of moves differs in machine coordinates, by axis.
  struct Difference {
    interpret::Axes start{};
    interpret::Axes end{};
    interpret::Axes centre{};
  };
  bool as_wanted(const interpret::Move& before, const interpret::Move& after) noexcept;
  [[nodiscard]] std::string one_axis(std::size_t axis, const interpret::Move& before,
                                     const Difference& difference, const Frames& frames);

  interpret::Axes shift_{};
  std::uint32_t planned_ = 0;
  double largest_error_mm_ = 0.0;
};

}  // namespace steadyrest::nc::rewrite
