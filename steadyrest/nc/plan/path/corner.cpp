// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/corner.hpp>

namespace steadyrest::nc::plan {

using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using math::geometry::add_scaled;
using math::geometry::cross;
using math::geometry::dot;
using math::geometry::norm;

namespace {

// Smaller turns are left to the junction law: no axis jumps by more than 1e-4 of the speed there.
constexpr double kSmoothTurn_rad = 1e-4;
constexpr double kInPlane = 1e-6;
constexpr double kSameRadius_ratio = 1e-4;  ///< the slope of a circle that the text has rounded
constexpr double kStraight_mm = 1e6;  ///< a wider rounding is a straight line to every machine
constexpr double kRounding = 1e-7;    ///< of lengths, where the pieces are nearly in line

// A vector in the corner's plane: origin at the corner, x along the incoming direction, y to its
// left (the bend's axis is the normal, so the corner always turns left).
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

/// `radius_mm`: at the corner.
std::optional<Curve> curve_of(const PathSegment& s, double radius_mm, const Flat& tangent,
                              const Point& normal, const Point& direction) {
  Curve out;
  // The plane of the corner contains both tangents by construction; a line needs nothing else.
  out.tangent = tangent;
  if (s.geometry == Geometry::line) {
    return std::abs(dot(direction, normal)) < kInPlane ? std::optional(out) : std::nullopt;
  }
  const double along = dot(s.axis, normal);
  // A helix, a spiral or an arc in another plane has no offset curve in the corner's plane; radii
  // that differ by the text's last digit make no spiral.
  if (std::abs(std::abs(along) - 1.0) > kInPlane || std::abs(s.rise_mm) > 1e-9 ||
      std::abs(s.radius_end_mm - s.radius_mm) > kSameRadius_ratio * s.radius_mm * s.sweep_rad) {
    return std::nullopt;
  }
  out.circle = true;
  out.turn = along > 0.0 ? 1.0 : -1.0;
  out.radius = radius_mm;
  // The corner is the origin: the centre lies a radius to the left of the direction there, or to
  // the right.
  out.centre = (out.turn * out.radius) * left_of(tangent);
  return out;
}

/// Where the offsets by r meet, nearest to the corner; at least one piece is a circle.
std::optional<Flat> meet(const Curve& a, const Curve& b, double r) {
  const double rb = b.radius - b.turn * r;
  if (a.circle && b.circle) {
    const double ra = a.radius - a.turn * r;
    const Flat between = b.centre - a.centre;
    const double d = length(between);
    // A rounding wider than the arc itself, or arcs about one centre, have no meeting point.
    if (ra <= 0.0 || rb <= 0.0 || d <= 1e-12) {
      return std::nullopt;
    }
    // Two circles about points d apart: the meeting points lie on their common chord, k from the
    // first centre, h to either side of the line between the centres.
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
  // k = distance along the line to the foot of the centre, h² = radius² − (distance of the centre
  // from the line)²; the line itself is the piece's, moved by r to the left.
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
  // Positive along the path, negative before the corner.
  const double angle = c.turn * std::atan2(outer(corner, point), inner(corner, point));
  return {c.centre + point, c.radius * angle};
}

struct FlatArc {
  Flat centre;
  Touch before;
  Touch after;
};

// A radius is permitted when the rounding stays within the tolerance of the corner, |C| − r, and
// takes no more of either piece than there is.
std::optional<FlatArc> fit(const Curve& a, const Curve& b, double r, const CornerRequest& request) {
  const auto centre = meet(a, b, r);
  if (!centre || length(*centre) - r > request.tolerance_mm * (1.0 + kRounding)) {
    return std::nullopt;
  }
  const FlatArc out{*centre, touch(a, *centre), touch(b, *centre)};
  // The rounding must touch the first piece before the corner and the second piece after it.
  const bool fits = out.before.distance < 0.0 &&
                    -out.before.distance <= request.room_before_mm * (1.0 + kRounding) &&
                    out.after.distance > 0.0 &&
                    out.after.distance <= request.room_after_mm * (1.0 + kRounding);
  return fits ? std::optional(out) : std::nullopt;
}

/// tan and 1/cos − 1 of half the turn, without cancellation.
struct Half {
  double tangent = 0.0;
  double secant_less_1 = 0.0;
};
Half half_of(const Bend& bend) {
  // With c = cos(φ/2): 1/c − 1 = (1 − c²)/((1 + c)·c), and 1 − c² = sin²φ/(2·(1 + cos φ)).
  // tan(φ/2) = sin φ/(1 + cos φ); 1/cos(φ/2) − 1 without cancellation, since most turns are small.
  const double wide = 1.0 + bend.cosine;
  const double cosine = std::sqrt(0.5 * wide);
  const double sine_squared = bend.sine * bend.sine / (2.0 * wide);
  return {bend.sine / wide, sine_squared / ((1.0 + cosine) * cosine)};
}

/// Two lines: in closed form.
/// tolerance = r·(1/cos(φ/2) − 1) and room = r·tan(φ/2), each solved for r.
double line_radius(const Half& half, const CornerRequest& request) {
  const double room = std::min(request.room_before_mm, request.room_after_mm);
  return std::min(
      {request.tolerance_mm / half.secant_less_1, room / half.tangent, request.most_radius_mm});
}

double largest_radius(const Curve& a, const Curve& b, const Half& half,
                      const CornerRequest& request) {
  // The radius that fits the tangents is near the answer where the arcs are wide. Arcs that bend
  // away from the corner permit larger ones without limit: their common tangent touches both.
  double low = 0.0;
  double high = std::min(4.0 * line_radius(half, request), request.most_radius_mm);
  while (fit(a, b, high, request)) {
    if (high >= request.most_radius_mm || high > kStraight_mm) {
      return high;
    }
    low = high;
    high = std::min(2.0 * high, request.most_radius_mm);
  }
  // 50 halvings shrink the interval below the last digit of a double. The fit is monotonic in r
  // (corner.hpp), so bisection finds the largest.
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (fit(a, b, middle, request) ? low : high) = middle;
  }
  return low;
}

}  // namespace

// The sine and the cosine together: acos of the cosine alone would lose half the digits of a small
// turn, and asin of the sine cannot tell φ from π − φ.
std::optional<Bend> bend_of(const Point& in, const Point& out) noexcept {
  Bend bend;
  bend.axis = cross(in, out);
  bend.sine = norm(bend.axis);
  bend.cosine = dot(in, out);
  if (bend.cosine > 0.0 && bend.sine < 0.5 * kSmoothTurn_rad) {
    return std::nullopt;
  }
  bend.turn_rad = std::atan2(bend.sine, bend.cosine);
  // At a reversal the plane of the corner is not defined.
  if (bend.turn_rad < kSmoothTurn_rad || bend.turn_rad > std::numbers::pi - 1e-3) {
    return std::nullopt;
  }
  bend.axis = math::geometry::scale(bend.axis, 1.0 / bend.sine);
  return bend;
}

std::optional<CornerArc> round_corner(const PathSegment& before, const PathSegment& after,
                                      const Point& in, const Point& out, const Bend& bend,
                                      const CornerRequest& request) {
  const Half half = half_of(bend);
  CornerArc result;
  result.axis = bend.axis;
  // Corners between lines, the usual case, need neither the plane frame nor the search.
  if (before.geometry == Geometry::line && after.geometry == Geometry::line) {
    result.radius_mm = line_radius(half, request);
    if (!(result.radius_mm > 0.0)) {
      return std::nullopt;
    }
    const double taken_mm = result.radius_mm * half.tangent;
    result.start_mm = add_scaled(before.end_mm, in, -taken_mm);
    result.end_mm = add_scaled(before.end_mm, out, taken_mm);
    result.centre_mm = add_scaled(result.start_mm, cross(bend.axis, in), result.radius_mm);
    result.sweep_rad = bend.turn_rad;  // the rounding turns as the corner does
    result.taken_before_mm = result.taken_after_mm = taken_mm;
    return result;
  }
  // In the plane frame the piece before leaves along x, the piece after at the turning angle.
  const auto a = curve_of(before, before.radius_end_mm, {1.0, 0.0}, bend.axis, in);
  const auto b = curve_of(after, after.radius_mm, {bend.cosine, bend.sine}, bend.axis, out);
  if (!a || !b) {
    return std::nullopt;
  }
  result.radius_mm = largest_radius(*a, *b, half, request);
  const auto arc = result.radius_mm > 0.0 ? fit(*a, *b, result.radius_mm, request) : std::nullopt;
  if (!arc) {
    return std::nullopt;
  }
  const Point side = cross(bend.axis, in);
  const auto place = [&](Flat p) {
    return add_scaled(add_scaled(before.end_mm, in, p.x), side, p.y);
  };
  const Flat from = arc->before.point - arc->centre;
  const Flat to = arc->after.point - arc->centre;
  result.start_mm = place(arc->before.point);
  result.end_mm = place(arc->after.point);
  result.centre_mm = place(arc->centre);
  result.sweep_rad = std::atan2(outer(from, to), inner(from, to));
  // The rounding turns left, as the corner does: its sweep is positive.
  if (result.sweep_rad <= 0.0) {
    result.sweep_rad += 2.0 * std::numbers::pi;
  }
  result.taken_before_mm = -arc->before.distance;
  result.taken_after_mm = arc->after.distance;
  return result;
}

}  // namespace steadyrest::nc::plan
