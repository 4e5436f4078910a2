// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/tube_walk.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::math::geometry {
namespace {

using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

/// Part of a chord, by its parameter; empty when low > high.
struct Part {
  double low = 1.0;
  double high = 0.0;
  [[nodiscard]] bool empty() const noexcept { return low > high; }
};

/// The part of the chord a → b within `reach_mm` of a point.
Part free_part(const Point& point, const Point& a, const Point& b, double reach_mm) noexcept {
  if (!(reach_mm >= 0.0)) {
    return {};
  }
  const Point way = subtract(b, a);
  const Point from = subtract(a, point);
  const double way2 = norm_squared(way);
  const double miss = norm_squared(from) - reach_mm * reach_mm;
  if (!(way2 > 0.0)) {
    return miss <= 0.0 ? Part{0.0, 1.0} : Part{};
  }
  const double along = dot(from, way);
  const double square = along * along - way2 * miss;
  if (!(square >= 0.0)) {
    return {};
  }
  const double root = std::sqrt(square);
  const double low = (-along - root) / way2;
  const double high = (-along + root) / way2;
  return low > 1.0 || high < 0.0 ? Part{} : Part{std::max(0.0, low), std::min(1.0, high)};
}

/// From a point to that part of the chord a → b.
double distance_to_part(const Point& point, const Point& a, const Point& b, Part part) noexcept {
  const Point way = subtract(b, a);
  const double way2 = norm_squared(way);
  const double t = way2 > 0.0 ? dot(subtract(point, a), way) / way2 : part.low;
  return distance(point, add_scaled(a, way, std::clamp(t, part.low, part.high)));
}

/// What can be reached on the border between two rows: parts of the original's chords.
struct Row {
  std::size_t first = 0;
  std::vector<Part> parts;
  [[nodiscard]] std::size_t end() const noexcept { return first + parts.size(); }
  [[nodiscard]] Part at(std::size_t j) const noexcept {
    return j < first || j >= end() ? Part{} : parts[j - first];
  }
  void clear() noexcept { parts.clear(); }
  void put(std::size_t j, Part part) {
    if (parts.empty() && part.empty()) {
      return;
    }
    if (parts.empty()) {
      first = j;
    }
    parts.resize(j - first);
    parts.push_back(part);
  }
};

class Walker {
 public:
  Walker(const ChordPath& changed, const ChordPath& original, std::span<const ChordRange> permitted,
         double tube_mm)
      : changed_(changed),
        original_(original),
        permitted_(permitted),
        tube_mm_(tube_mm),
        nearest_mm_(original.points.size(), std::numeric_limits<double>::infinity()) {}

  TubeVerdict run() {
    Row below = start();
    Row above;
    for (std::size_t i = 0; i < changed_.size(); ++i) {
      above.clear();
      row(i, below, above);
      out_.changed = i;
      if (above.parts.empty()) {
        return out_;
      }
      std::swap(below, above);
    }
    const Part last = below.at(original_.size() - 1);
    out_.inside = !last.empty() && last.high >= 1.0;
    for (std::size_t j = 1; out_.inside && j + 1 < nearest_mm_.size(); ++j) {
      out_.farthest_mm = std::max(out_.farthest_mm, nearest_mm_[j]);
    }
    return out_;
  }

 private:
  /// The larger slack of two neighbouring chords: a border serves the pairs on both sides.
  static double slack_at(const ChordPath& path, std::size_t point) noexcept {
    const double before = point > 0 ? path.slack_mm[point - 1] : 0.0;
    return std::max(before, point < path.size() ? path.slack_mm[point] : 0.0);
  }
  [[nodiscard]] Part on_original(std::size_t i, std::size_t j) const noexcept {
    return free_part(changed_.points[i], original_.points[j], original_.points[j + 1],
                     tube_mm_ - original_.slack_mm[j] - slack_at(changed_, i));
  }
  [[nodiscard]] Part on_changed(std::size_t i, std::size_t j) const noexcept {
    return free_part(original_.points[j], changed_.points[i], changed_.points[i + 1],
                     tube_mm_ - changed_.slack_mm[i] - slack_at(original_, j));
  }

