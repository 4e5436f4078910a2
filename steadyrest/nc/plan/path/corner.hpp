// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/kernel/signal/path.hpp>

/// The circle that rounds a corner: tangential to the piece before and to the piece after.
///
/// Law, in the plane of the corner, turning left, corner at the origin: the centre of a rounding
/// circle of radius r lies at distance r to the left of both pieces, so it is where their offsets
/// meet: a line's offset is a parallel line, a circle's of radius R a circle of radius R − o·r
/// about the same centre, o = +1 where the path runs counter-clockwise and −1 where it runs
/// clockwise. If there are two meeting points, the one nearer to the corner counts. The distance
/// between corner and rounding is |C| − r; both it and the lengths that the rounding takes from the
/// pieces grow with r, so the largest permitted r is found by bisection. Between two lines that
/// turn by φ they are r·(1/cos(φ/2) − 1) and r·tan(φ/2): the largest r is the smaller quotient.
///
/// Pieces: lines and plane arcs of constant radius that lie in one plane; others are left sharp.
namespace steadyrest::nc::plan {

/// How the path turns from one unit vector to another.
struct Bend {
  kernel::signal::Point axis{};  ///< unit normal of the corner's plane
  double sine = 0.0;             ///< of the turning angle
  double cosine = 1.0;
  double turn_rad = 0.0;
};
/// Nothing when the corner is smooth or a reversal.
[[nodiscard]] std::optional<Bend> bend_of(const kernel::signal::Point& in,
                                          const kernel::signal::Point& out) noexcept;

struct CornerRequest {
  double tolerance_mm = 0.0;    ///< largest distance between corner and rounding
  double room_before_mm = 0.0;  ///< largest length taken from the piece before
  double room_after_mm = 0.0;   ///< and from the piece after
  double most_radius_mm = 0.0;  ///< a larger radius gains nothing
};

struct CornerArc {
  kernel::signal::Point start_mm{};
  kernel::signal::Point end_mm{};
  kernel::signal::Point centre_mm{};
  kernel::signal::Point axis{};
  double radius_mm = 0.0;
  double sweep_rad = 0.0;
  double taken_before_mm = 0.0;  ///< path length
  double taken_after_mm = 0.0;
};

/// The largest rounding of the corner between `before` and `after`, whose directions there are the
/// unit vectors `in` and `out` with this bend; nothing when the pieces do not lie in one plane.
[[nodiscard]] std::optional<CornerArc> round_corner(const kernel::signal::PathSegment& before,
                                                    const kernel::signal::PathSegment& after,
                                                    const kernel::signal::Point& in,
                                                    const kernel::signal::Point& out,
                                                    const Bend& bend, const CornerRequest& request);

}  // namespace steadyrest::nc::plan
