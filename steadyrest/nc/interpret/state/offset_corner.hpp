// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/nc/interpret/state/arc.hpp>

/// Plane geometry of offset paths: what the path does at the contour's corners. All in mm and
/// radians, in the plane's right-handed axes.
namespace steadyrest::nc::interpret {

[[nodiscard]] PlanePoint between(PlanePoint from, PlanePoint to) noexcept;
[[nodiscard]] double length(PlanePoint vector) noexcept;
[[nodiscard]] PlanePoint unit(PlanePoint vector) noexcept;
/// A quarter turn counter-clockwise.
[[nodiscard]] PlanePoint left_of(PlanePoint vector) noexcept;
[[nodiscard]] PlanePoint along(PlanePoint from, PlanePoint direction, double distance) noexcept;
[[nodiscard]] double dot(PlanePoint a, PlanePoint b) noexcept;

/// A piece of the offset path that can be shortened or extended: a circle.
struct OffsetCircle {
  PlanePoint centre;
  double radius = 0.0;
  bool tool_inside = false;
  bool counter_clockwise = false;
};

/// A corner of the contour. `turn` is the change of direction, −π … π, positive towards the tool.
enum class Corner : unsigned char {
  tangent,  ///< |turn| ≤ 0.05 rad: the offset pieces are assumed to meet
  convex,   ///< an arc about the corner joins the offset pieces; also an exact reversal
  concave   ///< the offset pieces cross
};
/// `about_arc`: an arc with the tool outside follows; the contour's reversal is then concave.
[[nodiscard]] Corner kind_of(double turn, bool about_arc) noexcept;
[[nodiscard]] double turn_between(PlanePoint before, PlanePoint after, int side) noexcept;

/// Where the offset of a line through `through` along `direction` crosses the circle, for a concave
/// corner between that line and the contour's arc. `normal` points to the tool; `centre_height` is
/// the centre's distance from the contour's line, positive on the tool's side; `leaving`: the line
/// comes after the arc. Nothing when they do not meet.
[[nodiscard]] std::optional<PlanePoint> crossing(const OffsetCircle& circle, PlanePoint normal,
                                                 PlanePoint direction, double centre_height,
                                                 double tool_radius, bool leaving) noexcept;

/// Where two offset circles cross, for a concave corner from the arc `before` to the arc `after`.
[[nodiscard]] std::optional<PlanePoint> crossing(const OffsetCircle& before,
                                                 const OffsetCircle& after) noexcept;

/// Angle swept from `start` to `end` about `centre`, signed; `turns` as in `Move`.
[[nodiscard]] double swept(PlanePoint start, PlanePoint end, PlanePoint centre, int turns) noexcept;

}  // namespace steadyrest::nc::interpret