  /// The start of the changed path while the original goes on.
  Row start() {
    Row row;
    for (std::size_t j = 0; j < original_.size(); ++j) {
      const Part part = on_original(0, j);
      if (part.empty() || part.low > 0.0) {
        break;
      }
      row.put(j, part);
      if (part.high < 1.0) {
        break;
      }
      nearest_mm_[j + 1] = distance(changed_.points[0], original_.points[j + 1]);
    }
    return row;
  }

  /// All pairs of one chord of the changed path that can be reached.
  void row(std::size_t i, const Row& below, Row& above) {
    const ChordRange range = permitted_[i];
    std::size_t j = std::max<std::size_t>(below.first, range.first);
    Part beside;  // what can be reached of this chord at the original's point j
    if (j == 0 && !below.at(0).empty() && below.at(0).low <= 0.0) {
      const Part part = on_changed(i, 0);
      beside = !part.empty() && part.low <= 0.0 ? part : Part{};
    }
    const std::size_t end = std::min<std::size_t>(original_.size(), range.last + std::size_t{1});
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (; j < end && (j < below.end() || !beside.empty()); ++j) {
      const Part under = below.at(j);
      if (under.empty() && beside.empty()) {
        above.put(j, {});
        continue;
      }
      out_.original = std::max(out_.original, j);
      Part over = on_original(i + 1, j);
      Part next = on_changed(i, j + 1);
      if (beside.empty()) {
        over.low = std::max(over.low, under.low);
      }
      if (under.empty()) {
        next.low = std::max(next.low, beside.low);
      }
      if (!over.empty()) {
        nearest_mm =
            std::min(nearest_mm, distance_to_part(changed_.points[i + 1], original_.points[j],
                                                  original_.points[j + 1], over));
      }
      if (!next.empty()) {
        nearest_mm_[j + 1] = std::min(nearest_mm_[j + 1],
                                      distance_to_part(original_.points[j + 1], changed_.points[i],
                                                       changed_.points[i + 1], next));
      }
      above.put(j, over);
      beside = next;
    }
    while (!above.parts.empty() && above.parts.back().empty()) {
      above.parts.pop_back();
    }
    if (std::isfinite(nearest_mm) && nearest_mm > out_.farthest_mm) {
      out_.farthest_mm = nearest_mm;
      out_.farthest_changed = i;
    }
  }

  const ChordPath& changed_;
  const ChordPath& original_;
  std::span<const ChordRange> permitted_;
  double tube_mm_;
  std::vector<double> nearest_mm_;  ///< by point of the original
  TubeVerdict out_;
};

}  // namespace

// Between two points at u and u + h a curve leaves its chord, both linear in u, by at most
// h²·max|p″|/8; of an arc |p″| ≤ 2|ρ|ω + r·ω² (segment.hpp).
void ChordPath::add(const PathSegment& segment, double slack) {
  if (segment.geometry == Geometry::line) {
    points.push_back(segment.end_mm);
    slack_mm.push_back(0.0);
    return;
  }
  const double growth = std::abs(segment.radius_end_mm - segment.radius_mm);
  const double radius = std::max(segment.radius_mm, segment.radius_end_mm);
  const double bend =
      2.0 * growth * segment.sweep_rad + radius * segment.sweep_rad * segment.sweep_rad;
  const double chords = std::max(1.0, std::ceil(std::sqrt(bend / (8.0 * slack))));
  const double each_mm = bend / (8.0 * chords * chords);
  for (double i = 1.0; i < chords; ++i) {
    points.push_back(point_at(segment, i / chords));
    slack_mm.push_back(each_mm);
  }
  // The end as programmed; the law may miss it by what its radii are rounded.
  points.push_back(segment.end_mm);
  slack_mm.push_back(each_mm + distance(point_at(segment, 1.0), segment.end_mm));
}

TubeVerdict walk_tube(const ChordPath& changed, const ChordPath& original,
                      std::span<const ChordRange> permitted, double tube_mm) {
  return Walker(changed, original, permitted, tube_mm).run();
}

}  // namespace steadyrest::math::geometry
