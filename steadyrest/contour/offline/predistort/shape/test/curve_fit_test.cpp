// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/curve_fit.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using kernel::signal::Point;

/// A curve sampled at equal parameters, with its derivative as direction.
std::vector<CurvePoint> sampled(const std::function<Point(double)>& curve, double from, double to,
                                int count) {
  std::vector<CurvePoint> out;
  for (int i = 0; i <= count; ++i) {
    const double t = from + (to - from) * i / count;
    const double h = 1e-6 * (to - from);
    out.push_back({.point_mm = curve(t),
                   .direction = geometry::unit(geometry::subtract(curve(t + h), curve(t - h))),
                   .progress_mm = 10.0 * t});
  }
  return out;
}

double largest_miss(const std::vector<CurvePoint>& points, const std::vector<Piece>& pieces) {
  double largest = 0.0;
  for (const CurvePoint& point : points) {
    double nearest = 1e9;
    for (const Piece& piece : pieces) {
      nearest = std::min(nearest, geometry::foot_point(piece.segment, point.point_mm).distance_mm);
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

/// Largest bend between two pieces, rad.
double largest_bend(const std::vector<Piece>& pieces) {
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    largest = std::max(
        largest, geometry::distance(geometry::station_at(pieces[i].segment, 1.0).tangent,
                                    geometry::station_at(pieces[i + 1].segment, 0.0).tangent));
  }
  return largest;
}

Point on_circle(double angle) {
  return {3.0 + 10.0 * std::cos(angle), 1.0 + 10.0 * std::sin(angle), 0.2 * angle};
}

TEST(CurveFit, FindsAStraightLine) {
  const auto points = sampled([](double t) { return Point{t, 2.0 * t, 1.0}; }, 0.0, 3.0, 30);
  const auto pieces = fit_curve(points, {});
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].segment.geometry, Geometry::line);
  EXPECT_DOUBLE_EQ(pieces[0].progress_end_mm, 30.0);
}

TEST(CurveFit, FindsAHelixAsOneArc) {
  const auto points = sampled(on_circle, 0.4, 2.4, 40);
  const auto pieces = fit_curve(points, {.tolerance_mm = 1e-4});
  ASSERT_EQ(pieces.size(), 1U);
  const auto& arc = pieces[0].segment;
  EXPECT_EQ(arc.geometry, Geometry::arc);
  EXPECT_NEAR(arc.radius_mm, 10.0, 1e-6);
  EXPECT_NEAR(arc.sweep_rad, 2.0, 1e-6);
  EXPECT_NEAR(arc.axis[2], 1.0, 1e-12);
  EXPECT_NEAR(arc.rise_mm, 0.4, 1e-9);
}

TEST(CurveFit, DividesACircleThatComesBack) {
  const auto points = sampled(on_circle, 0.0, 2.0 * std::numbers::pi, 100);
  const auto pieces = fit_curve(points, {});
  ASSERT_GE(pieces.size(), 3U);
  double swept = 0.0;
  for (const Piece& piece : pieces) {
    swept += piece.segment.sweep_rad;
  }
  EXPECT_NEAR(swept, 2.0 * std::numbers::pi, 1e-4);
}

// Fewer pieces for a wider tolerance, and never a bend.
TEST(CurveFit, KeepsItsToleranceWithoutBends) {
  const auto wave = [](double t) { return Point{t, std::sin(t) + 0.2 * std::cos(3.0 * t), 0.0}; };
  const auto points = sampled(wave, 0.0, 10.0, 400);
  std::size_t before = 1000;
  for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
    const auto pieces = fit_curve(points, {.tolerance_mm = tolerance});
    EXPECT_LE(largest_miss(points, pieces), tolerance);
    EXPECT_LT(largest_bend(pieces), 5e-3);
    EXPECT_LT(pieces.size(), before);
    before = pieces.size();
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      EXPECT_LT(geometry::distance(pieces[i].segment.end_mm, pieces[i + 1].segment.start_mm), 1e-9);
      EXPECT_DOUBLE_EQ(pieces[i].progress_end_mm, pieces[i + 1].progress_start_mm);
    }
  }
}

TEST(CurveFit, WorksInEveryPlane) {
  using nc::interpret::Plane;
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz}) {
    const auto axes = nc::interpret::axes_of(plane);
    const auto arc = [axes](double t) {
      Point p{};
      p[axes.first] = 5.0 * std::cos(t);
      p[axes.second] = 5.0 * std::sin(t);
      return p;
    };
    const auto pieces = fit_curve(sampled(arc, 0.0, 1.5, 30), {.plane = plane});
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_NEAR(pieces[0].segment.axis[axes.normal], 1.0, 1e-12);
    EXPECT_NEAR(pieces[0].segment.radius_mm, 5.0, 1e-6);
  }
}

TEST(CurveFit, TakesChordsAsTheyAre) {
  const auto points = sampled(on_circle, 0.0, 1.0, 10);
  const auto pieces = fit_curve(points, {.one_line = true});
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].segment.geometry, Geometry::line);
}

}  // namespace
}  // namespace steadyrest::contour::offline
