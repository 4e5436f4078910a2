// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/estimator/m_over_t.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::MOverT;

Edge edge_at(double t_s, std::int64_t line, std::int8_t direction) {
  return {t_s, static_cast<double>(line) * kCount, line, direction, 0};
}
Tick tick_at(double t_s, std::int64_t count) {
  const double low = static_cast<double>(count) * kCount;
  return {t_s, count, low, low + kCount};
}

TEST(MOverT, IsExactAtConstantSpeedWithExactStamps) {
  Recording how;
  how.clock_s = 0.0;
  const Record record = offline::record(constant_speed(3.7, 1.0), how);
  const Score s = scored<MOverT>({}, record, 0.0, 0.01);
  EXPECT_LT(s.velocity_max_mm_s, 1e-7);  // the scene finds its edges within 1e-13 s
}

TEST(MOverT, TheStampErrorIsItsShareOfTheTimeBetweenTheEdges) {
  Recording how;
  how.clock_s = 1e-6;
  const Record record = offline::record(constant_speed(3.7819, 1.0), how);
  const Score s = scored<MOverT>({}, record, 0.0, 0.01);
  EXPECT_LT(s.velocity_max_mm_s, 3.7819 * 1e-6 / (0.001 - 0.000265));
  EXPECT_GT(s.velocity_max_mm_s, 3.7819 * 0.5e-6 / 0.001);
}

TEST(MOverT, ComesLateByHalfATickAndTheMeanAgeOfItsEdges) {
  const Record record = offline::record(ramp(5.0, 20.0, 1.0), {});
  MOverT estimator = MOverT::make({}).value();
  const double lag_s = -mean_velocity_error(run(estimator, record), record, 0.01) / 20.0;
  // Between the middles of two spans that end at the last edges, q/(2v) old in the mean; v is 5…25.
  const double mean_age_s = 0.5 * kCount * std::log(5.0) / 20.0;
  EXPECT_NEAR(lag_s, 0.0005 + mean_age_s, 0.00002);
}

TEST(MOverT, GivesTheTableOfTheReference) {
  // Row "M/T". S-curve ±15 %. The sine's 0.197 contains one false 7.4 mm/s of an edge pair on one
  // line among some 2000 ticks, which the same-line rule removes: √(0.197² − 7.4²/2000) = 0.107.
  EXPECT_NEAR(scored<MOverT>({}, sine_ideal()).velocity_rms_mm_s, 0.107, 0.016);
  EXPECT_NEAR(scored<MOverT>({}, sine_line_errors()).velocity_rms_mm_s, 0.116, 0.016);
  EXPECT_NEAR(scored<MOverT>({}, s_curve_ideal()).velocity_rms_mm_s, 0.060, 0.009);
  EXPECT_NEAR(scored<MOverT>({}, s_curve_line_errors()).velocity_rms_mm_s, 0.069, 0.0104);
}

TEST(MOverT, WithoutEdgesTheSpeedFallsAsOneCountOverTheAgeAndEndsAtTheTimeout) {
  MOverT estimator = MOverT::make({}).value();
  estimator.edge(edge_at(0.0, 1, 1));
  estimator.tick(tick_at(0.0005, 1));
  estimator.edge(edge_at(0.0010, 2, 1));
  EXPECT_NEAR(estimator.tick(tick_at(0.0015, 2)).velocity_mm_s, 1.0, 1e-12);
  for (int k = 2; k < 700; ++k) {
    const double t = 0.0005 + k * 0.001;
    const double age = t - 0.0010;
    const double v = estimator.tick(tick_at(t, 2)).velocity_mm_s;
    EXPECT_NEAR(v, age < 0.5 ? std::min(1.0, kCount / age) : 0.0, 1e-12) << k;
  }
}

TEST(MOverT, ALineThatIsPassedBothWaysGivesNoSpeed) {
  MOverT estimator = MOverT::make({}).value();
  std::int64_t count = 4;
  for (int k = 0; k < 50; ++k) {  // 100 ns on either side of the tick: 10 000 mm/s by counts
    const double t = k * 0.001;
    const bool up = k % 2 == 0;
    estimator.edge(edge_at(up ? t : t - 0.001 + 2e-7, 5, up ? 1 : -1));
    count = up ? 5 : 4;
    const Estimate e = estimator.tick(tick_at(up ? t + 1e-7 : t, count));
    EXPECT_EQ(e.velocity_mm_s, 0.0) << k;
  }
}

TEST(MOverT, WithoutTheRuleSuchALineGivesNonsense) {
  MOverT estimator = MOverT::make(MOverT::linuxcnc_encoder(kCount)).value();
  for (int i = 0; i < 3; ++i) {
    estimator.edge(edge_at(0.0010 + 0.001 * i, 1 + i, 1));
    estimator.tick(tick_at(0.0011 + 0.001 * i, 1 + i));
  }
  estimator.edge(edge_at(0.0030001, 3, -1));
  EXPECT_NEAR(estimator.tick(tick_at(0.0041, 2)).velocity_mm_s, -10000.0, 1.0);
}

TEST(MOverT, StartsAfterAsManyEdgesAsItsModel) {
  MOverT hostmot2 = MOverT::make({}).value();
  MOverT software = MOverT::make(MOverT::linuxcnc_encoder(kCount)).value();
  for (int k = 1; k <= 4; ++k) {
    const double t = 0.001 * k;
    hostmot2.edge(edge_at(t, k, 1));
    software.edge(edge_at(t, k, 1));
    EXPECT_NEAR(hostmot2.tick(tick_at(t, k)).velocity_mm_s, k > 1 ? 1.0 : 0.0, 1e-9) << k;
    EXPECT_NEAR(software.tick(tick_at(t, k)).velocity_mm_s, k > 2 ? 1.0 : 0.0, 1e-9) << k;
  }
}

TEST(MOverT, DoesNotSeeTheJitterOfTheTick) {
  Recording how;
  how.tick_jitter_s = 5e-5;
  const Record record = offline::record(constant_speed(9.3, 1.0), how);
  EXPECT_LT(scored<MOverT>({}, record, 0.0, 0.01).velocity_rms_mm_s, 9.3 * 1e-7 / 8e-4);
}

TEST(MOverT, RefusesWhatCannotWork) {
  EXPECT_FALSE(MOverT::make({.count_mm = 0.0}).has_value());
  EXPECT_FALSE(MOverT::make({.timeout_s = 0.0}).has_value());
  EXPECT_FALSE(MOverT::make({.edges_to_start = 0}).has_value());
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
