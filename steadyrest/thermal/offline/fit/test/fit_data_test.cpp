// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/fit_data.hpp>
#include <steadyrest/thermal/offline/fit/test/runs_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

using test::kWholeLog_s;
using test::log_of_runs;

TEST(FitData, CountsFromTheFirstReadingAndLeavesHolesOut) {
  Log log = log_of_runs({{30, 3000}});
  log.displacement[0].value[0] = std::numeric_limits<double>::quiet_NaN();
  log.displacement[0].value[5] = std::numeric_limits<double>::quiet_NaN();
  const FitData data = fit_data(log, 0, -kWholeLog_s, kWholeLog_s);
  EXPECT_EQ(data.rows(), 28U);
  EXPECT_EQ(data.row.front(), 1U);
  EXPECT_NEAR(data.zero_um, 101.0, 1e-9);
  EXPECT_EQ(data.reading_um[0], 0.0);
  EXPECT_NEAR(data.reading_um[27], 28.0, 1e-9);
  EXPECT_NEAR(data.noise_um, 1.0 / std::sqrt(12.0), 1e-9) << "it steps by whole micrometres";
}

// A day of a row each second: the steps are 86 400/1400 s, and both ends are kept.
TEST(FitData, ThinsALongLogAndKeepsItsLastReading) {
  const Log log = log_of_runs({{1440, 3000}}, 1.0);
  const FitData data = fit_data(log, 0, -kWholeLog_s, kWholeLog_s);
  EXPECT_NEAR(static_cast<double>(data.rows()), static_cast<double>(kFitRows), 3.0);
  EXPECT_EQ(data.row.front(), 0U);
  EXPECT_EQ(data.row.back(), log.rows() - 1);
  for (std::size_t i = 1; i + 1 < data.rows(); ++i) {
    EXPECT_NEAR(data.time_s[i] - data.time_s[i - 1], 86400.0 / 1400.0, 1.0) << i;
  }
}

// The row at a gap has no reading, so the first one after it is fresh.
TEST(FitData, NamesTheFirstReadingAfterAGap) {
  Log log = log_of_runs({{60, 3000}});
  log.gap = {20};
  log.displacement[0].value[20] = std::numeric_limits<double>::quiet_NaN();
  const FitData data = fit_data(log, 0, -kWholeLog_s, kWholeLog_s);
  ASSERT_EQ(data.fresh.size(), 1U);
  EXPECT_EQ(data.row[data.fresh[0]], 21U);
}

TEST(FitData, TakesTheWindowAlone) {
  const Log log = log_of_runs({{30, 1500}, {30, 3000}, {30, 1500}});
  const FitData data = fit_data(log, 0, 40.0 * 60.0, 70.0 * 60.0);
  EXPECT_EQ(data.row.front(), 40U);
  EXPECT_EQ(data.row.back(), 70U);
  EXPECT_NEAR(data.zero_um, 140.0, 1e-9);
  EXPECT_NEAR(data.hours(), 0.5, 1e-12);
  EXPECT_NEAR(data.fastest_rev_s, 50.0, 1e-12);
  EXPECT_NEAR(fit_data(log, 0, 62.0 * 60.0, kWholeLog_s).fastest_rev_s, 25.0, 1e-12);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
