// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/identify.hpp>
#include <steadyrest/thermal/offline/log/level_table.hpp>
#include <steadyrest/thermal/offline/plan/replay.hpp>
#include <steadyrest/thermal/offline/test/synthetic_log.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using test::KnownMachine;
using test::log_of;
using testing::HasSubstr;

constexpr double kNoise_um = 0.3;

/// A resonance at 3000 rpm: no polynomial of n and n² matches it.
double humped_um(double rpm) {
  return 5.0 * rpm / 1000.0 + 25.0 * std::exp(-std::pow((rpm - 3000.0) / 450.0, 2.0));
}

KnownMachine humped_machine(unsigned seed = 1) {
  return {.mode = {{40.0, 0.0, humped_um}}, .noise_um = kNoise_um, .seed = seed};
}

/// Each speed twice, so that a left-out one occurs elsewhere in the log.
const std::vector<std::pair<int, double>> kTest = {
    {180, 3000}, {120, 0}, {180, 2000}, {120, 0}, {180, 4000}, {120, 0}, {180, 2600}, {120, 0},
    {180, 3000}, {120, 0}, {180, 4000}, {120, 0}, {180, 2000}, {120, 0}, {180, 2600}, {120, 0}};
/// Another day: the same speeds, other times.
const std::vector<std::pair<int, double>> kWork = {{40, 2600}, {70, 3000}, {20, 0},
                                                   {50, 4000}, {90, 2000}, {60, 3000}};

AxisFit fitted(const Log& log, bool table) {
  FitRequest request;
  request.table = table;
  auto fit = identify(log, 0, "Z", request);
  EXPECT_TRUE(fit.has_value()) << fit.error().what;
  return fit ? *fit : AxisFit{};
}

double forecast_rms_um(const AxisFit& fit, const Log& log) {
  ThermalAxis cold = fit.axis;
  cold.drift_mm = 0.0;
  ReplayRequest request;
  request.channel = 0;
  request.state_s = -1e9;
  request.from_s = 0.0;
  const auto points = replay(cold, log, request);
  EXPECT_TRUE(points.has_value()) << points.error().what;
  return points ? 1e3 * score(*points, 0.0).rms_mm : 1e9;
}

double level_um(const ThermalAxis& axis, double rpm) {
  const auto model = online::ThermalModel::make(axis);
  EXPECT_TRUE(model.has_value());
  online::Drive drive;
  drive.speed_rev_s = rpm / 60.0;
  double sum = 0.0;
  for (std::size_t m = 0; m < axis.mode.size(); ++m) {
    sum += 1e3 * model->level_mm(m, drive);
  }
  return sum;
}

TEST(LevelTable, SharesAreStraightAndSumToOneFromTheSlowestSpeedOn) {
  const std::vector<double> table = {20.0, 40.0, 50.0};
  const auto shares = [&](double speed) {
    return std::vector{table_share(table, 0, speed), table_share(table, 1, speed),
                       table_share(table, 2, speed)};
  };
  EXPECT_EQ(shares(0.0), (std::vector{0.0, 0.0, 0.0}));
  // A quarter of the way from rest to the slowest speed of the table.
  EXPECT_EQ(shares(5.0), (std::vector{0.25, 0.0, 0.0}));
  EXPECT_EQ(shares(20.0), (std::vector{1.0, 0.0, 0.0}));
  EXPECT_EQ(shares(25.0), (std::vector{0.75, 0.25, 0.0}));
  EXPECT_EQ(shares(48.0), (std::vector{0.0, 0.2, 0.8}));
  EXPECT_EQ(shares(80.0), (std::vector{0.0, 0.0, 1.0}));
}

TEST(LevelTable, TakesTheSpeedsThatAreHeld) {
  const Log log = log_of({}, {{60, 0}, {10, 1000}, {60, 3000}, {5, 1500}, {15, 1020}, {30, 2000}});
  const auto speeds = held_speeds_rev_s(log, -1e300, 1e300);
  ASSERT_EQ(speeds.size(), 3U) << "1500 rpm for five minutes tell nothing";
  // (10·1000 + 15·1020)/25.
  EXPECT_NEAR(60.0 * speeds[0], 1012.0, 0.5) << "one speed, by time";
  EXPECT_NEAR(60.0 * speeds[1], 2000.0, 1e-6);
  EXPECT_NEAR(60.0 * speeds[2], 3000.0, 1e-6);
  EXPECT_EQ(held_speeds_rev_s(log, 70.0 * 60.0, 130.0 * 60.0).size(), 1U);
}

