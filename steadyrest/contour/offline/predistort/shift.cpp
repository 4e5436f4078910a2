// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kBetween_mm = 0.5;
constexpr int kPoints = 4;  ///< parts of a piece, or as many times that as …
constexpr int kMostTimes = 16;
constexpr double kReach = 4.0;
constexpr double kLeastReach_mm = 1.0;
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

  void add(const Point& point) noexcept {
    for (std::size_t i = 0; i < point.size(); ++i) {
      low[i] = std::min(low[i], point[i]);
      high[i] = std::max(high[i], point[i]);
    }
  }

  /// An arc reaches farthest along an axis at its ends or at its quadrants.
  void add(const PathSegment& segment) noexcept {
    add(segment.start_mm);
    add(segment.end_mm);
    if (segment.geometry == kernel::signal::Geometry::line || !(segment.sweep_rad > 0.0)) {
      return;
    }
    const geometry::ArcFrame frame = geometry::arc_frame(segment);
    for (std::size_t i = 0; i < low.size(); ++i) {
      const double first = std::atan2(frame.e2[i], frame.e1[i]);
      for (double angle = first; angle < segment.sweep_rad; angle += std::numbers::pi) {
        if (angle > 0.0) {
          add(geometry::point_at(segment, angle / segment.sweep_rad));
        }
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
    const int points =
        kPoints * std::clamp(static_cast<int>(piece.segment.length_mm / (kPoints * kBetween_mm)), 1,
                             kMostTimes);
    double largest = 0.0;
    // Farther along, the path may come past again, as the next turn of a spiral does: being near
    // that does not count.
    const double around = std::max(kLeastReach_mm, kReach * bound_mm) +
                          piece.segment.length_mm / static_cast<double>(points);
    for (int i = 0; i <= points; ++i) {
      const double along = static_cast<double>(i) / points;
      const double place_mm = std::lerp(piece.progress_start_mm, piece.progress_end_mm, along);
      neighbours.within(place_mm - around, place_mm + around);
      // What is nearer than the largest so far, and within the bound, changes nothing.
      largest = std::max(
          largest, neighbours.nearest_mm(geometry::point_at(piece.segment, along), place_mm,
                                         std::min(bound_mm, std::max(largest, out.largest_mm))));
    }
    out.largest_mm = std::max(out.largest_mm, largest);
    if (largest > bound_mm && (out.too_far.empty() || out.too_far.back() != piece.segment.line)) {
      out.too_far.push_back(piece.segment.line);
    }
  }
  return out;
}

Travel::Travel(const nc::plan::PlannedPath& path, std::span<const kernel::machine::Axis> axes) {
  Box used;
  for (const PathSegment& segment : path.segments) {
    used.add(segment);
  }
  low_mm_.fill(-kFar_mm);
  high_mm_.fill(kFar_mm);
  for (std::size_t i = 0; i < std::min(axes.size(), low_mm_.size()); ++i) {
    low_mm_[i] = std::min(used.low[i], axes[i].min_au) - kTravelNoise_mm;
    high_mm_[i] = std::max(used.high[i], axes[i].max_au) + kTravelNoise_mm;
  }
}

std::vector<std::uint32_t> Travel::left_by(const std::vector<Piece>& pieces) const {
  std::vector<std::uint32_t> out;
  for (const Piece& piece : pieces) {
    Box own;
    own.add(piece.segment);
    bool left = false;
    for (std::size_t i = 0; i < low_mm_.size(); ++i) {
      left = left || own.low[i] < low_mm_[i] || own.high[i] > high_mm_[i];
    }
    if (left && (out.empty() || out.back() != piece.segment.line)) {
      out.push_back(piece.segment.line);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
