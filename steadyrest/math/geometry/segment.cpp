// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// An arc of any kind is r(u) = r₀ + u·ρ, angle u·ω, height u·z, u from 0 to 1: circle, helix,
// spiral and both together. Length is proportional to u except on spirals, which need an
// integral.
namespace steadyrest::math::geometry {
namespace {

using kernel::signal::Geometry;
using kernel::signal::PathSegment;

// Only on a spiral does the speed along the parameter change.
bool is_spiral(const PathSegment& segment) noexcept {
  return segment.geometry == Geometry::arc && segment.radius_end_mm != segment.radius_mm;
}

/// ∫₀ᵘ √(m² + (ω·r)²) dv with r = radius + v·ρ.
double spiral_length(const PathSegment& segment, double u) noexcept {
  const double growth = segment.radius_end_mm - segment.radius_mm;
  const double m2 = growth * growth + segment.rise_mm * segment.rise_mm;
  const double scale_up = segment.sweep_rad * growth;  // dy/du with y = ω·r
  const double y0 = segment.sweep_rad * segment.radius_mm;
  const double y1 = y0 + scale_up * u;
  const double w0 = std::sqrt(m2 + y0 * y0);
  const double w1 = std::sqrt(m2 + y1 * y1);
  // A spiral that hardly grows: the difference of the primitives cancels, Simpson's rule does not.
  if (std::abs(y1 - y0) < 1e-3 * w0) {
    const double ym = 0.5 * (y0 + y1);
    return u / 6.0 * (w0 + 4.0 * std::sqrt(m2 + ym * ym) + w1);
  }
  // ½(y·w + m²·asinh(y/m)) between the ends; the difference of both asinh is one logarithm.
  return 0.5 * (y1 * w1 - y0 * w0 + m2 * std::log((y1 + w1) / (y0 + w0))) / scale_up;
}

double spiral_speed(const PathSegment& segment, double u) noexcept {
  const double growth = segment.radius_end_mm - segment.radius_mm;
  const double r = segment.radius_mm + u * growth;
  return std::sqrt(growth * growth + segment.rise_mm * segment.rise_mm +
                   r * r * segment.sweep_rad * segment.sweep_rad);
}

}  // namespace

ArcFrame arc_frame(const PathSegment& segment) noexcept {
  const Point out = subtract(segment.start_mm, segment.centre_mm);
  // A spiral may begin at its centre; any direction in the plane will do for the first point there.
  if (segment.radius_mm > 0.0) {
    const Point e1 = unit(out);
    return {e1, cross(segment.axis, e1)};
  }
  // The world axis that is farther from the arc's axis: their cross product is well conditioned.
  const Point away = std::abs(segment.axis[0]) < 0.9 ? Point{1, 0, 0} : Point{0, 1, 0};
  const Point e1 = unit(add_scaled(away, segment.axis, -dot(away, segment.axis)));
  return {e1, cross(segment.axis, e1)};
}

Point point_at(const PathSegment& segment, double u) noexcept {
  if (segment.geometry == Geometry::line) {
    return add_scaled(segment.start_mm, subtract(segment.end_mm, segment.start_mm), u);
  }
  const ArcFrame frame = arc_frame(segment);
  const double r = segment.radius_mm + u * (segment.radius_end_mm - segment.radius_mm);
  const double angle = u * segment.sweep_rad;
  Point point = add_scaled(segment.centre_mm, frame.e1, r * std::cos(angle));
  point = add_scaled(point, frame.e2, r * std::sin(angle));
  return add_scaled(point, segment.axis, u * segment.rise_mm);
}

Station station_at(const PathSegment& segment, double u) noexcept {
  if (segment.geometry == Geometry::line) {
    return {point_at(segment, u), unit(subtract(segment.end_mm, segment.start_mm)), {}};
  }
  const ArcFrame frame = arc_frame(segment);
  const double growth = segment.radius_end_mm - segment.radius_mm;
  const double r = segment.radius_mm + u * growth;
  const double cosine = std::cos(u * segment.sweep_rad);
  const double sine = std::sin(u * segment.sweep_rad);
  const Point outward = add(scale(frame.e1, cosine), scale(frame.e2, sine));
  const Point forward = add(scale(frame.e1, -sine), scale(frame.e2, cosine));

  Station station;
  station.point_mm =
      add_scaled(add_scaled(segment.centre_mm, outward, r), segment.axis, u * segment.rise_mm);
  // p′ and p″ by u; κ⃗ is the part of p″ across the tangent over |p′|², whatever the parameter.
  const Point first = add(add_scaled(scale(outward, growth), forward, r * segment.sweep_rad),
                          scale(segment.axis, segment.rise_mm));
  const Point second = add_scaled(scale(forward, 2.0 * growth * segment.sweep_rad), outward,
                                  -r * segment.sweep_rad * segment.sweep_rad);
  const double speed_squared = norm_squared(first);
  if (speed_squared <= 0.0) {
    return station;
  }
  station.tangent = scale(first, 1.0 / std::sqrt(speed_squared));
  const Point normal_part = add_scaled(second, station.tangent, -dot(second, station.tangent));
  station.curvature_1_mm = scale(normal_part, 1.0 / speed_squared);
  return station;
}

double arc_length_mm(const PathSegment& segment) noexcept {
  if (segment.geometry == Geometry::line) {
    return distance(segment.start_mm, segment.end_mm);
  }
  if (is_spiral(segment)) {
    return spiral_length(segment, 1.0);
  }
  return std::hypot(segment.radius_mm * segment.sweep_rad, segment.rise_mm);
}

// Only a spiral's length is not proportional to its parameter.
double distance_at(const PathSegment& segment, double u) noexcept {
  return is_spiral(segment) ? spiral_length(segment, u) : u * segment.length_mm;
}

double parameter_at(const PathSegment& segment, double distance_mm) noexcept {
  if (!(segment.length_mm > 0.0)) {
    return 0.0;
  }
  const double share = std::clamp(distance_mm / segment.length_mm, 0.0, 1.0);
  if (!is_spiral(segment) || share == 0.0 || share == 1.0) {
    return share;
  }
  const double wanted = share * segment.length_mm;
  // Start: the root of ω·(r₀u + ρu²/2) = share·(the same at u = 1), which only omits m².
  const double r0 = segment.radius_mm;
  const double r1 = segment.radius_end_mm;
  double u = share * (r0 + r1) / (r0 + std::sqrt(r0 * r0 + share * (r1 - r0) * (r0 + r1)));
  double low = 0.0;
  double high = 1.0;
  // Newton on the length, with the speed as its derivative, inside a bracket.
  for (int iteration = 0; iteration < 12; ++iteration) {
    const double excess = spiral_length(segment, u) - wanted;
    (excess > 0.0 ? high : low) = u;
    double next = u - excess / spiral_speed(segment, u);
    if (!(next >= low && next <= high)) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - u) < 1e-12) {
      return next;
    }
    u = next;
  }
  return u;
}

