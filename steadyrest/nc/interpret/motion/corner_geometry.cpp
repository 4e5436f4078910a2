// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <optional>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/motion/corner_geometry.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr double kFits_mm = 1e-9;

struct Direction {
  double first = 0.0;
  double second = 0.0;
};

double cross_2d(const Direction& a, const Direction& b) noexcept {
  return a.first * b.second - a.second * b.first;
}
double dot_2d(const Direction& a, const Direction& b) noexcept {
  return a.first * b.first + a.second * b.second;
}
Direction from_to(const PlanePoint& from, const PlanePoint& to) noexcept {
  return {.first = to.first - from.first, .second = to.second - from.second};
}
double length_2d(const Direction& d) noexcept {
  return std::hypot(d.first, d.second);
}
Direction unit_2d(const Direction& d) noexcept {
  const double by = length_2d(d);
  return {.first = d.first / by, .second = d.second / by};
}
Direction left_of(const Direction& d) noexcept {
  return {.first = -d.second, .second = d.first};
}
PlanePoint beyond(const PlanePoint& from, const Direction& d, double by) noexcept {
  return {.first = from.first + by * d.first, .second = from.second + by * d.second};
}

/// Direction of travel at a point of the side.
Direction travel_at(const CornerSide& side, const PlanePoint& at) noexcept {
  if (!side.arc) {
    return unit_2d(from_to(side.start, side.end));
  }
  const Direction radius = unit_2d(from_to(side.centre, at));
  const Direction ahead = left_of(radius);
  return side.clockwise ? Direction{.first = -ahead.first, .second = -ahead.second} : ahead;
}

/// The way along a side between two of its points, in the direction of travel: mm.
double way_along(const CornerSide& side, const PlanePoint& from, const PlanePoint& to) noexcept {
  if (!side.arc) {
    return dot_2d(from_to(from, to), unit_2d(from_to(side.start, side.end)));
  }
  const Direction a = from_to(side.centre, from);
  const Direction b = from_to(side.centre, to);
  double angle = std::atan2(cross_2d(a, b), dot_2d(a, b)) * (side.clockwise ? -1.0 : 1.0);
  angle += angle < -kFits_mm ? kernel::units::kTurn : 0.0;
  return angle * length_2d(a);
}

double whole_way(const CornerSide& side) noexcept {
  const double out = way_along(side, side.start, side.end);
  return side.arc && out <= kFits_mm
             ? kernel::units::kTurn * length_2d(from_to(side.centre, side.end))
             : out;
}

/// The side's parallel at a distance to its left (negative: right): the point and direction of a
/// line, or the radius of a circle.
struct Parallel {
  bool arc = false;
  PlanePoint point;
  Direction along;
  double radius = 0.0;
};

Parallel parallel(const CornerSide& side, const PlanePoint& corner, double left_mm) noexcept {
  const Direction along = travel_at(side, corner);
  if (!side.arc) {
    return {.arc = false,
            .point = beyond(corner, left_of(along), left_mm),
            .along = along,
            .radius = 0.0};
  }
  // The centre of a counter-clockwise arc is to the left.
  const double radius = length_2d(from_to(side.centre, corner));
  return {.arc = true,
          .point = side.centre,
          .along = {},
          .radius = radius + (side.clockwise ? left_mm : -left_mm)};
}

std::optional<PlanePoint> nearer_of(const std::array<PlanePoint, 2>& points,
                                    const PlanePoint& corner) noexcept {
  return length_2d(from_to(points[0], corner)) <= length_2d(from_to(points[1], corner)) ? points[0]
                                                                                        : points[1];
}

std::optional<PlanePoint> meet_line_and_circle(const Parallel& line, const Parallel& circle,
                                               const PlanePoint& corner) noexcept {
  const Direction to_centre = from_to(line.point, circle.point);
  const double foot = dot_2d(to_centre, line.along);
  const double off = cross_2d(line.along, to_centre);
  const double square = circle.radius * circle.radius - off * off;
  if (square < 0.0) {
    return std::nullopt;
  }
  const double half = std::sqrt(square);
  return nearer_of(
      {beyond(line.point, line.along, foot - half), beyond(line.point, line.along, foot + half)},
      corner);
}

