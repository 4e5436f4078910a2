// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/nominal_error.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

/// Steady state of equal first-order servos on a circle about the origin, commanded at angle 0. The
/// actual point is at R/√(1 + q²), behind by the angle atan q.
Point following_error(double r, double speed, double gain) {
  const double q = speed / (r * gain);
  const double inner = r / std::sqrt(1.0 + q * q);
  return {r - inner * std::cos(std::atan(q)), inner * std::sin(std::atan(q)), 0.0};
}

TEST(NominalError, ArcIdentityGivesTheTableOfThePaper) {
  struct PaperRow {
    double feed_mm_min, gain_1_s, error_mm, nominal_mm;
  };
  for (const PaperRow& row :
       {PaperRow{4000, 1000.0 / 60, 0.7152, 3.7139}, PaperRow{4000, 2000.0 / 60, 0.1942, 1.9612},
        PaperRow{4000, 50, 0.0877, 1.3216}, PaperRow{4000, 5000.0 / 60, 0.0319, 0.7975},
        PaperRow{2000, 50, 0.0222, 0.6652}}) {
    const Point e = following_error(10.0, row.feed_mm_min / 60.0, row.gain_1_s);
    EXPECT_NEAR(geometry::norm(e), row.nominal_mm, 6e-5);
    EXPECT_NEAR(arc_identity_mm(geometry::norm(e), 10.0), row.error_mm, 6e-5);
    EXPECT_NEAR(arc_identity_mm(geometry::norm(e), -10.0), -row.error_mm, 6e-5);
  }
}

RC_GTEST_PROP(NominalError, ArcIdentityIsExactForEqualGains, ()) {
  const double r = *geometry::test::number(1.0, 100.0);
  const double v = *geometry::test::number(1.0, 100.0);
  const double k = *geometry::test::number(15.0, 100.0);
  const double q = v / (r * k);
  const double truth = r - r / std::sqrt(1.0 + q * q);
  RC_ASSERT(std::abs(arc_identity_mm(geometry::norm(following_error(r, v, k)), r) - truth) <=
            1e-11);
}

// Backwards, the tangent through the command leaves the circle by e²/2R, as much as ε itself:
// without the curvature the estimate is 2ε.
TEST(NominalError, TangentialEstimateIsTwiceTooLargeOnAnArcAndItsCorrectionIsNot) {
  const Point e = following_error(10.0, 4000.0 / 60.0, 50.0);
  const Point tangent{0, 1, 0};
  EXPECT_NEAR(geometry::norm(tangential_error_mm(e, tangent)), 0.1747, 1e-4);
  const Point offset = corrected_offset_mm(e, tangent, {-0.1, 0, 0});
  EXPECT_NEAR(-offset[0], 0.0877, 0.02 * 0.0877);  // the next term is of order (Ed/R)²
}

TEST(NominalError, NormTakesTheFirstThreeAxesOnly) {
  kernel::signal::Frame frame;
  frame.axis_count = 4;
  frame.axis[0].following_error_mm = 3.0;
  frame.axis[1].following_error_mm = -4.0;
  frame.axis[2].following_error_mm = 12.0;
  frame.axis[3].following_error_mm = 1000.0;
  EXPECT_DOUBLE_EQ(nominal_error_mm(frame), 13.0);
}

TEST(NominalError, BeyondTheRadiusTheIdentityIsHeldAtTheRadius) {
  EXPECT_DOUBLE_EQ(arc_identity_mm(11.0, 10.0), 10.0);
  EXPECT_DOUBLE_EQ(arc_identity_mm(1.0, 0.0), 0.0);
}

// Three points on a span of 1 mm: κ to 2 %, the tangent to second order in span/R.
RC_GTEST_PROP(CommandedCurve, FindsTheCircleThatTheCommandRunsOn, ()) {
  const double r = *geometry::test::number(2.0, 200.0);
  const double step = *geometry::test::number(0.005, 0.4);
  CommandedCurve curve(1.0);
  CommandedCurve::Output output;
  double angle = 0.0;
  for (double s = 0.0; s < 4.0; s += step) {
    angle = s / r;
    output = curve.update({r * std::cos(angle), r * std::sin(angle), 0.0});
  }
  RC_ASSERT(output.valid);
  RC_ASSERT(std::abs(geometry::norm(output.curvature_1_mm) - 1.0 / r) <= 0.02 / r);
  RC_ASSERT(geometry::distance(output.tangent, {-std::sin(angle), std::cos(angle), 0.0}) <=
            0.05 / (r * r) + 1e-9);
}

}  // namespace
}  // namespace steadyrest::contour::online