// On the fitted day and on another one: a table that only remembered its own day would fail the
// second.
TEST(LevelTable, FitsToTheNoiseWhatAPolynomialDoesNot) {
  const Log log = log_of(humped_machine(), kTest);
  const AxisFit table = fitted(log, true);
  const AxisFit polynomial = fitted(log, false);
  EXPECT_NEAR(table.rms_um, kNoise_um, 0.02);
  EXPECT_GT(polynomial.rms_um, 5.0 * kNoise_um);
  ASSERT_EQ(table.axis.mode.size(), 1U);
  EXPECT_NEAR(table.axis.mode[0].tau_s / 60.0, 40.0, 1.0);
  for (const double rpm : {2000.0, 2600.0, 3000.0, 4000.0}) {
    EXPECT_NEAR(level_um(table.axis, rpm), humped_um(rpm), 0.3) << rpm;
  }
  EXPECT_LT(table.left_out_um, 1.2 * kNoise_um);

  const Log work = log_of(humped_machine(2), kWork);
  EXPECT_LT(forecast_rms_um(table, work), 1.2 * kNoise_um);
  EXPECT_GT(forecast_rms_um(polynomial, work), 5.0 * kNoise_um);
}

TEST(LevelTable, IsStraightFromNoughtAtRestAndHoldsItsLastLevel) {
  const AxisFit fit = fitted(log_of(humped_machine(), kTest), true);
  const auto& mode = fit.axis.mode.front();
  ASSERT_EQ(mode.speed_rev_s.size(), 5U);
  EXPECT_TRUE(mode.polynomial_mm.empty());
  EXPECT_EQ(mode.speed_rev_s.front(), 0.0);
  EXPECT_EQ(mode.level_mm.front(), 0.0);
  EXPECT_EQ(level_um(fit.axis, 0.0), 0.0);
  EXPECT_NEAR(level_um(fit.axis, 1000.0), 0.5 * level_um(fit.axis, 2000.0), 1e-9);
  EXPECT_NEAR(level_um(fit.axis, 2300.0),
              0.5 * (level_um(fit.axis, 2000.0) + level_um(fit.axis, 2600.0)), 1e-9);
  EXPECT_EQ(level_um(fit.axis, 4700.0), level_um(fit.axis, 4000.0));
  // The covariance: none for the level at rest, some for the others. The lower triangle of five
  // levels, the first of them the 0 at rest.
  ASSERT_EQ(fit.axis.covariance.size(), 15U);
  EXPECT_EQ(fit.axis.covariance[0], 0.0);
  EXPECT_GT(fit.axis.covariance[2], 0.0);
  EXPECT_LT(std::sqrt(fit.axis.covariance[2]), 1.0);
}

TEST(LevelTable, ASpeedThatWasLeftOutLiesBetweenItsNeighbours) {
  // Each speed once, and rests that forget it: only the left-out hours determine its level.
  KnownMachine straight = humped_machine();
  straight.mode = {{40.0, 8.0}};
  const AxisFit fit = fitted(log_of(straight, {{180, 3000},
                                               {400, 0},
                                               {180, 2000},
                                               {400, 0},
                                               {180, 3600},
                                               {400, 0},
                                               {180, 2600},
                                               {400, 0}}),
                             true);
  EXPECT_NEAR(fit.rms_um, kNoise_um, 0.02);
  // The fastest has but one neighbour and is forecast as that, 4.8 µm short of it, in one block of
  // four: √(∫(4.8(1 − e^(−t/40)))² dt over 180 min, and what is left of it in the rest, / 4·580
  // min).
  EXPECT_NEAR(fit.left_out_um, 1.22, 0.12)
      << "the others lie between theirs, and that is not hidden";
}

TEST(LevelTable, OfALongerTestIsRenewedByAnHour) {
  const AxisFit longer = fitted(log_of(humped_machine(), kTest), true);
  KnownMachine today = humped_machine(3);
  today.mode[0].level_um = [](double rpm) { return 1.1 * humped_um(rpm); };
  const Log morning = log_of(today, {{60, 3000}, {20, 0}, {40, 2600}});
  FitRequest request;
  request.known = &longer.axis;
  const auto fit = identify(morning, 0, "Z", request);
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_EQ(fit->axis.mode.front().speed_rev_s, longer.axis.mode.front().speed_rev_s);
  // An hour at one speed renews that speed's level; the prior ties the others to the longer test.
  EXPECT_NEAR(level_um(fit->axis, 3000.0), 1.1 * humped_um(3000.0), 1.0);
  EXPECT_NEAR(level_um(fit->axis, 4000.0), humped_um(4000.0), 0.5) << "not run today";
}

TEST(LevelTable, RefusesTooFewSpeedsAndNamesThem) {
  FitRequest request;
  request.table = true;
  const auto fit = identify(
      log_of(humped_machine(), {{240, 3000}, {240, 0}, {240, 2000}, {240, 0}}), 0, "Z", request);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().what, HasSubstr("needs 3 … 16 speeds held for 20 min"));
  EXPECT_THAT(fit.error().what, HasSubstr("has 2: 2000, 3000 rpm"));
  EXPECT_THAT(fit.error().to_do, HasSubstr("--levels polynomial"));
}

}  // namespace
}  // namespace steadyrest::thermal::offline
