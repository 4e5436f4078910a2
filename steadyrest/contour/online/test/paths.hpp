// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <steadyrest/kernel/signal/in_force.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

/// Builds contiguous paths for tests and benchmarks.
namespace steadyrest::contour::online::test {

using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

class PathMaker {
 public:
  explicit PathMaker(const Point& start, double feed_mm_s) : at_(start), feed_mm_s_(feed_mm_s) {}

  PathMaker& line_to(const Point& end) {
    PathSegment segment;
    segment.start_mm = at_;
    segment.end_mm = end;
    return append(segment);
  }
  /// In the plane of `axis`, from the present point; sweep > 0, direction by the axis.
  PathMaker& arc(const Point& centre, double sweep_rad, const Point& axis = {0, 0, 1},
                 double rise_mm = 0.0, double radius_growth_mm = 0.0) {
    PathSegment segment;
    segment.geometry = Geometry::arc;
    segment.start_mm = at_;
    segment.centre_mm = centre;
    segment.axis = axis;
    segment.radius_mm = math::geometry::distance(at_, centre);
    segment.radius_end_mm = segment.radius_mm + radius_growth_mm;
    segment.sweep_rad = sweep_rad;
    segment.rise_mm = rise_mm;
    segment.end_mm = math::geometry::point_at(segment, 1.0);
    return append(segment);
  }
  /// A circle about `centre` as CAM writes it: chords of the given length.
  PathMaker& chords(const Point& centre, double sweep_rad, double chord_mm) {
    PathMaker exact(at_, feed_mm_s_);
    exact.arc(centre, sweep_rad);
    const PathSegment& whole = exact.path_.front();
    const int count = static_cast<int>(std::ceil(whole.length_mm / chord_mm));
    for (int i = 1; i <= count; ++i) {
      line_to(math::geometry::point_at(whole, static_cast<double>(i) / count));
    }
    return *this;
  }
  PathMaker& motion(kernel::signal::Motion motion) {
    motion_ = motion;
    return *this;
  }
  PathMaker& feed(double feed_mm_s) {
    feed_mm_s_ = feed_mm_s;
    return *this;
  }
  /// Speed limits of a control with this acceleration: √(a·R) on arcs, √(a·δ·…) at corners.
  std::vector<PathSegment> limited(double acceleration_mm_s2, double corner_mm_s) {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      PathSegment& segment = path_[i];
      if (segment.geometry == Geometry::arc) {
        segment.speed_limit_mm_s =
            std::sqrt(acceleration_mm_s2 * std::min(segment.radius_mm, segment.radius_end_mm));
      }
      if (i + 1 == path_.size()) {
        segment.exit_speed_limit_mm_s = 0.0;
        continue;
      }
      const Point out = math::geometry::station_at(segment, 1.0).tangent;
      const Point in = math::geometry::station_at(path_[i + 1], 0.0).tangent;
      const bool corner = math::geometry::dot(out, in) < 0.98;
      segment.exit_speed_limit_mm_s = corner ? corner_mm_s : kernel::units::kInfinity;
    }
    return path_;
  }
  [[nodiscard]] const std::vector<PathSegment>& path() const { return path_; }
  [[nodiscard]] const Point& at() const { return at_; }

 private:
  PathMaker& append(PathSegment segment) {
    segment.length_mm = math::geometry::arc_length_mm(segment);
    segment.position_mm = path_.empty() ? 0.0 : path_.back().position_mm + path_.back().length_mm;
    segment.feed_mm_s = feed_mm_s_;
    segment.motion = motion_;
    segment.exit_speed_limit_mm_s = kernel::units::kInfinity;
    path_.push_back(segment);
    at_ = segment.end_mm;
    return *this;
  }

  std::vector<PathSegment> path_;
  Point at_;
  double feed_mm_s_;
  kernel::signal::Motion motion_ = kernel::signal::Motion::feed;
};

using kernel::units::kTurn;

/// Rounded rectangles with fillets of 2–12 mm, a spiral, and a rib of alternating arcs of 2–40 mm.
inline std::vector<PathSegment> pocket(double feed_mm_s) {
  PathMaker path({0, -30, 5}, 150.0);
  path.motion(kernel::signal::Motion::rapid)
      .line_to({0, -30, 1})
      .motion(kernel::signal::Motion::feed);
  path.feed(0.25 * feed_mm_s).line_to({0, -30, 0}).feed(feed_mm_s);
  for (const double r : {2.0, 3.0, 5.0, 8.0, 12.0}) {
    path.line_to({50 - r, -30, 0}).arc({50 - r, -30 + r, 0}, kTurn / 4);
    path.line_to({50, 30 - r, 0}).arc({50 - r, 30 - r, 0}, kTurn / 4);
    path.line_to({-50 + r, 30, 0}).arc({-50 + r, 30 - r, 0}, kTurn / 4);
    path.line_to({-50, -30 + r, 0}).arc({-50 + r, -30 + r, 0}, kTurn / 4);
    path.line_to({0, -30, 0});
  }
  path.arc({0, -10, 0}, 4 * kTurn, {0, 0, 1}, 0.0, -15.0).arc({0, -25, 0}, kTurn / 4, {0, 0, 1});
  for (const double r : {40.0, 20.0, 10.0, 6.0, 4.0, 2.0}) {
    path.arc({path.at()[0], path.at()[1] + r, 0}, kTurn / 2, {0, 0, -1});
    path.arc({path.at()[0], path.at()[1] + r, 0}, kTurn / 2, {0, 0, 1});
  }
  return path.limited(2000.0, 3.0);
}

/// Nothing of the layer is in force.
inline constexpr kernel::signal::InForce kAtPanel{};

inline std::vector<PathSegment> circle(double radius, double feed_mm_min, double turns) {
  return PathMaker({radius, 0, 0}, feed_mm_min / 60.0)
      .arc({0, 0, 0}, turns * kTurn)
      .limited(2000.0, 1.0);
}

}  // namespace steadyrest::contour::online::test
