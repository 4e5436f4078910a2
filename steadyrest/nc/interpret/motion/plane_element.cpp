// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/nc/interpret/motion/plane_element.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr double kNear_mm = 1e-9;

PlanePoint plane_sum(PlanePoint a, PlanePoint b, double factor) noexcept {
  return {.first = a.first + factor * b.first, .second = a.second + factor * b.second};
}
PlanePoint plane_difference(PlanePoint a, PlanePoint b) noexcept {
  return plane_sum(a, b, -1.0);
}
double plane_norm(PlanePoint a) noexcept {
  return std::hypot(a.first, a.second);
}
double plane_dot(PlanePoint a, PlanePoint b) noexcept {
  return a.first * b.first + a.second * b.second;
}
PlanePoint plane_left(PlanePoint a) noexcept {
  return {.first = -a.second, .second = a.first};
}
PlanePoint plane_scaled(PlanePoint a, double factor) noexcept {
  return {.first = factor * a.first, .second = factor * a.second};
}

}  // namespace

PlaneElement::PlaneElement(const Move& move, PlaneAxes axes) noexcept
    : start_{.first = move.start[axes.first], .second = move.start[axes.second]},
      end_{.first = move.end[axes.first], .second = move.end[axes.second]},
      centre_{.first = move.centre_mm[axes.first], .second = move.centre_mm[axes.second]},
      turn_(move.turns < 0 ? -1.0 : 1.0),
      arc_(move.kind == MoveKind::arc) {
  radius_ = arc_ ? plane_norm(plane_difference(end_, centre_)) : 0.0;
  bool flat = true;
  for (std::size_t i = 0; i < move.end.size(); ++i) {
    flat = flat && (i == axes.first || i == axes.second || move.start[i] == move.end[i]);
  }
  in_plane_ = flat && (arc_ ? std::abs(move.turns) == 1 && move.normal[axes.normal] != 0.0
                            : plane_norm(plane_difference(end_, start_)) > kNear_mm);
}

double PlaneElement::length_mm() const noexcept {
  return plane_norm(plane_difference(end_, start_));
}

PlanePoint PlaneElement::start_tangent() const noexcept {
  return arc_ ? plane_scaled(plane_left(plane_difference(start_, centre_)),
                             turn_ / plane_norm(plane_difference(start_, centre_)))
              : plane_scaled(plane_difference(end_, start_),
                             1.0 / plane_norm(plane_difference(end_, start_)));
}

PlanePoint PlaneElement::end_tangent() const noexcept {
  return arc_ ? plane_scaled(plane_left(plane_difference(end_, centre_)),
                             turn_ / plane_norm(plane_difference(end_, centre_)))
              : start_tangent();
}

bool PlaneElement::foot(PlanePoint point, PlanePoint& out) const noexcept {
  if (!arc_) {
    const PlanePoint along = start_tangent();
    const double way = plane_dot(plane_difference(point, start_), along);
    out = plane_sum(start_, along, way);
    return way >= -kNear_mm && way <= length_mm() + kNear_mm;
  }
  const PlanePoint from = plane_difference(point, centre_);
  if (!(plane_norm(from) > 0.0)) {
    return false;
  }
  out = plane_sum(centre_, from, radius_ / plane_norm(from));
  // Angles from the start, in the arc's own direction; the same end as start is a full circle.
  const auto angle_of = [&](PlanePoint to) {
    const PlanePoint a = plane_difference(start_, centre_);
    const PlanePoint b = plane_difference(to, centre_);
    const double angle = turn_ * std::atan2(plane_dot(plane_left(a), b), plane_dot(a, b));
    return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
  };
  const double near_angle = kNear_mm / radius_;
  double sweep = angle_of(end_);
  sweep = sweep <= near_angle ? 2.0 * std::numbers::pi : sweep;
  const double at = angle_of(out);
  return at <= sweep + near_angle || at >= 2.0 * std::numbers::pi - near_angle;
}

// To the left of a counter-clockwise arc is its inside.
double PlaneElement::offset_radius(double r_mm) const noexcept {
  return radius_ - turn_ * r_mm;
}

std::size_t PlaneElement::offset_crossings(const PlaneElement& a, const PlaneElement& b,
                                           double r_mm, std::array<PlanePoint, 2>& out) noexcept {
  if (a.arc_ && !b.arc_) {
    return offset_crossings(b, a, r_mm, out);
  }
  if (!a.arc_) {
    const PlanePoint along = a.start_tangent();
    const PlanePoint from = plane_sum(a.start_, plane_left(along), r_mm);
    if (!b.arc_) {
      const PlanePoint other = b.start_tangent();
      const PlanePoint to = plane_sum(b.start_, plane_left(other), r_mm);
      const double sine = plane_dot(plane_left(along), other);
      const double way = plane_dot(plane_difference(to, from), plane_left(other)) /
                         plane_dot(along, plane_left(other));
      out[0] = plane_sum(from, along, way);
      return sine != 0.0 && std::isfinite(way) ? 1 : 0;
    }
    const double radius = b.offset_radius(r_mm);
    const PlanePoint to = plane_difference(b.centre_, from);
    const double height = plane_dot(to, plane_left(along));
    if (!(radius > 0.0) || std::abs(height) > radius) {
      return 0;
    }
    const double half = std::sqrt((radius - height) * (radius + height));
    out[0] = plane_sum(from, along, plane_dot(to, along) - half);
    out[1] = plane_sum(from, along, plane_dot(to, along) + half);
    return 2;
  }
  const double radius_a = a.offset_radius(r_mm);
  const double radius_b = b.offset_radius(r_mm);
  const PlanePoint between = plane_difference(b.centre_, a.centre_);
  const double distance = plane_norm(between);
  if (!(radius_a > 0.0 && radius_b > 0.0 && distance > 0.0)) {
    return 0;
  }
  const double way = 0.5 * (distance + (radius_a - radius_b) * (radius_a + radius_b) / distance);
  if (std::abs(way) > radius_a) {
    return 0;
  }
  const double half = std::sqrt((radius_a - way) * (radius_a + way));
  const PlanePoint along = plane_scaled(between, 1.0 / distance);
  const PlanePoint middle = plane_sum(a.centre_, along, way);
  out[0] = plane_sum(middle, plane_left(along), half);
  out[1] = plane_sum(middle, plane_left(along), -half);
  return 2;
}

}  // namespace steadyrest::nc::interpret
