// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace steadyrest::kernel::signal {

/// Axes of a machine, in the order of the machine file; the first three are X, Y, Z.
inline constexpr std::size_t kMaxAxes = 8;
using Point = std::array<double, 3>;              ///< x, y, z in mm
using AxisValues = std::array<double, kMaxAxes>;  ///< mm for linear axes, rad for rotary ones

/// What the control does with a piece of path.
enum class Motion : std::uint8_t {
  idle,         ///< standstill, no block active; a feed hold keeps its block's motion
  rapid,        ///< G0: rapid override applies
  feed,         ///< G1–G3 in the cut: feed override applies
  thread,       ///< G33, G76: the override is fixed at 100 %
  tap,          ///< G84 and rigid tapping: the override is fixed at 100 %
  probe,        ///< G38, G31
  dwell,        ///< G4
  tool_change,  ///< M6
  spindle_wait  ///< waiting for the spindle to reach its speed
};

/// Whether the control runs an NC program.
enum class ProgramState : std::uint8_t {
  unknown,  ///< the control does not show it
  stopped,  ///< none: standstill, jogging, single blocks by hand (MDI)
  running,
  paused  ///< feed hold of the program, M0, M1, single block
};

/// A tool is at work: an offset that moves now leaves a step in the part.
[[nodiscard]] constexpr bool in_cut(Motion motion) noexcept {
  return motion == Motion::feed || motion == Motion::thread || motion == Motion::tap;
}

/// The feed belongs to the spindle: neither may change.
[[nodiscard]] constexpr bool is_locked(Motion motion) noexcept {
  return motion == Motion::thread || motion == Motion::tap;
}

enum class Geometry : std::uint8_t {
  line,
  arc  ///< circle, helix (rise ≠ 0) or spiral (radius_end ≠ radius), any number of turns
};

/// One piece of the path as the control will follow it, with what limits its speed. A plain value
/// that owns nothing.
///
/// Arc law, u ∈ [0, 1]:  p(u) = centre + r(u)·(cos θ · e1 + sin θ · e2) + u·rise·axis,  θ =
/// u·sweep, r(u) = radius + u·(radius_end − radius), e1 = unit vector from centre to start in the
/// plane ⟂ axis, e2 = axis × e1. sweep > 0 always: the sign of `axis` carries the direction of
/// travel (right-hand rule).
struct PathSegment {
  Geometry geometry = Geometry::line;
  Motion motion = Motion::feed;
  bool speed_modulation = false;  ///< the program asks for spindle speed modulation here (M38)
  std::uint32_t line = 0;         ///< 1-based line of the NC program
  Point start_mm{};
  Point end_mm{};
  Point centre_mm{};       ///< arc: the centre at the height of the start point
  Point axis{};            ///< arc: unit normal of its plane
  double radius_mm = 0.0;  ///< arc: at the start
  double radius_end_mm = 0.0;
  double sweep_rad = 0.0;  ///< arc: > 0, may exceed 2π
  double rise_mm = 0.0;    ///< arc: travel along `axis`, helix
  std::array<double, kMaxAxes - 3>
      other_start{};  ///< axes 3…7 at the start; they run linearly in u
  std::array<double, kMaxAxes - 3> other_end{};
  double length_mm =
      0.0;  ///< path length; for a move of rotary axes alone: the length that its feed refers to
  double position_mm = 0.0;  ///< path length from the program's start to this segment's start
  double feed_mm_s = 0.0;    ///< programmed feed at override 100 %
  double speed_limit_mm_s =
      std::numeric_limits<double>::infinity();  ///< what the control never exceeds here
  double exit_speed_limit_mm_s =
      0.0;  ///< what the control never exceeds at the end point; 0 = it stops there
  /// Where the program's text corrects its path (Frame::original): the places of the original, by
  /// path length, that belong to start and end; linear between.
  double original_start_mm = 0.0;
  double original_end_mm = 0.0;
  bool by_text = false;  ///< the text commands another place here than the part should have
};

/// The path of a program, in order, contiguous: segment i+1 starts where i ends.
using PathView = std::span<const PathSegment>;

}  // namespace steadyrest::kernel::signal
