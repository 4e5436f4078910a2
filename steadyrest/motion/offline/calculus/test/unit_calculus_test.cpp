// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/motion/offline/calculus/unit_calculus.hpp>
#include <steadyrest/motion/offline/calculus/unit_curves.hpp>
#include <steadyrest/motion/offline/scene/scene.hpp>

// Every number is printed in the source's text, checked to the printed digits.
namespace steadyrest::motion::offline {
namespace {

using kernel::units::mm_min_from_mm_s;
using kernel::units::mm_s_from_mm_min;
using kernel::units::rev_s_from_rpm;
using kernel::units::rpm_from_rev_s;
using kernel::units::um_from_mm;

constexpr Sampling kPaper{0.001, 1000.0};
constexpr Sampling kFast{0.001, 2500.0};

double of_overload(const Sampling& sampling, double overload) {
  return counts_per_tick2(sampling, acceleration_of_overload_mm_s2(overload).value()).value();
}

// The paper's own numbers: 20 000 mm/min at 1 kHz and 1 µm are 333.3 counts/tick.
TEST(UnitCalculus, Equation3GivesTheTickVelocitiesOfTheText) {
  EXPECT_NEAR(counts_per_tick(kPaper, mm_s_from_mm_min(20000.0)).value(), 333.3, 0.05);
  EXPECT_NEAR(counts_per_tick(kPaper, mm_s_from_mm_min(9000.0)).value(), 150.0, 1e-9);
}

// 2 g: 19.6 counts/tick² at 1 kHz, 3.14 at 2.5 kHz.
TEST(UnitCalculus, Equation4GivesTheTickAccelerationsOfTheText) {
  EXPECT_NEAR(of_overload(kPaper, 2.0), 19.6, 0.05);
  EXPECT_NEAR(of_overload(kFast, 2.0), 3.14, 0.005);
  EXPECT_NEAR(of_overload(kPaper, 0.21), 2.1, 0.05);
  EXPECT_NEAR(of_overload(kPaper, 0.09), 0.9, 0.05);
}

TEST(UnitCalculus, DifferencesOfCountsTellOneToThreeHundredSpeedsApart) {
  EXPECT_EQ(speed_gradations(kPaper, mm_s_from_mm_min(6000.0)).value(), 100.0);
  EXPECT_EQ(speed_gradations(kPaper, mm_s_from_mm_min(18000.0)).value(), 300.0);
  EXPECT_EQ(speed_gradations(kPaper, mm_s_from_mm_min(20000.0)).value(), 333.0);
  // 10 000 and 30 000 gradations of the drive: 100 to 300 times finer than 100 speeds.
  EXPECT_NEAR(required_resolution_mm(kPaper, mm_s_from_mm_min(6000.0), 1e4).value(), 1e-5, 1e-12);
  EXPECT_NEAR(required_resolution_mm(kPaper, mm_s_from_mm_min(6000.0), 3e4).value(), 3e-6, 0.5e-6);
}

// The paper's point: at −0.006 counts/tick² the second difference shows −1, 0 and 1, never the
// braking.
TEST(UnitCalculus, DifferencesOfAFlywheelShowMinusOneNoughtAndOne) {
  // Fig. 2: −0.006 counts/tick², of which eq. 2 makes −1, 0 and +1.
  const Record wheel = record(flywheel(6.0, -0.006), Recording{});
  std::vector<std::int64_t> counts;
  for (const online::Tick& tick : wheel.ticks) {
    counts.push_back(tick.count);
  }
  const auto accelerations = tick_accelerations(counts);
  ASSERT_EQ(accelerations.size(), counts.size() - 2);
  EXPECT_THAT(accelerations, testing::Each(testing::AnyOf(-1, 0, 1)));
  EXPECT_THAT(accelerations, testing::IsSupersetOf({-1, 0, 1}));
  EXPECT_EQ(tick_velocities(counts).front(), 6);
}

TEST(UnitCalculus, DifferencesOfTooFewCountsAreNone) {
  const std::array<std::int64_t, 1> one{5};
  EXPECT_TRUE(tick_velocities({}).empty());
  EXPECT_TRUE(tick_accelerations({}).empty());
  EXPECT_TRUE(tick_velocities(one).empty());
  EXPECT_TRUE(tick_accelerations(one).empty());
}

// 300 kHz, 7500 mm/min and a lead of 10 mm: 24 000 lines, 10⁻⁴ mm.
TEST(UnitCalculus, Equations6And8GiveTheEncoderOfTheLathe) {
  const double lines = lines_for_feed(300e3, 10.0, mm_s_from_mm_min(7500.0)).value();
  EXPECT_NEAR(lines, 24000.0, 1e-6);
  EXPECT_NEAR(count_of_lines_mm(10.0, lines).value(), 1e-4, 0.05e-4);
  const double fast = lines_for_feed(300e3, 10.0, mm_s_from_mm_min(60000.0)).value();
  EXPECT_NEAR(fast, 3000.0, 1e-6);
  EXPECT_NEAR(um_from_mm(count_of_lines_mm(10.0, fast).value()), 0.83, 0.005);
}

// 300 kHz at 2000 … 10 000 rpm: 9000 … 1800 lines.
TEST(UnitCalculus, Equation7GivesTheLinesOfTheSpindle) {
  EXPECT_NEAR(lines_for_speed(300e3, rev_s_from_rpm(2000.0)).value(), 9000.0, 1e-6);
  EXPECT_NEAR(lines_for_speed(300e3, rev_s_from_rpm(10000.0)).value(), 1800.0, 1e-6);
}

TEST(UnitCalculus, Equation5FindsEveryEncoderOfTable1TooFastAtItsLargestSpeed) {
  // A110-F: 180 000 lines at 5000 rpm would be 15 MHz, permitted are 125 kHz.
  EXPECT_NEAR(signal_frequency_hz(180000.0, rev_s_from_rpm(5000.0)).value(), 15e6, 1e-3);
  // ERN420: 5000 lines at 12 000 rpm would be 1 MHz, permitted are 300 kHz.
  EXPECT_NEAR(signal_frequency_hz(5000.0, rev_s_from_rpm(12000.0)).value(), 1e6, 1e-3);
}

TEST(UnitCalculus, GoesBackTheWayItCame) {
  EXPECT_NEAR(mm_min_from_mm_s(speed_mm_s(kPaper, 150.0).value()), 9000.0, 1e-9);
  EXPECT_NEAR(overload_g(acceleration_mm_s2(kPaper, 2.1).value()).value(), 0.21, 0.005);
  EXPECT_NEAR(overload_g(acceleration_mm_s2(kFast, 3.14).value()).value(), 2.0, 0.005);
  EXPECT_NEAR(mm_min_from_mm_s(feed_for_lines_mm_s(300e3, 10.0, 24000.0).value()), 7500.0, 1e-9);
  EXPECT_NEAR(rpm_from_rev_s(speed_for_lines_rev_s(300e3, 1800.0).value()), 10000.0, 1e-9);
  EXPECT_NEAR(lines_of_count(10.0, 0.001).value(), 2500.0, 1e-9);  // the lathe's BE178 Z2500
}

TEST(UnitCalculus, RefusesWhatIsNotFiniteAndPositive) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, std::nan(""), kInfinity, -kInfinity}) {
    EXPECT_FALSE(counts_per_tick(kPaper, bad)) << bad;
    EXPECT_FALSE(counts_per_tick({bad, 1000.0}, 1.0)) << bad;
    EXPECT_FALSE(counts_per_tick({0.001, bad}, 1.0)) << bad;
    EXPECT_FALSE(speed_mm_s(kPaper, bad)) << bad;
    EXPECT_FALSE(counts_per_tick2(kPaper, bad)) << bad;
    EXPECT_FALSE(acceleration_mm_s2(kPaper, bad)) << bad;
    EXPECT_FALSE(acceleration_of_overload_mm_s2(bad)) << bad;
    EXPECT_FALSE(overload_g(bad)) << bad;
    EXPECT_FALSE(speed_gradations(kPaper, bad)) << bad;
    EXPECT_FALSE(required_resolution_mm(kPaper, 1.0, bad)) << bad;
    EXPECT_FALSE(signal_frequency_hz(bad, 1.0)) << bad;
    EXPECT_FALSE(lines_for_feed(1.0, bad, 1.0)) << bad;
    EXPECT_FALSE(feed_for_lines_mm_s(1.0, 1.0, bad)) << bad;
    EXPECT_FALSE(lines_for_speed(bad, 1.0)) << bad;
    EXPECT_FALSE(speed_for_lines_rev_s(1.0, bad)) << bad;
    EXPECT_FALSE(count_of_lines_mm(bad, 1.0)) << bad;
    EXPECT_FALSE(lines_of_count(1.0, bad)) << bad;
  }
  EXPECT_EQ(text(counts_per_tick(kPaper, -3.0).error()),
            "feed = -3; allowed: a finite number above 0; give a value above 0");
}

