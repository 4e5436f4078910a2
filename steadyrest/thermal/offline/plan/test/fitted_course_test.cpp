// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/identify.hpp>
#include <steadyrest/thermal/offline/plan/fitted_course.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>
#include <steadyrest/thermal/offline/test/synthetic_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;
using test::KnownMachine;
using test::log_of;

const std::vector<std::pair<int, double>> kDay = {{120, 3000}, {90, 0},     {120, 1500},
                                                  {90, 0},     {120, 2250}, {90, 0}};
const KnownMachine kMachine{{{20.0, 4.0}, {120.0, 9.0}}, 0.0, 0.0, 0.0};

ThermalAxis spindle_passport() {
  ThermalAxis axis;
  for (const auto& known : kMachine.mode) {
    ThermalMode mode;
    mode.tau_s = 60.0 * known.tau_min;
    mode.polynomial_mm = {1e-3 * known.um_per_krpm};
    axis.mode.push_back(mode);
  }
  axis.noise_mm = 1e-5;
  axis.max_speed_rev_s = 50.0;
  return axis;
}

/// The same without its first minutes: the log begins with a hot machine.
Log without_the_first(Log log, std::size_t rows) {
  const auto cut = [&](std::vector<double>& column) {
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(rows));
  };
  cut(log.time_s);
  cut(log.speed_rev_s);
  for (auto& channel : log.displacement) {
    cut(channel.value);
  }
  return log;
}

std::vector<FittedPoint> course(const ThermalAxis& axis, const Log& log, double from_s = -1e300,
                                double to_s = 1e300) {
  auto points = fitted_course(axis, log, 0, from_s, to_s);
  EXPECT_TRUE(points.has_value()) << points.error().what;
  return points ? *points : std::vector<FittedPoint>{};
}

double largest_um(const std::vector<FittedPoint>& points) {
  double most = 0.0;
  for (const FittedPoint& p : points) {
    most = std::max(most, 1e3 * std::abs(p.measured_mm - p.modelled_mm));
  }
  return most;
}

// Without noise the only unknown is the state at the start: two modes from hundreds of rows.
TEST(FittedCourse, OfTheTruePassportIsTheLogThoughItBeganHot) {
  const Log log = without_the_first(log_of(kMachine, kDay), 100);
  EXPECT_GT(log.displacement[0].value.front(), 0.015);
  EXPECT_LT(largest_um(course(spindle_passport(), log)), 0.01);
}

// What the slow mode gained in the gap decays with its own 120 min; only a new state explains it.
TEST(FittedCourse, BeginsAnewAfterAGap) {
  Log log = log_of(kMachine, kDay);
  for (std::size_t row = 200; row < log.rows(); ++row) {
    log.displacement[0].value[row] +=
        0.012 * std::exp(-60.0 * (static_cast<double>(row) - 200.0) / 7200.0);
  }
  EXPECT_GT(largest_um(course(spindle_passport(), log)), 1.0);
  log.gap = {200};
  EXPECT_LT(largest_um(course(spindle_passport(), log)), 0.01);
}

// A millimetre on each later reading: the smallest leak would show in the course.
TEST(FittedCourse, UsesNoReadingBeyondTheWindow) {
  Log log = log_of(kMachine, kDay);
  const auto as_it_was = course(spindle_passport(), log, 3600.0, 6.0 * 3600.0);
  for (std::size_t row = 361; row < log.rows(); ++row) {
    log.displacement[0].value[row] += 1.0;
  }
  const auto points = course(spindle_passport(), log, 3600.0, 6.0 * 3600.0);
  ASSERT_EQ(points.size(), log.rows() - 60);
  EXPECT_DOUBLE_EQ(points.front().time_s, 3600.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].modelled_mm, as_it_was[i].modelled_mm) << i;
    EXPECT_EQ(points[i].fitted, points[i].time_s <= 6.0 * 3600.0) << i;
  }
}

TEST(FittedCourse, LeavesWhatTheFitSaysAndHoldsItsBand) {
  KnownMachine machine = kMachine;
  machine.noise_um = 0.4;
  const Log log = log_of(machine, kDay);
  const auto fit = identify(log, 0, "Z", {});
  ASSERT_TRUE(fit) << fit.error().what;
  double square_um2 = 0.0;
  double within = 0.0;
  const auto points = course(fit->axis, log);
  for (const FittedPoint& p : points) {
    const double off_mm = p.measured_mm - p.modelled_mm;
    square_um2 += 1e6 * off_mm * off_mm;
    within += std::abs(off_mm) <= kBand * p.sd_mm ? 1.0 : 0.0;
  }
  const auto n = static_cast<double>(points.size());
  // The passport lacks the fit's starting states; found again, they give the same residual.
  EXPECT_NEAR(std::sqrt(square_um2 / n), fit->rms_um, 0.02);
  EXPECT_GT(within / n, 0.95);
}

TEST(FittedCourse, RefusesALogWithoutTheSensor) {
  ThermalAxis axis = spindle_passport();
  axis.ambient.emplace_back().sensor = "room_c";
  const auto points = fitted_course(axis, log_of(kMachine, kDay), 0);
  ASSERT_FALSE(points);
  EXPECT_THAT(points.error().what, testing::HasSubstr("room_c"));
}

}  // namespace
}  // namespace steadyrest::thermal::offline
