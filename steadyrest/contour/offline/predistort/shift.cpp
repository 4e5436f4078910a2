// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr int kPoints = 4;  ///< parts of a piece
constexpr double kReach = 4.0;
constexpr double kLeastReach_mm = 1.0;

double end_of(const PathSegment& segment) noexcept {
  return segment.position_mm + segment.length_mm;
}

}  // namespace

Shift shift_of(const nc::plan::PlannedPath& path, const std::vector<Piece>& pieces,
               double bound_mm) {
  Shift out;
  const auto& segments = path.segments;
  std::size_t index = 0;
  for (const Piece& piece : pieces) {
    double largest = 0.0;
    const double around = std::max(kLeastReach_mm, kReach * bound_mm) + piece.segment.length_mm;
    while (index + 1 < segments.size() &&
           end_of(segments[index]) < piece.progress_start_mm - around) {
      ++index;
    }
    for (int i = 0; i <= kPoints; ++i) {
      const Point point = geometry::point_at(piece.segment, static_cast<double>(i) / kPoints);
      double nearest = 1e9;
      for (std::size_t j = index;
           j < segments.size() && segments[j].position_mm <= piece.progress_end_mm + around; ++j) {
        nearest = std::min(nearest, geometry::foot_point(segments[j], point).distance_mm);
      }
      largest = std::max(largest, nearest);
    }
    out.largest_mm = std::max(out.largest_mm, largest);
    if (largest > bound_mm && (out.too_far.empty() || out.too_far.back() != piece.segment.line)) {
      out.too_far.push_back(piece.segment.line);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
