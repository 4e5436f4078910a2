// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kStraight_mm = 3000.0;  ///< a wider arc is written as a line
constexpr double kShortest_mm = 1e-6;
constexpr double kLeastTurn_rad = 1e-5;

}  // namespace

PathSegment line_segment(const Point& start, const Point& end) {
  PathSegment segment;
  segment.start_mm = start;
  segment.end_mm = end;
  segment.length_mm = geometry::distance(start, end);
  return segment;
}

// With the tangent t and the chord d in the plane, the centre is at r = d²/(2·t×d) to the left.
std::optional<PathSegment> arc_from_tangent(nc::interpret::Plane plane, const Point& start,
                                            const Point& tangent, const Point& end) {
  const auto axes = nc::interpret::axes_of(plane);
  const double dx = end[axes.first] - start[axes.first];
  const double dy = end[axes.second] - start[axes.second];
  const double flat = std::hypot(tangent[axes.first], tangent[axes.second]);
  const double square = dx * dx + dy * dy;
  if (!(flat > 0.0) || square < kShortest_mm * kShortest_mm) {
    return std::nullopt;
  }
  const double tx = tangent[axes.first] / flat;
  const double ty = tangent[axes.second] / flat;
  const double across = tx * dy - ty * dx;
  if (std::abs(across) * 2.0 * kStraight_mm < square) {
    return std::nullopt;
  }
  const double r = square / (2.0 * across);  // > 0: to the left
  PathSegment arc;
  arc.geometry = Geometry::arc;
  arc.start_mm = start;
  arc.end_mm = end;
  arc.centre_mm = start;
  arc.centre_mm[axes.first] -= ty * r;
  arc.centre_mm[axes.second] += tx * r;
  const double side = r > 0.0 ? 1.0 : -1.0;
  arc.axis[axes.normal] = side;
  arc.radius_mm = arc.radius_end_mm = std::abs(r);
  const auto angle = [&](const Point& p) {
    return std::atan2(p[axes.second] - arc.centre_mm[axes.second],
                      p[axes.first] - arc.centre_mm[axes.first]);
  };
  arc.sweep_rad =
      std::fmod(side * (angle(end) - angle(start)) + kernel::units::kTurn, kernel::units::kTurn);
  arc.rise_mm = side * (end[axes.normal] - start[axes.normal]);
  arc.length_mm = std::hypot(arc.radius_mm * arc.sweep_rad, arc.rise_mm);
  return arc;
}

bool is_written_as_arc(const PathSegment& segment) noexcept {
  return segment.geometry == Geometry::arc && segment.sweep_rad > kLeastTurn_rad &&
         std::min(segment.radius_mm, segment.radius_mm * segment.sweep_rad) > kLeastArc_mm;
}

Piece part_of(const Piece& piece, double u, double w) {
  Piece part = piece;
  part.segment = geometry::part_of(
      piece.segment, geometry::distance_at(piece.segment, u),
      w >= 1.0 ? piece.segment.length_mm : geometry::distance_at(piece.segment, w));
  const double span = piece.progress_end_mm - piece.progress_start_mm;
  part.progress_start_mm = piece.progress_start_mm + u * span;
  part.progress_end_mm = piece.progress_start_mm + w * span;
  return part;
}

}  // namespace steadyrest::contour::offline
