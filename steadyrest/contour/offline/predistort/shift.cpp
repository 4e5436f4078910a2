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
constexpr int kArcParts = 64;
constexpr double kFar_mm = 1e12;
constexpr double kTravelNoise_mm = 1e-6;

double end_of(const PathSegment& segment) noexcept {
  return segment.position_mm + segment.length_mm;
}

/// The segments of a path in order.
class Neighbours {
 public:
  explicit Neighbours(const std::vector<PathSegment>& segments) noexcept : segments_(segments) {}

  /// Those between two places along the path; both may only grow from call to call.
  void within(double from_mm, double to_mm) noexcept {
    while (first_ + 1 < segments_.size() && end_of(segments_[first_]) < from_mm) {
      ++first_;
    }
    to_mm_ = to_mm;
    likely_ = std::max(likely_, first_);
  }

  /// Distance to the nearest of them, or any one that is at most `enough_mm`: the search begins
  /// with the segment at this place, which is nearly always near enough.
  [[nodiscard]] double nearest_mm(const Point& point, double place_mm, double enough_mm) noexcept {
    while (likely_ + 1 < segments_.size() && end_of(segments_[likely_]) < place_mm) {
      ++likely_;
    }
    double nearest = geometry::foot_point(segments_[likely_], point).distance_mm;
    for (std::size_t j = first_;
         nearest > enough_mm && j < segments_.size() && segments_[j].position_mm <= to_mm_; ++j) {
      nearest = std::min(nearest, geometry::foot_point(segments_[j], point).distance_mm);
    }
    return nearest;
  }

 private:
  const std::vector<PathSegment>& segments_;
  std::size_t first_ = 0;
  std::size_t likely_ = 0;
  double to_mm_ = 0.0;
};

/// The box that a path stays within.
struct Box {
  Point low{kFar_mm, kFar_mm, kFar_mm};
  Point high{-kFar_mm, -kFar_mm, -kFar_mm};

  void add(const PathSegment& segment) noexcept {
    const bool arc = segment.geometry == kernel::signal::Geometry::arc;
    const int parts = arc ? kArcParts : 1;
    // How far an arc bulges between two of its points.
    const double beside = arc ? std::max(segment.radius_mm, segment.radius_end_mm) *
                                    (1.0 - std::cos(std::min(0.5 * segment.sweep_rad / parts, 1.5)))
                              : 0.0;
    for (int k = 0; k <= parts; ++k) {
      const Point point = geometry::point_at(segment, static_cast<double>(k) / parts);
      const double more = k == 0 || k == parts ? 0.0 : beside;
      for (std::size_t i = 0; i < point.size(); ++i) {
        low[i] = std::min(low[i], point[i] - more);
        high[i] = std::max(high[i], point[i] + more);
      }
    }
  }
};

}  // namespace

Shift shift_of(const nc::plan::PlannedPath& path, const std::vector<Piece>& pieces,
               double bound_mm) {
  Shift out;
  Neighbours neighbours(path.segments);
  for (const Piece& piece : pieces) {
    double largest = 0.0;
    const double around = std::max(kLeastReach_mm, kReach * bound_mm) + piece.segment.length_mm;
    neighbours.within(piece.progress_start_mm - around, piece.progress_end_mm + around);
    for (int i = 0; i <= kPoints; ++i) {
      const double along = static_cast<double>(i) / kPoints;
      // What is nearer than the largest so far, and within the bound, changes nothing.
      largest = std::max(
          largest,
          neighbours.nearest_mm(geometry::point_at(piece.segment, along),
                                std::lerp(piece.progress_start_mm, piece.progress_end_mm, along),
                                std::min(bound_mm, std::max(largest, out.largest_mm))));
    }
    out.largest_mm = std::max(out.largest_mm, largest);
    if (largest > bound_mm && (out.too_far.empty() || out.too_far.back() != piece.segment.line)) {
      out.too_far.push_back(piece.segment.line);
    }
  }
  return out;
}

std::vector<std::uint32_t> past_travel(const nc::plan::PlannedPath& path,
                                       const std::vector<Piece>& pieces,
                                       std::span<const kernel::machine::Axis> axes) {
  Box allowed;
  for (const PathSegment& segment : path.segments) {
    allowed.add(segment);
  }
  const std::size_t count = std::min<std::size_t>(axes.size(), 3);
  for (std::size_t i = 0; i < count; ++i) {
    allowed.low[i] = std::min(allowed.low[i], axes[i].min_au) - kTravelNoise_mm;
    allowed.high[i] = std::max(allowed.high[i], axes[i].max_au) + kTravelNoise_mm;
  }
  std::vector<std::uint32_t> out;
  for (const Piece& piece : pieces) {
    Box own;
    own.add(piece.segment);
    bool past = false;
    for (std::size_t i = 0; i < count; ++i) {
      past = past || own.low[i] < allowed.low[i] || own.high[i] > allowed.high[i];
    }
    if (past && (out.empty() || out.back() != piece.segment.line)) {
      out.push_back(piece.segment.line);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
