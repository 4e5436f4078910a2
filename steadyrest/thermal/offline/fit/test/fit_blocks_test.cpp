// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/fit_data.hpp>
#include <steadyrest/thermal/offline/fit/test/runs_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

using test::kWholeLog_s;
using test::log_of_runs;
using testing::ElementsAre;

using Runs = std::vector<std::pair<int, double>>;  ///< minutes, rpm

/// Where each block begins, in minutes.
std::vector<double> block_starts_min(const Runs& runs) {
  const Log log = log_of_runs(runs);
  const FitData data = fit_data(log, 0, -kWholeLog_s, kWholeLog_s);
  std::vector<double> out;
  for (const FitData::Block& block : data.block) {
    EXPECT_GT(block.end, block.begin);
    out.push_back(data.time_s[block.begin] / 60.0);
  }
  return out;
}

// Rest before the first start belongs to it, and ten minutes of it are no rest.
TEST(FitBlocks, RunFromStartToStart) {
  EXPECT_THAT(block_starts_min({{20, 0},
                                {100, 3000},
                                {60, 0},
                                {100, 1000},
                                {60, 0},
                                {50, 2000},
                                {10, 0},
                                {50, 2500},
                                {60, 0},
                                {100, 3000},
                                {60, 0}}),
              ElementsAre(0.0, 180.0, 340.0, 510.0));
}

// A start 20 min before the log's end would leave a block of 20 min.
TEST(FitBlocks, AStubIsNoBlockOfItsOwn) {
  Runs runs = {{10, 0}, {90, 3000}, {30, 0}, {90, 3000}, {30, 0}, {90, 3000}, {30, 0}};
  runs.emplace_back(20, 3000.0);
  EXPECT_THAT(block_starts_min(runs), ElementsAre(0.0, 130.0, 250.0));
  runs.back().first = 40;
  EXPECT_THAT(block_starts_min(runs), ElementsAre(0.0, 130.0, 250.0, 370.0));
}

TEST(FitBlocks, OfALogWithoutStartsAreEqualTimes) {
  const auto starts = block_starts_min({{1000, 3000}});
  ASSERT_EQ(starts.size(), 5U);
  for (std::size_t b = 0; b < 5; ++b) {
    EXPECT_NEAR(starts[b], 200.0 * static_cast<double>(b), 1.0) << b;
  }
  EXPECT_TRUE(block_starts_min({{300, 3000}}).empty())
      << "five hours have two blocks of two hours, and three are needed";
}

// 3000 rpm is more than 1.2 times the 2000 of all others.
TEST(FitBlocks, OneFasterThanAllOthersIsOutOfReach) {
  const Log log = log_of_runs({{10, 0},
                               {100, 3000},
                               {60, 0},
                               {100, 2000},
                               {60, 0},
                               {100, 1800},
                               {60, 0},
                               {100, 1000},
                               {60, 0}});
  EXPECT_THAT(fit_data(log, 0, -kWholeLog_s, kWholeLog_s).within_reach(), ElementsAre(1U, 2U, 3U));
}

TEST(LongestRun, IsTheLongestTimeAtOneSpeed) {
  const Log log = log_of_runs({{30, 1000}, {50, 2000}, {40, 0}, {20, 2000}, {25, 2010}, {9, 500}});
  const auto longest_min = [&](double from_min, double to_min) {
    return longest_run_s(log, 60.0 * from_min, 60.0 * to_min) / 60.0;
  };
  EXPECT_NEAR(longest_min(-1e9, 1e9), 50.0, 1.0);
  EXPECT_NEAR(longest_min(90.0, 1e9), 45.0, 1.0) << "a speed wavers by half a percent";
  EXPECT_NEAR(longest_min(-1e9, 40.0), 30.0, 1.0) << "of the window alone";
  EXPECT_EQ(longest_min(85.0, 115.0), 0.0) << "at rest";
}

}  // namespace
}  // namespace steadyrest::thermal::offline
