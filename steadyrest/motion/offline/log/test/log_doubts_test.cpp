// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/motion/offline/log/log_doubts.hpp>

namespace steadyrest::motion::offline {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A row each millisecond, the count rising by these steps.
EdgeLog log_of_steps(const std::vector<int>& steps, double step_s = 1e-3) {
  EdgeLog log;
  log.file = "axis.csv";
  log.rows.push_back({0.0, 1000});
  for (const int step : steps) {
    log.rows.push_back(
        {static_cast<double>(log.rows.size()) * step_s, log.rows.back().count + step});
  }
  return log;
}

LogClaims ticks_at(double cycle_hz) {
  return {.input = LogInput::ticks, .cycle_hz = cycle_hz};
}

/// Whether the steps show a jump of the count.
bool jumps(const std::vector<int>& steps, const LogClaims& claims = ticks_at(1000.0)) {
  return !doubts(log_of_steps(steps), claims).empty();
}

TEST(LogDoubts, RowsThatAreNoCycleApartAreTold) {
  const EdgeLog log = log_of_steps(std::vector<int>(30, 1));
  for (const double near_hz : {910.0, 1000.0, 1090.0}) {
    EXPECT_TRUE(doubts(log, ticks_at(near_hz)).empty()) << near_hz;
  }
  for (const double off_hz : {1.0, 890.0, 1120.0, 60000.0}) {
    EXPECT_EQ(doubts(log, ticks_at(off_hz)).size(), 1U) << off_hz;
  }
  EXPECT_THAT(doubts(log, ticks_at(2000.0)).front().what,
              AllOf(HasSubstr("1 ms apart"), HasSubstr("2000 cycles a second are 0.5 ms")));
  EXPECT_TRUE(doubts(log, {.input = LogInput::edges, .cycle_hz = 2000.0}).empty())
      << "edges come when they come";
}

// The median is the usual step: one pause in the log is not another cycle.
TEST(LogDoubts, OnePauseIsNoOtherCycle) {
  EdgeLog log = log_of_steps(std::vector<int>(30, 1));
  for (std::size_t i = 15; i < log.rows.size(); ++i) {
    log.rows[i].t_s += 5.0;
  }
  EXPECT_TRUE(doubts(log, ticks_at(1000.0)).empty());
}

TEST(LogDoubts, AStepThatBothNeighboursContradictIsAJump) {
  EXPECT_TRUE(jumps({2, 2, 2, 60, 2, 2}));
  EXPECT_TRUE(jumps({2, 2, 2, -60, 2, 2}));
  EXPECT_TRUE(jumps({10, 10, -60, 10, 10})) << "neighbours that go the other way are no support";
  EXPECT_TRUE(jumps({2, 2, 2, 60})) << "at the end of the log";
  EXPECT_FALSE(jumps({0, 0, 49, 0, 0})) << "fewer than 50 counts may be a start and a stop";
  EXPECT_TRUE(jumps({0, 0, 50, 0, 0}));
  EXPECT_FALSE(jumps({3, 3, 59, 3, 3})) << "not 20 times as fast";
  EXPECT_TRUE(jumps({3, 3, 60, 3, 3}));
}

TEST(LogDoubts, AnAxisThatStartsHardIsBelieved) {
  EXPECT_FALSE(jumps({0, 0, 60, 120, 180, 180, 180}));
  EXPECT_FALSE(jumps({180, 180, 120, 60, 0, 0}));
  EXPECT_FALSE(jumps({0, 2, 60, 2, 0}, {.input = LogInput::ticks, .max_speed_counts_s = 1e6}))
      << "with a largest speed the reader has judged each step already";
}

TEST(LogDoubts, NamesTheLargestJumpAndCountsAll) {
  const auto found = doubts(log_of_steps({1, 1, 70, 1, 1, -900, 1, 1, 80, 1}), ticks_at(1000.0));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found.front().what,
              AllOf(HasSubstr("jumps by -900 in 1 ms at t_s = 0.006"), HasSubstr("3 such in 11")));
}

TEST(LogDoubts, MoreThanTenCyclesApartIsNoLogOfCycles) {
  const EdgeLog slow = log_of_steps({1, 1, 1, 1}, 0.0105);
  EXPECT_TRUE(no_cycles(slow, ticks_at(1000.0)).has_value());
  EXPECT_FALSE(no_cycles(slow, ticks_at(900.0)).has_value());
  EXPECT_FALSE(no_cycles(slow, {.input = LogInput::edges, .cycle_hz = 1000.0}).has_value());
}

}  // namespace
}  // namespace steadyrest::motion::offline
