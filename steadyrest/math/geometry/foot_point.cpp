// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Lines and circles in closed form; an arc that is a circle but for the rounding of its text from
// the circle's foot; helices and spirals by sampling at most π/6 apart and refining each dip. At
// most two turns are searched: the caller roughly knows where the foot is, and a foot beyond would
// be on another turn.
namespace steadyrest::math::geometry {
namespace {

using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::units::kTurn;

constexpr int kMaxSamples = 25;  // π/6 apart: two turns
// Newton doubles its digits each step; bisection steps in between are few.
constexpr int kMaxSteps = 12;
// A step of Newton so small is the last: what it leaves is its square.
constexpr double kLastStep = 1e-9;
constexpr double kRounding = 1e-15;
// An arc whose radius grows by less is round enough for its circle's foot to begin with, …
constexpr double kRound = 1e-3;
constexpr double kLessThanATurn = 0.9 * kTurn;  // … within so much of a turn …
constexpr double kOffCentre = 0.1;              // … and so many radii away from the centre.

// The projection, clamped to the permitted part.
Foot foot_on_line(const PathSegment& segment, const Point& query, double u_low,
                  double u_high) noexcept {
  const Point along = subtract(segment.end_mm, segment.start_mm);
  const double length_squared = norm_squared(along);
  double u = u_low;
  if (length_squared > 0.0) {
    u = std::clamp(dot(subtract(query, segment.start_mm), along) / length_squared, u_low, u_high);
  }
  const Point point = add_scaled(segment.start_mm, along, u);
  return {u, distance(point, query), point};
}

/// The query in the arc's own frame: x, y in its plane about the centre, z along the axis.
struct Local {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

// In the arc's frame the axis is z: distances along it separate from those in the plane.
Local local_of(const PathSegment& segment, const ArcFrame& frame, const Point& query) noexcept {
  const Point from_centre = subtract(query, segment.centre_mm);
  return {dot(from_centre, frame.e1), dot(from_centre, frame.e2), dot(from_centre, segment.axis)};
}

Point global_of(const PathSegment& segment, const ArcFrame& frame, const Local& local) noexcept {
  Point point = add_scaled(segment.centre_mm, frame.e1, local.x);
  point = add_scaled(point, frame.e2, local.y);
  return add_scaled(point, segment.axis, local.z);
}

Foot foot_on_circle(const PathSegment& segment, const Point& query, double u_low, double u_high,
                    double u_near) noexcept {
  const ArcFrame frame = arc_frame(segment);
  const Local q = local_of(segment, frame, query);
  // From its axis a circle is equally far everywhere; any of its points is nearest there.
  const double rho = norm({q.x, q.y, 0.0});
  const double angle = std::atan2(q.y, q.x);
  // The turn whose point at this angle lies nearest to u_near, then moved into the permitted part.
  const double near_angle = u_near * segment.sweep_rad;
  double best = angle + kTurn * std::round((near_angle - angle) / kTurn);
  const double low = u_low * segment.sweep_rad;
  const double high = u_high * segment.sweep_rad;
  if (best < low) {
    best += kTurn * std::ceil((low - best) / kTurn);
  } else if (best > high) {
    best -= kTurn * std::ceil((best - high) / kTurn);
  }
  if (best >= low && best <= high && rho > 0.0) {
    const double grow = segment.radius_mm / rho;
    const Local foot{q.x * grow, q.y * grow, 0.0};
    return {best / segment.sweep_rad, norm({rho - segment.radius_mm, q.z, 0.0}),
            global_of(segment, frame, foot)};
  }
  // No point at the query's angle within the permitted part: one of its ends is nearest.
  const auto at = [&](double u) {
    const double a = u * segment.sweep_rad;
    const Local p{segment.radius_mm * std::cos(a), segment.radius_mm * std::sin(a), 0.0};
    return Foot{u, norm({p.x - q.x, p.y - q.y, q.z}), global_of(segment, frame, p)};
  };
  const Foot first = at(u_low);
  const Foot last = at(u_high);
  return last.distance_mm < first.distance_mm ? last : first;
}

/// Helix or spiral in its own frame: squared distance to the query and derivatives by u.
class Curve {
 public:
  Curve(const PathSegment& segment, const Local& query) noexcept
      : segment_(segment), query_(query), growth_(segment.radius_end_mm - segment.radius_mm) {}

  [[nodiscard]] Local point(double u) const noexcept {
    const double angle = u * segment_.sweep_rad;
    const double r = segment_.radius_mm + u * growth_;
    return {r * std::cos(angle), r * std::sin(angle), u * segment_.rise_mm};
  }
  [[nodiscard]] double distance_squared(double u) const noexcept {
    const Local p = point(u);
    const double dx = p.x - query_.x;
    const double dy = p.y - query_.y;
    const double dz = p.z - query_.z;
    return dx * dx + dy * dy + dz * dz;
  }
  /// Half the first and half the second derivative of the squared distance.
  [[nodiscard]] std::array<double, 2> slope(double u) const noexcept {
    const double omega = segment_.sweep_rad;
    const double c = std::cos(u * omega);
    const double s = std::sin(u * omega);
    const double r = segment_.radius_mm + u * growth_;
    const double dx = r * c - query_.x;
    const double dy = r * s - query_.y;
    const double dz = u * segment_.rise_mm - query_.z;
    const double px = growth_ * c - r * omega * s;
    const double py = growth_ * s + r * omega * c;
    const double pz = segment_.rise_mm;
    const double qx = -2.0 * growth_ * omega * s - r * omega * omega * c;
    const double qy = 2.0 * growth_ * omega * c - r * omega * omega * s;
    return {dx * px + dy * py + dz * pz, px * px + py * py + pz * pz + dx * qx + dy * qy};
  }