kernel::signal::PathSegment part_of(const kernel::signal::PathSegment& segment, double from_mm,
                                    double to_mm) noexcept {
  const double u0 = parameter_at(segment, from_mm);
  const double u1 = to_mm >= segment.length_mm ? 1.0 : parameter_at(segment, to_mm);
  kernel::signal::PathSegment part = segment;
  part.start_mm = u0 == 0.0 ? segment.start_mm : point_at(segment, u0);
  part.end_mm = u1 == 1.0 ? segment.end_mm : point_at(segment, u1);
  if (segment.geometry == kernel::signal::Geometry::arc) {
    const double wider = segment.radius_end_mm - segment.radius_mm;
    part.centre_mm = add_scaled(segment.centre_mm, segment.axis, u0 * segment.rise_mm);
    part.radius_mm = segment.radius_mm + u0 * wider;
    part.radius_end_mm = segment.radius_mm + u1 * wider;
    part.sweep_rad = (u1 - u0) * segment.sweep_rad;
    part.rise_mm = (u1 - u0) * segment.rise_mm;
  }
  for (std::size_t i = 0; i < part.other_start.size(); ++i) {
    const double way = segment.other_end[i] - segment.other_start[i];
    part.other_start[i] = segment.other_start[i] + u0 * way;
    part.other_end[i] = segment.other_start[i] + u1 * way;
  }
  part.position_mm = segment.position_mm + from_mm;
  part.length_mm = to_mm - from_mm;
  return part;
}

}  // namespace steadyrest::math::geometry
