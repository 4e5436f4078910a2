// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/growth_course.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using online::Law;

DelayCycle cycle_at(double depth_mm, const Modulation& modulation = {}) {
  DelayCycle out =
      DelayCycle::make(benchmark_cut(1.0, Direction::up), {.speed_rev_s = 5000.0 / 60.0,
                                                           .modulation = modulation,
                                                           .course = {},
                                                           .most_depth_mm = depth_mm})
          .value();
  out.set_depth(depth_mm);
  return out;
}

const Modulation kTriangle{Law::triangle, 0.2, 0.1, 1};

const std::vector<GrowthCourse>& under_the_triangle() {
  static const std::vector<GrowthCourse> courses = [] {
    DelayCycle cycle = cycle_at(1.0, kTriangle);
    return growth_courses(cycle);
  }();
  return courses;
}

TEST(GrowthCourse, WithoutACutIsFreeDecay) {
  DelayCycle cycle = cycle_at(1e-9);
  const auto courses = growth_courses(cycle);
  ASSERT_EQ(courses.size(), 1U);
  const auto& log_growth = courses[0].log_growth;
  ASSERT_GE(log_growth.size(), 10U);
  EXPECT_EQ(log_growth[0], 0.0);
  // q = e^{−ζωt}·(cos ω_d·t + …): the size swings with the phase, so take the mean over many
  // passes. ζ = 0.011, 922 Hz, a tooth each 6 ms.
  const double decay = -0.011 * 2.0 * std::numbers::pi * 922.0 * 0.006;
  const auto last = log_growth.size() - 1;
  EXPECT_NEAR((log_growth[last] - log_growth[1]) / static_cast<double>(last - 1), decay, 0.05);
}

// From any start, only the dominant multiplier is left after many periods.
TEST(GrowthCourse, InTheLongRunFallsByTheRadiusInEachPeriod) {
  DelayCycle cycle = cycle_at(1.0, kTriangle);
  const double log_radius = stability(cycle, {}).log_radius;
  ASSERT_LT(log_radius, -5.0);
  for (const GrowthCourse& course : under_the_triangle()) {
    const std::size_t period = cycle.passes();
    ASSERT_GT(course.log_growth.size(), period + 4);
    const std::size_t last = course.log_growth.size() - 1;
    EXPECT_NEAR(course.log_growth[last] - course.log_growth[last - period], log_radius, 0.15)
        << course.start_pass;
  }
}

TEST(GrowthCourse, TheWorstHasTheGreatestPeak) {
  const auto& courses = under_the_triangle();
  EXPECT_EQ(courses.size(), 16U);
  const GrowthCourse& most = worst(courses);
  // Pinned. The reference has ×16 for this law; how large it is depends on the norm.
  EXPECT_NEAR(most.peak(), 13.3, 0.05);
  for (const GrowthCourse& course : courses) {
    EXPECT_LE(course.log_peak(), most.log_peak());
    EXPECT_GE(course.log_peak(), 0.0);
  }
}

TEST(GrowthCourse, OfAnUnstableCutGrowsByTheRadiusWithEachPass) {
  DelayCycle cycle = cycle_at(1.0);
  const auto log_growth = growth_courses(cycle)[0].log_growth;
  ASSERT_EQ(log_growth.size(), 21U);
  // From the tenth pass on the transient is gone; 1.40647353 is the benchmark's multiplier.
  EXPECT_NEAR((log_growth[20] - log_growth[10]) / 10.0, std::log(1.40647353), 0.02);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
