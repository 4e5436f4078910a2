// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <bench/clairvoyant/clairvoyant.hpp>
#include <gtest/gtest.h>

namespace steadyrest::bench::clairvoyant {
namespace {

/// A straight stretch of 1 mm at 100 mm/s. Error ∝ ratio², as the lag of an arc gives it.
Station station(const Config& config, double error_at_full_mm) {
  Station result{.length_mm = 1.0, .time_s = {}, .error_mm = {}};
  for (const double ratio : config.ratio) {
    result.time_s.push_back(0.01 / ratio);
    result.error_mm.push_back(error_at_full_mm * ratio * ratio);
  }
  return result;
}

Config config() {
  return {.ratio = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}};
}

// 50 mm at 100 mm/s are 0.5 s.
TEST(Clairvoyant, RunsAtFullRatioWhereNothingLimits) {
  const std::vector<Station> stations(50, station(config(), 0.005));
  const Schedule schedule = best_schedule(stations, config());
  EXPECT_NEAR(schedule.time_s, 0.5, 1e-12);
  EXPECT_EQ(std::ranges::count(schedule.step, 9U), 50);
}

// Starts at the answer, so that the slew cannot blur it; 0.0399·0.6² = 0.0144 is over the limit of
// 0.010.
TEST(Clairvoyant, TakesTheLargestStepThatKeepsTheLimit) {
  // 0.04·ratio² ≤ 0.010 gives ratio 0.5 exactly.
  const std::vector<Station> stations(400, station(config(), 0.0399));
  Config from_half = config();
  from_half.start_ratio = 0.5;
  const Schedule schedule = best_schedule(stations, from_half);
  EXPECT_EQ(std::ranges::count(schedule.step, 4U), 400);
  EXPECT_DOUBLE_EQ(schedule.over_limit_s, 0.0);
}

// 0.9·ratio² ≤ 0.010 leaves only 0.1. From 1.0 down to it at the default fall takes less than 20
// stretches, so station 60 is still at full ratio.
TEST(Clairvoyant, FallsBeforeTheTightStretchAndRisesAfterItAsFastAsTheSlewAllows) {
  std::vector<Station> stations(200, station(config(), 0.001));
  std::fill(stations.begin() + 80, stations.begin() + 90, station(config(), 0.9));
  const Schedule schedule = best_schedule(stations, config());
  EXPECT_DOUBLE_EQ(schedule.over_limit_s, 0.0);
  EXPECT_EQ(schedule.step[80], 0U);
  EXPECT_EQ(schedule.step[60], 9U);
  // Rising by 0.9 at 2 1/s takes 0.45 s, less the last part of the way during which the next step
  // is in force already.
  double rising_s = 0.0;
  for (std::size_t j = 90; schedule.step[j] < 9; ++j) {
    rising_s += stations[j].time_s[schedule.step[j]];
  }
  EXPECT_GT(rising_s, 0.30);
  EXPECT_LT(rising_s, 0.46);
}

// 100·0.1² = 1 mm at the slowest step: all of the time is over the limit, and the schedule says so.
TEST(Clairvoyant, SaysSoWhereNoStepKeepsTheLimit) {
  const std::vector<Station> stations(10, station(config(), 100.0));
  Config slow = config();
  slow.start_ratio = 0.1;
  const Schedule schedule = best_schedule(stations, slow);
  EXPECT_NEAR(schedule.over_limit_s, schedule.time_s, 1e-12);
}

}  // namespace
}  // namespace steadyrest::bench::clairvoyant
