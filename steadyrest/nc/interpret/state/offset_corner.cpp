// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <steadyrest/nc/interpret/state/offset_corner.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTangent_rad = 0.05;  // LinuxCNC 2.9, by bisection with rs274

double angle_of(PlanePoint vector) noexcept {
  return std::atan2(vector.second, vector.first);
}

}  // namespace

PlanePoint between(PlanePoint from, PlanePoint to) noexcept {
  return {.first = to.first - from.first, .second = to.second - from.second};
}

double length(PlanePoint vector) noexcept {
  return std::hypot(vector.first, vector.second);
}

// A zero vector has no direction: any unit vector will do, and nothing is divided by zero.
PlanePoint unit(PlanePoint vector) noexcept {
  const double size = length(vector);
  return size == 0.0 ? PlanePoint{.first = 1.0, .second = 0.0}
                     : PlanePoint{.first = vector.first / size, .second = vector.second / size};
}

PlanePoint left_of(PlanePoint vector) noexcept {
  return {.first = -vector.second, .second = vector.first};
}

PlanePoint along(PlanePoint from, PlanePoint direction, double distance) noexcept {
  return {.first = from.first + distance * direction.first,
          .second = from.second + distance * direction.second};
}

double dot(PlanePoint a, PlanePoint b) noexcept {
  return a.first * b.first + a.second * b.second;
}

// Positive where the path turns towards the tool: a concave corner on either side.
double turn_between(PlanePoint before, PlanePoint after, int side) noexcept {
  const double to_left = std::atan2(dot(left_of(before), after), dot(before, after));
  return side < 0 ? to_left : -to_left;
}

Corner kind_of(double turn, bool about_arc) noexcept {
  if (std::abs(turn) <= kTangent_rad) {
    return Corner::tangent;
  }
  // This close to a reversal the sign of the turn is rounding. LinuxCNC decides by the previous
  // move: lines go round the corner, an arc with the tool outside is cut short.
  const bool reverses = std::abs(turn) > kPi - kTangent_rad;
  return reverses     ? (about_arc ? Corner::concave : Corner::convex)
         : turn > 0.0 ? Corner::concave
                      : Corner::convex;
}

// With the line's direction u, the normal n on the tool's side and the centre c at height h above
// the contour's line, the offset line has height r: its foot under c is c + (r − h)·n, and the
// crossings lie √(R² − (r − h)²) before and after it. The contour turns towards the tool; with the
// tool inside the arc, a leaving line begins where it enters the circle, with the tool outside,
// where it exits.
std::optional<PlanePoint> crossing(const OffsetCircle& circle, PlanePoint normal,
                                   PlanePoint direction, double centre_height, double tool_radius,
                                   bool leaving) noexcept {
  const double rise = tool_radius - centre_height;
  if (std::abs(rise) > circle.radius) {
    return std::nullopt;
  }
  const double half = std::sqrt((circle.radius - rise) * (circle.radius + rise));
  const double sign = circle.tool_inside == leaving ? -half : half;
  return along(along(circle.centre, normal, rise), direction, sign);
}

std::optional<PlanePoint> crossing(const OffsetCircle& before, const OffsetCircle& after) noexcept {
  const PlanePoint across = between(before.centre, after.centre);
  const double distance = length(across);
  if (before.radius == 0.0 || distance == 0.0) {
    return std::nullopt;
  }
  // Law of cosines in the triangle of the two centres and the crossing. The crossing lies on one
  // side of the line between the centres; the tool's side decides which.
  const double cosine =
      (before.radius * before.radius + distance * distance - after.radius * after.radius) /
      (2.0 * before.radius * distance);
  // Also catches NaN: circles that do not meet.
  if (!(std::abs(cosine) <= 1.0)) {
    return std::nullopt;
  }
  const double back = std::acos(cosine);
  const double angle =
      angle_of(across) + (before.tool_inside == after.counter_clockwise ? back : -back);
  return PlanePoint{.first = before.centre.first + before.radius * std::cos(angle),
                    .second = before.centre.second + before.radius * std::sin(angle)};
}

// Signed sweep of an arc, counter-clockwise positive. Equal angles are a whole turn, hence ≤.
double swept(PlanePoint start, PlanePoint end, PlanePoint centre, int turns) noexcept {
  double from = angle_of(between(centre, start));
  double to = angle_of(between(centre, end));
  if (turns > 0 && to <= from) {
    to += 2.0 * kPi;
  } else if (turns < 0 && from <= to) {
    from += 2.0 * kPi;
  }
  return to - from + 2.0 * kPi * (turns > 0 ? turns - 1 : turns + 1);
}

}  // namespace steadyrest::nc::interpret
