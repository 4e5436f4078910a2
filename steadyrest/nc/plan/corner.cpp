// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/corner.hpp>

namespace steadyrest::nc::plan {

using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using math::geometry::add_scaled;
using math::geometry::cross;
using math::geometry::dot;
using math::geometry::norm;

namespace {

constexpr double kSmoothTurn_rad = 1e-4;
constexpr double kInPlane = 1e-6;
constexpr double kRounding = 1e-7;  ///< of lengths, where the pieces are nearly in line

struct Flat {
  double x = 0.0;
  double y = 0.0;
};
Flat operator+(Flat a, Flat b) {
  return {a.x + b.x, a.y + b.y};
}
Flat operator-(Flat a, Flat b) {
  return {a.x - b.x, a.y - b.y};
}
Flat operator*(double k, Flat a) {
  return {k * a.x, k * a.y};
}
double inner(Flat a, Flat b) {
  return a.x * b.x + a.y * b.y;
}
double outer(Flat a, Flat b) {
  return a.x * b.y - a.y * b.x;
}
double length(Flat a) {
  return std::hypot(a.x, a.y);
}
Flat left_of(Flat d) {
  return {-d.y, d.x};
}

/// One piece in the plane; it passes the origin in direction `tangent`.
struct Curve {
  bool circle = false;
  Flat tangent;
  Flat centre;
  double radius = 0.0;
  double turn = 1.0;  ///< o
};

std::optional<Curve> curve_of(const PathSegment& s, const Flat& tangent, const Point& normal,
                              const Point& direction) {
  Curve out;
  out.tangent = tangent;
  if (s.geometry == Geometry::line) {
    return std::abs(dot(direction, normal)) < kInPlane ? std::optional(out) : std::nullopt;
  }
  const double along = dot(s.axis, normal);
  if (std::abs(std::abs(along) - 1.0) > kInPlane || std::abs(s.rise_mm) > 1e-9 ||
      s.radius_end_mm != s.radius_mm) {
    return std::nullopt;
  }
  out.circle = true;
  out.turn = along > 0.0 ? 1.0 : -1.0;
  out.radius = s.radius_mm;
  out.centre = (out.turn * out.radius) * left_of(tangent);
  return out;
}

/// Where the offsets by r meet, nearest to the corner.
std::optional<Flat> meet(const Curve& a, const Curve& b, double r) {
  if (!a.circle && !b.circle) {
    const Flat p = r * left_of(a.tangent);
    const Flat q = r * left_of(b.tangent);
    const double k = outer(q - p, b.tangent) / outer(a.tangent, b.tangent);
    return p + k * a.tangent;
  }
  const double rb = b.radius - b.turn * r;
  if (a.circle && b.circle) {
    const double ra = a.radius - a.turn * r;
    const Flat between = b.centre - a.centre;
    const double d = length(between);
    if (ra <= 0.0 || rb <= 0.0 || d <= 1e-12) {
      return std::nullopt;
    }
    const double k = (d * d + ra * ra - rb * rb) / (2.0 * d);
    const double h2 = ra * ra - k * k;
    if (h2 < 0.0) {
      return std::nullopt;
    }
    const Flat unit = (1.0 / d) * between;
    const Flat foot = a.centre + k * unit;
    const Flat p = foot + std::sqrt(h2) * left_of(unit);
    const Flat q = foot - std::sqrt(h2) * left_of(unit);
    return length(p) < length(q) ? p : q;
  }
  const Curve& line = a.circle ? b : a;
  const Curve& ring = a.circle ? a : b;
  const double radius = ring.radius - ring.turn * r;
  const Flat from = r * left_of(line.tangent);
  const Flat to = ring.centre - from;
  const double k = inner(to, line.tangent);
  const double h2 = radius * radius - outer(line.tangent, to) * outer(line.tangent, to);
  if (radius <= 0.0 || h2 < 0.0) {
    return std::nullopt;
  }
  const Flat p = from + (k + std::sqrt(h2)) * line.tangent;
  const Flat q = from + (k - std::sqrt(h2)) * line.tangent;
  return length(p) < length(q) ? p : q;
}

/// The point where the rounding touches, and its signed path distance from the corner.
struct Touch {
  Flat point;
  double distance = 0.0;
};
Touch touch(const Curve& c, Flat centre) {
  if (!c.circle) {
    const double along = inner(centre, c.tangent);
    return {along * c.tangent, along};
  }
  const Flat away = centre - c.centre;
  const Flat point = (c.radius / length(away)) * away;
  const Flat corner = Flat{} - c.centre;
  const double angle = c.turn * std::atan2(outer(corner, point), inner(corner, point));
  return {c.centre + point, c.radius * angle};
}

struct FlatArc {
  Flat centre;
  Touch before;
  Touch after;
};

std::optional<FlatArc> fit(const Curve& a, const Curve& b, double r, const CornerRequest& request) {
  const auto centre = meet(a, b, r);
  if (!centre || length(*centre) - r > request.tolerance_mm * (1.0 + kRounding)) {
    return std::nullopt;
  }
  const FlatArc out{*centre, touch(a, *centre), touch(b, *centre)};
  const bool fits = out.before.distance < 0.0 &&
                    -out.before.distance <= request.room_before_mm * (1.0 + kRounding) &&
                    out.after.distance > 0.0 &&
                    out.after.distance <= request.room_after_mm * (1.0 + kRounding);
  return fits ? std::optional(out) : std::nullopt;
}

/// Two lines: in closed form.
double line_radius(double turn, const CornerRequest& request) {
  const double room = std::min(request.room_before_mm, request.room_after_mm);
  return std::min({request.tolerance_mm / (1.0 / std::cos(0.5 * turn) - 1.0),
                   room / std::tan(0.5 * turn), request.most_radius_mm});
}

double largest_radius(const Curve& a, const Curve& b, double turn, const CornerRequest& request) {
  if (!a.circle && !b.circle) {
    return line_radius(turn, request);
  }
  // What the tangents would permit is near the answer; from there the largest that fits.
  double low = 0.0;
  double high = std::min(4.0 * line_radius(turn, request), request.most_radius_mm);
  if (fit(a, b, high, request)) {
    return high;
  }
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (fit(a, b, middle, request) ? low : high) = middle;
  }
  return low;
}

}  // namespace