std::optional<PlanePoint> meet_circles(const Parallel& a, const Parallel& b,
                                       const PlanePoint& corner) noexcept {
  const Direction apart = from_to(a.point, b.point);
  const double distance = length_2d(apart);
  if (distance < kFits_mm) {
    return std::nullopt;
  }
  const double foot =
      (distance * distance + a.radius * a.radius - b.radius * b.radius) / (2.0 * distance);
  const double square = a.radius * a.radius - foot * foot;
  if (square < 0.0) {
    return std::nullopt;
  }
  const Direction along = unit_2d(apart);
  const PlanePoint on = beyond(a.point, along, foot);
  const double half = std::sqrt(square);
  return nearer_of({beyond(on, left_of(along), half), beyond(on, left_of(along), -half)}, corner);
}

std::optional<PlanePoint> meet_of(const Parallel& a, const Parallel& b,
                                  const PlanePoint& corner) noexcept {
  if ((a.arc && !(a.radius > kFits_mm)) || (b.arc && !(b.radius > kFits_mm))) {
    return std::nullopt;
  }
  if (a.arc && b.arc) {
    return meet_circles(a, b, corner);
  }
  if (a.arc || b.arc) {
    return a.arc ? meet_line_and_circle(b, a, corner) : meet_line_and_circle(a, b, corner);
  }
  const double by = cross_2d(from_to(a.point, b.point), b.along) / cross_2d(a.along, b.along);
  return beyond(a.point, a.along, by);
}

/// The point of a side nearest to the rounding's centre.
PlanePoint foot_on(const CornerSide& side, const PlanePoint& corner,
                   const PlanePoint& centre) noexcept {
  if (!side.arc) {
    const Direction along = travel_at(side, corner);
    return beyond(corner, along, dot_2d(from_to(corner, centre), along));
  }
  return beyond(side.centre, unit_2d(from_to(side.centre, centre)),
                length_2d(from_to(side.centre, corner)));
}

/// +1 for a turn to the left, −1 to the right.
std::expected<double, CornerFault> turn_at(const CornerSide& first,
                                           const CornerSide& second) noexcept {
  const Direction in = travel_at(first, first.end);
  const Direction out = travel_at(second, second.start);
  const double angle = std::atan2(cross_2d(in, out), dot_2d(in, out));
  if (std::abs(angle) < kernel::units::kDegree) {
    return std::unexpected(CornerFault::straight);
  }
  if (std::abs(angle) > (180.0 - 1e-6) * kernel::units::kDegree) {
    return std::unexpected(CornerFault::reversal);
  }
  return angle > 0.0 ? 1.0 : -1.0;
}

bool fits_on(const CornerSide& first, const CornerSide& second, const CornerCut& cut) noexcept {
  const double before = way_along(first, cut.from, first.end);
  const double behind = way_along(second, second.start, cut.to);
  return before >= -kFits_mm && before <= whole_way(first) + kFits_mm && behind >= -kFits_mm &&
         behind <= whole_way(second) + kFits_mm;
}

}  // namespace

std::expected<CornerCut, CornerFault> chamfer(const CornerSide& first, const CornerSide& second,
                                              double length_mm) noexcept {
  if (first.arc || second.arc) {
    return std::unexpected(CornerFault::beside_arc);
  }
  if (const auto turn = turn_at(first, second); !turn) {
    return std::unexpected(turn.error());
  }
  const CornerCut cut{.from = beyond(first.end, travel_at(first, first.end), -length_mm),
                      .to = beyond(second.start, travel_at(second, second.start), length_mm),
                      .centre = {}};
  return fits_on(first, second, cut) ? std::expected<CornerCut, CornerFault>(cut)
                                     : std::unexpected(CornerFault::too_large);
}

std::expected<CornerCut, CornerFault> rounding(const CornerSide& first, const CornerSide& second,
                                               double radius_mm) noexcept {
  const auto turn = turn_at(first, second);
  if (!turn) {
    return std::unexpected(turn.error());
  }
  const PlanePoint corner = first.end;
  const double left_mm = *turn * radius_mm;
  const auto centre =
      meet_of(parallel(first, corner, left_mm), parallel(second, corner, left_mm), corner);
  if (!centre) {
    return std::unexpected(CornerFault::too_large);
  }
  const CornerCut cut{.from = foot_on(first, corner, *centre),
                      .to = foot_on(second, corner, *centre),
                      .centre = *centre,
                      .clockwise = *turn < 0.0};
  return fits_on(first, second, cut) ? std::expected<CornerCut, CornerFault>(cut)
                                     : std::unexpected(CornerFault::too_large);
}

}  // namespace steadyrest::nc::interpret
