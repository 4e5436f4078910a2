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

/// How a line's positions are meant.
struct Frames {
  bool incremental = false;        ///< G91
  bool machine = false;            ///< G53, SUPA, G28, G30
  std::uint32_t acts_at_once = 0;  ///< axes whose new correction must act in this line, a mask
};

/// The distance between the machine positions of the changed program and the original, move by
/// move.
///
/// A move must end at the planned shift. Where the original leaves the axis alone or moves it by
/// increments, it may end at the shift it began with; where the original goes to machine
/// coordinates, at none. Arcs, splines, threads and probes keep the shift they begin with.
class Shifts {
 public:
  explicit Shifts(const Plan& plan);

  /// Takes a pair of moves; returns the fault, empty when there is none.
  [[nodiscard]] std::string pair(const interpret::Move& before, const interpret::Move& after,
                                 const Frames& frames);
  /// Takes a move that the original lacks: a rapid of planned axes, by at most `most_mm`.
  [[nodiscard]] std::string add(const interpret::Move& move, double most_mm);

  [[nodiscard]] double now(std::size_t axis) const noexcept { return shift_[axis]; }
  [[nodiscard]] bool any() const noexcept {
    return std::ranges::any_of(shift_, [](double mm) { return !same(mm, 0.0); });
  }
  [[nodiscard]] double largest_error_mm() const noexcept { return largest_error_mm_; }

  interpret::Axes wanted{};  ///< the correction in force by the plan

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