std::optional<CornerArc> round_corner(const PathSegment& before, const PathSegment& after,
                                      const Point& in, const Point& out,
                                      const CornerRequest& request) {
  Point axis = cross(in, out);
  const double sine = norm(axis);
  const double turn = std::atan2(sine, dot(in, out));
  if (turn < kSmoothTurn_rad || turn > std::numbers::pi - 1e-3) {
    return std::nullopt;
  }
  axis = math::geometry::scale(axis, 1.0 / sine);
  const Point side = cross(axis, in);
  const auto a = curve_of(before, {1.0, 0.0}, axis, in);
  const auto b = curve_of(after, {std::cos(turn), std::sin(turn)}, axis, out);
  if (!a || !b) {
    return std::nullopt;
  }
  const double radius = largest_radius(*a, *b, turn, request);
  const auto arc = radius > 0.0 ? fit(*a, *b, radius, request) : std::nullopt;
  if (!arc) {
    return std::nullopt;
  }
  const auto place = [&](Flat p) {
    return add_scaled(add_scaled(before.end_mm, in, p.x), side, p.y);
  };
  const Flat from = arc->before.point - arc->centre;
  const Flat to = arc->after.point - arc->centre;
  CornerArc result;
  result.start_mm = place(arc->before.point);
  result.end_mm = place(arc->after.point);
  result.centre_mm = place(arc->centre);
  result.axis = axis;
  result.radius_mm = radius;
  // Between two lines the rounding turns as the corner does.
  result.sweep_rad = a->circle || b->circle ? std::atan2(outer(from, to), inner(from, to)) : turn;
  if (result.sweep_rad <= 0.0) {
    result.sweep_rad += 2.0 * std::numbers::pi;
  }
  result.taken_before_mm = -arc->before.distance;
  result.taken_after_mm = arc->after.distance;
  result.deviation_mm = length(arc->centre) - radius;
  return result;
}

}  // namespace steadyrest::nc::plan