TEST(UnitCalculus, RefusesAResultThatANumberCannotHold) {
  EXPECT_FALSE(counts_per_tick({1e-300, 1e-300}, 1.0));
  EXPECT_FALSE(lines_for_speed(1e-300, 1e300));
}

TEST(UnitCurves, Figure3IsStraightThroughTheNumbersOfTheText) {
  const std::array cycles{1000.0, 2500.0};
  const auto speeds = figure_3a(0.001, cycles).value();
  ASSERT_EQ(speeds.size(), 2U);
  EXPECT_EQ(speeds[0].name, "1000 Hz");
  EXPECT_EQ(speeds[0].x.back(), 20000.0);
  EXPECT_NEAR(speeds[0].y.back(), 333.3, 0.05);
  EXPECT_NEAR(speeds[1].y.back(), 133.3, 0.05);
  EXPECT_GT(speeds[0].x.front(), 0.0);
  const auto overloads = figure_3b(0.001, cycles).value();
  EXPECT_NEAR(overloads[0].y.back(), 19.6, 0.05);
  EXPECT_NEAR(overloads[1].y.back(), 3.14, 0.005);
  EXPECT_NEAR(overloads[0].y[0] * 100.0, overloads[0].y.back(), 1e-9);
}

TEST(UnitCurves, Figure5FallsInLinesAndRisesInCount) {
  const auto curves = figure_5(300e3, 10.0).value();
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[0].x.size(), 119U);
  EXPECT_EQ(curves[0].x[13], 7500.0);
  EXPECT_NEAR(curves[0].y[13], 24000.0, 1e-6);
  EXPECT_NEAR(curves[1].y[13], 0.1, 0.005);
  EXPECT_NEAR(curves[0].y.back(), 3000.0, 1e-6);
  EXPECT_NEAR(curves[1].y.back(), 0.83, 0.005);
}

TEST(UnitCurves, RefusesWhatIsNoCurve) {
  const std::array cycles{1000.0};
  const std::array none{0.0};
  EXPECT_FALSE(figure_3a(0.001, cycles, 20000.0, 1));
  EXPECT_FALSE(figure_3a(0.001, cycles, -1.0));
  EXPECT_FALSE(figure_3a(0.001, none));
  EXPECT_FALSE(figure_3b(std::nan(""), cycles));
  EXPECT_FALSE(figure_5(300e3, 10.0, 5.0, 1.0));
  EXPECT_FALSE(figure_5(300e3, -10.0));
}

}  // namespace
}  // namespace steadyrest::motion::offline
