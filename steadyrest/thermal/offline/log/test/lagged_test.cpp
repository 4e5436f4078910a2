// SPDX-License-Identifier: Apache-2.0
// The columns of the fit against the solutions of their differential equations.
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/offline/fit/band.hpp>
#include <steadyrest/thermal/offline/log/lagged.hpp>

namespace steadyrest::thermal::offline {
namespace {

constexpr double kTau_s = 1800.0;
constexpr double kEvery_s = 60.0;

/// A log of `speed_rpm` in each row, a minute apart.
Log log_of_speeds(const std::vector<double>& speed_rpm) {
  Log log;
  for (std::size_t i = 0; i < speed_rpm.size(); ++i) {
    log.time_s.push_back(kEvery_s * static_cast<double>(i));
    log.speed_rev_s.push_back(speed_rpm[i] / 60.0);
  }
  return log;
}

std::vector<std::size_t> all_rows(const Log& log) {
  std::vector<std::size_t> rows(log.rows());
  std::iota(rows.begin(), rows.end(), 0U);
  return rows;
}

/// 1 − e^(−t/τ) after so many minutes.
double risen(double minutes, double tau_s = kTau_s) {
  return -std::expm1(-60.0 * minutes / tau_s);
}

TEST(LaggedPower, RisesAsTheStepResponse) {
  const Log log = log_of_speeds(std::vector<double>(100, 3000.0));
  const auto linear = lagged_power(log, all_rows(log), 1.0, kTau_s);
  const auto square = lagged_power(log, all_rows(log), 2.0, kTau_s);
  for (const Eigen::Index row : {0, 1, 30, 99}) {
    EXPECT_NEAR(linear[row], 3.0 * risen(static_cast<double>(row)), 1e-12) << row;
    EXPECT_NEAR(square[row], 9.0 * risen(static_cast<double>(row)), 1e-12) << row;
  }
}

// The inputs of a row apply until the next, so a change shows one row later.
TEST(LaggedPower, TakesEachRowsSpeedUntilTheNextRow) {
  const Log log = log_of_speeds({0, 1000, 0, 0, 0});
  const auto column = lagged_power(log, all_rows(log), 1.0, kTau_s);
  EXPECT_EQ(column[1], 0.0);
  EXPECT_NEAR(column[2], risen(1), 1e-15);
  EXPECT_NEAR(column[4], risen(1) * std::exp(-2.0 * kEvery_s / kTau_s), 1e-15);
}

// A machine at rest has no coolant and no draught: it cools with a time constant of its own.
TEST(LaggedPower, CoolsWithTheTimeConstantAtRest) {
  std::vector<double> speeds(50, 2000.0);
  speeds.resize(100, 0.0);
  const Log log = log_of_speeds(speeds);
  const auto column = lagged_power(log, all_rows(log), 1.0, kTau_s, 3.0 * kTau_s);
  EXPECT_NEAR(column[99], 2.0 * risen(50) * std::exp(-49.0 * kEvery_s / (3.0 * kTau_s)), 1e-12);
}

// Powers of a table's places: the shares of neighbours add up to the level of the speed itself.
TEST(LaggedShare, OfAllPlacesIsOneLevelBetweenThem) {
  const std::vector<double> table = {1000.0 / 60.0, 2000.0 / 60.0, 4000.0 / 60.0};
  const Log log = log_of_speeds(std::vector<double>(40, 3000.0));
  const auto rows = all_rows(log);
  const double at_end = risen(39);
  EXPECT_NEAR(lagged_share(log, rows, table, 0, kTau_s)[39], 0.0, 1e-15);
  EXPECT_NEAR(lagged_share(log, rows, table, 1, kTau_s)[39], 0.5 * at_end, 1e-12);
  EXPECT_NEAR(lagged_share(log, rows, table, 2, kTau_s)[39], 0.5 * at_end, 1e-12);
}

// A gap: nothing is known of the machine, so the column starts at 0 again.
TEST(Lagged, BeginsAnewAfterAGap) {
  Log log = log_of_speeds(std::vector<double>(40, 1000.0));
  log.gap = {20};
  EXPECT_EQ(stretches(log), (std::vector<std::size_t>{0, 20}));
  const auto rows = all_rows(log);
  const auto column = lagged_power(log, rows, 1.0, kTau_s);
  EXPECT_NEAR(column[19], risen(19), 1e-12);
  EXPECT_EQ(column[20], 0.0);
  EXPECT_NEAR(column[39], risen(19), 1e-12);
  // The state at a stretch's start fades within it and is nothing elsewhere.
  const auto first = fading(log, rows, 0, kTau_s);
  const auto second = fading(log, rows, 20, kTau_s);
  EXPECT_EQ(first[0], 1.0);
  EXPECT_NEAR(first[19], std::exp(-19.0 * kEvery_s / kTau_s), 1e-12);
  EXPECT_EQ(first[20], 0.0);
  EXPECT_EQ(second[19], 0.0);
  EXPECT_EQ(second[20], 1.0);
}

// A step of the room: 1 − e^(−t/τ) of it; a hole holds the last reading; no lag is the reading.
TEST(LaggedTemperature, FollowsAStepAndHoldsOverHoles) {
  const Log log = log_of_speeds(std::vector<double>(60, 0.0));
  LogChannel channel;
  channel.value.assign(60, 22.0);
  channel.value[0] = channel.value[1] = 20.0;
  for (std::size_t row = 30; row < 40; ++row) {
    channel.value[row] = kernel::units::kNan;
  }
  const auto rows = all_rows(log);
  const auto lagged = lagged_temperature(log, rows, channel, kTau_s);
  EXPECT_EQ(lagged[0], 20.0);
  EXPECT_EQ(lagged[2], 20.0);
  EXPECT_NEAR(lagged[59], 20.0 + 2.0 * risen(57), 1e-12);
  const auto direct = lagged_temperature(log, rows, channel, 0.0);
  EXPECT_EQ(direct[10], 22.0);
  EXPECT_EQ(direct[35], 22.0);
}

TEST(LaggedTemperature, BeforeItsFirstReadingIsThatReading) {
  const Log log = log_of_speeds(std::vector<double>(10, 0.0));
  LogChannel channel;
  channel.value.assign(10, kernel::units::kNan);
  channel.value[6] = 24.5;
  EXPECT_EQ(lagged_temperature(log, all_rows(log), channel, kTau_s)[0], 24.5);
}

// Only some rows are wanted: the others are walked over all the same.
TEST(Lagged, GivesTheRowsThatAreWanted) {
  const Log log = log_of_speeds(std::vector<double>(100, 3000.0));
  const std::vector<std::size_t> some = {3, 50, 99};
  const auto column = lagged_power(log, some, 1.0, kTau_s);
  const auto whole = lagged_power(log, all_rows(log), 1.0, kTau_s);
  ASSERT_EQ(column.size(), 3);
  EXPECT_EQ(column[0], whole[3]);
  EXPECT_EQ(column[1], whole[50]);
  EXPECT_EQ(column[2], whole[99]);
}

// Two-sided 95 % quantiles of Student's law, from tables: 12.706 for one degree of freedom, 3.182
// for three, 2.262 for nine, 2.045 for 29, 1.984 for 100; over 1.96.
TEST(Student, IsThePublishedQuantileOverTheNormalOne) {
  EXPECT_NEAR(student(2) * 1.96, 12.706, 5e-3);
  EXPECT_NEAR(student(4) * 1.96, 3.182, 5e-3);
  EXPECT_NEAR(student(10) * 1.96, 2.262, 5e-3);
  EXPECT_NEAR(student(30) * 1.96, 2.045, 5e-3);
  EXPECT_NEAR(student(101) * 1.96, 1.984, 5e-3);
  // One block reveals nothing about others: the widest there is, not a division by zero.
  EXPECT_EQ(student(1), student(2));
}

}  // namespace
}  // namespace steadyrest::thermal::offline
