// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include <steadyrest/contour/offline/predistort/shape/curve_fit.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using Segments = std::vector<PathSegment>;

constexpr double kLineTolerance = 0.2;   ///< of the tolerance
constexpr double kLineTurn_rad = 2e-3;   ///< between a line and the curve at its ends
constexpr double kShort_mm = 0.01;       ///< a span that is not worth more than a line
constexpr double kDetour = 1.3;          ///< a biarc longer than this share of the polygon loops
constexpr double kSameCentre_mm = 5e-4;  ///< two arcs with such centres are one

class Fit {
 public:
  Fit(const std::vector<CurvePoint>& points, const FitConfig& config)
      : points_(points), config_(config) {}

  std::vector<Piece> run() {
    if (points_.size() > 1) {
      span(0, points_.size() - 1);
    }
    return std::move(pieces_);
  }

 private:
  void span(std::size_t from, std::size_t to) {
    const CurvePoint& a = points_[from];
    const CurvePoint& b = points_[to];
    Segments line = {line_segment(a.point_mm, b.point_mm)};
    if (config_.one_line || is_line(line, from, to)) {
      put(line, from, to);
      return;
    }
    if (const auto arcs = biarc(from, to)) {
      put(*arcs, from, to);
      return;
    }
    if (to == from + 1) {
      put(line, from, to);
      return;
    }
    const std::size_t middle = from + (to - from) / 2;
    span(from, middle);
    span(middle, to);
  }

  [[nodiscard]] bool is_line(const Segments& line, std::size_t from, std::size_t to) const {
    const double missed = largest_miss_mm(line, from, to);
    if (line[0].length_mm < kShort_mm) {
      return missed <= config_.tolerance_mm;
    }
    const Point along = geometry::unit(geometry::subtract(line[0].end_mm, line[0].start_mm));
    const double turn = std::max(geometry::distance(along, points_[from].direction),
                                 geometry::distance(along, points_[to].direction));
    return missed <= kLineTolerance * config_.tolerance_mm && turn < kLineTurn_rad;
  }

  /// Of the points between, by the nearest segment.
  [[nodiscard]] double largest_miss_mm(std::span<const PathSegment> segments, std::size_t from,
                                       std::size_t to) const {
    double largest = 0.0;
    for (std::size_t i = from + 1; i < to; ++i) {
      double nearest = 1e9;
      for (const PathSegment& segment : segments) {
        nearest = std::min(nearest, geometry::foot_point(segment, points_[i].point_mm).distance_mm);
      }
      largest = std::max(largest, nearest);
    }
    return largest;
  }

  [[nodiscard]] double polygon_mm(std::size_t from, std::size_t to) const {
    double length = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      length += geometry::distance(points_[i].point_mm, points_[i + 1].point_mm);
    }
    return length;
  }

  /// A direction in the plane.
  [[nodiscard]] std::optional<Point> flat(const Point& direction) const {
    Point in_plane = direction;
    in_plane[nc::interpret::axes_of(config_.plane).normal] = 0.0;
    const double length = geometry::norm(in_plane);
    return length > 1e-6 ? std::optional(geometry::scale(in_plane, 1.0 / length)) : std::nullopt;
  }

  /// Where the two arcs meet: both tangents have the length d.
  [[nodiscard]] std::optional<Point> meeting(const Point& a, const Point& ta, const Point& b,
                                             const Point& tb) const {
    const std::size_t normal = nc::interpret::axes_of(config_.plane).normal;
    Point chord = geometry::subtract(b, a);
    chord[normal] = 0.0;
    const double along = geometry::dot(chord, geometry::add(ta, tb));
    const double bend = 2.0 * (1.0 - geometry::dot(ta, tb));
    const double square = geometry::norm_squared(chord);
    const double d = bend < 1e-12 ? square / (4.0 * geometry::dot(chord, tb))
                                  : (-along + std::sqrt(along * along + bend * square)) / bend;
    if (!std::isfinite(d) || d <= 0.0) {
      return std::nullopt;
    }
    Point meet = geometry::scale(geometry::add(a, b), 0.5);
    meet = geometry::add_scaled(meet, geometry::subtract(ta, tb), 0.5 * d);
    const auto flat_distance = [normal](Point p, const Point& q) {
      p[normal] = q[normal];
      return geometry::distance(p, q);
    };
    const double before = flat_distance(a, meet);
    const double after = flat_distance(b, meet);
    meet[normal] = a[normal] + (b[normal] - a[normal]) * before / (before + after);
    return meet;
  }

  [[nodiscard]] std::optional<Segments> biarc(std::size_t from, std::size_t to) const {
    const Point& a = points_[from].point_mm;
    const Point& b = points_[to].point_mm;
    const auto ta = flat(points_[from].direction);
    const auto tb = flat(points_[to].direction);
    const auto meet = ta && tb ? meeting(a, *ta, b, *tb) : std::nullopt;
    if (!meet) {
      return std::nullopt;
    }
    Segments both;
    const auto first = arc_from_tangent(config_.plane, a, *ta, *meet);
    both.push_back(first.value_or(line_segment(a, *meet)));
    const auto between = flat(geometry::station_at(both[0], 1.0).tangent);
    const auto second =
        between ? arc_from_tangent(config_.plane, *meet, *between, b) : std::nullopt;
    both.push_back(second.value_or(line_segment(*meet, b)));
    const double length = both[0].length_mm + both[1].length_mm;
    if (length > kDetour * polygon_mm(from, to) + 0.5 * kShort_mm ||
        largest_miss_mm(both, from, to) > config_.tolerance_mm) {
      return std::nullopt;
    }
    if (first && second && first->axis == second->axis) {
      if (auto one = single(*first, *second, *ta); one) {
        if (largest_miss_mm({&*one, 1}, from, to) <= config_.tolerance_mm) {
          return Segments{*one};
        }
      }
    }
    return both;
  }

  /// Both arcs in one, if they have the same centre and turn by less than half a turn.
  [[nodiscard]] std::optional<PathSegment> single(const PathSegment& first,
                                                  const PathSegment& second,
                                                  const Point& tangent) const {
    Point centre = second.centre_mm;
    const std::size_t normal = nc::interpret::axes_of(config_.plane).normal;
    centre[normal] = first.centre_mm[normal];
    if (geometry::distance(first.centre_mm, centre) > kSameCentre_mm ||
        first.sweep_rad + second.sweep_rad > 3.0) {
      return std::nullopt;
    }
    return arc_from_tangent(config_.plane, first.start_mm, tangent, second.end_mm);
  }

  void put(const Segments& segments, std::size_t from, std::size_t to) {
    double whole = 0.0;
    for (const PathSegment& segment : segments) {
      whole += segment.length_mm;
    }
    double progress = points_[from].progress_mm;
    const double gain = points_[to].progress_mm - progress;
    for (const PathSegment& segment : segments) {
      Piece piece;
      piece.segment = segment;
      piece.progress_start_mm = progress;
      progress += whole > 0.0 ? gain * segment.length_mm / whole : gain;
      piece.progress_end_mm = progress;
      pieces_.push_back(piece);
    }
  }

  const std::vector<CurvePoint>& points_;
  const FitConfig& config_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<Piece> fit_curve(const std::vector<CurvePoint>& points, const FitConfig& config) {
  return Fit(points, config).run();
}

}  // namespace steadyrest::contour::offline