 private:
  const PathSegment& segment_;
  Local query_;
  double growth_;
};

// Newton on the slope of the squared distance, kept inside the bracket by bisection: where the
// second derivative is not positive (beyond the centre of curvature) Newton would run to a maximum.
double refine(const Curve& curve, double low, double high, double start) noexcept {
  // A bracket that ends where the permitted part ends may have its minimum there.
  if (start <= low && curve.slope(low)[0] >= 0.0) {
    return low;
  }
  if (start >= high && curve.slope(high)[0] <= 0.0) {
    return high;
  }
  double u = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto [first, second] = curve.slope(u);
    (first > 0.0 ? high : low) = u;
    double next = second > 0.0 ? u - first / second : low - 1.0;
    const bool newton = next >= low && next <= high;
    if (!newton) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - u) <= (newton ? kLastStep : kRounding)) {
      return next;
    }
    u = next;
  }
  return u;
}

bool is_nearly_round(const PathSegment& segment, double u_low, double u_high) noexcept {
  const double growth_mm = std::abs(segment.radius_end_mm - segment.radius_mm);
  return segment.rise_mm == 0.0 &&
         growth_mm <= kRound * std::min(segment.radius_mm, segment.radius_end_mm) &&
         (u_high - u_low) * segment.sweep_rad <= kLessThanATurn;
}

// Off the centre the squared distance to a circle has one minimum, at the query's own angle; where
// that is not permitted the nearest end is the least. So it is here, but for the growth.
double foot_from_circle(const Curve& curve, const PathSegment& segment, const Local& query,
                        double u_low, double u_high) noexcept {
  const double low = u_low * segment.sweep_rad;
  double angle = std::atan2(query.y, query.x);
  angle += kTurn * std::ceil((low - angle) / kTurn);
  if (angle <= u_high * segment.sweep_rad) {
    return refine(curve, u_low, u_high, std::clamp(angle / segment.sweep_rad, u_low, u_high));
  }
  const auto nearer = [&](double a, double b) {
    return curve.distance_squared(a) < curve.distance_squared(b);
  };
  const double end = std::min(u_low, u_high, nearer);
  return std::min(end, refine(curve, u_low, u_high, end), nearer);
}

Foot foot_on_helix(const PathSegment& segment, const Point& query, double u_low, double u_high,
                   double u_near) noexcept {
  const double max_step = std::numbers::pi / 6.0 / segment.sweep_rad;
  const double reach = max_step * (kMaxSamples - 1) / 2.0;
  const double near = std::clamp(u_near, u_low, u_high);
  const double low = std::max(u_low, near - reach);
  const double high = std::min(u_high, near + reach);
  const int count =
      std::clamp(static_cast<int>(std::ceil((high - low) / max_step)) + 1, 3, kMaxSamples);
  // At π/6 the squared distance has at most one dip between two samples.
  const double step = (high - low) / (count - 1);

  const ArcFrame frame = arc_frame(segment);
  const Local local = local_of(segment, frame, query);
  const Curve curve(segment, local);
  if (is_nearly_round(segment, u_low, u_high) &&
      norm({local.x, local.y, 0.0}) >= kOffCentre * segment.radius_mm) {
    const double u = foot_from_circle(curve, segment, local, u_low, u_high);
    const Local foot = curve.point(u);
    return {u, norm({foot.x - local.x, foot.y - local.y, foot.z - local.z}),
            global_of(segment, frame, foot)};
  }
  std::array<double, kMaxSamples> sample{};
  for (int i = 0; i < count; ++i) {
    sample[static_cast<std::size_t>(i)] = curve.distance_squared(low + step * i);
  }
  double best_u = low;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool falls_before = i == 0 || sample[at] <= sample[at - 1];
    const bool rises_after = i == count - 1 || sample[at] <= sample[at + 1];
    if (!falls_before || !rises_after) {
      continue;
    }
    const double u = refine(curve, std::max(low, low + step * (i - 1)),
                            std::min(high, low + step * (i + 1)), low + step * i);
    const double squared = curve.distance_squared(u);
    if (squared < best) {
      best = squared;
      best_u = u;
    }
  }
  return {best_u, std::sqrt(best), global_of(segment, frame, curve.point(best_u))};
}

}  // namespace

Foot foot_point(const PathSegment& segment, const Point& query, double u_low, double u_high,
                double u_near) noexcept {
  if (segment.geometry == Geometry::line || !(segment.sweep_rad > 0.0)) {
    return foot_on_line(segment, query, u_low, u_high);
  }
  if (segment.rise_mm == 0.0 && segment.radius_end_mm == segment.radius_mm) {
    return foot_on_circle(segment, query, u_low, u_high, u_near);
  }
  return foot_on_helix(segment, query, u_low, u_high, u_near);
}

}  // namespace steadyrest::math::geometry
