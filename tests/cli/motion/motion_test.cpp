// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kUnits = "motion units --cycle-hz 1000 --count-mm 0.001 ";
const std::string kEncoder = "motion encoder --max-frequency-hz 300000 ";

// Figures of the paper (Kombarov 2011): F = 20 000 mm/min is 333.3 counts/tick at 1 kHz and 1 µm; 2
// g is 19.6 counts/tick², at 2.5 kHz 3.14.
TEST(MotionUnits, ConvertsFeedAndOverload) {
  EXPECT_NEAR(answer_of(kUnits + "--feed-mm-min 20000")["counts_per_tick"], 333.3, 0.05);
  const json both = answer_of(kUnits + "--feed-mm-min 9000 --overload-g 2");
  EXPECT_NEAR(both["counts_per_tick"], 150.0, 1e-9);
  EXPECT_NEAR(both["counts_per_tick2"], 19.6, 0.05);
  const std::string fast = "motion units --cycle-hz 2500 --overload-g 2";
  EXPECT_NEAR(answer_of(fast)["counts_per_tick2"], 3.14, 0.005);
}

TEST(MotionUnits, ConvertsBack) {
  EXPECT_NEAR(answer_of(kUnits + "--counts-per-tick 150")["feed_mm_min"], 9000.0, 1e-6);
  const json back = answer_of(kUnits + "--counts-per-tick2 2.1");
  EXPECT_NEAR(back["overload_g"], 0.21, 0.005);
  EXPECT_NEAR(back["acceleration_mm_s2"], 2100.0, 1e-6);
}

TEST(MotionUnits, ShowsAShortTableToPeople) {
  EXPECT_THAT(run_line(kUnits + "--feed-mm-min 20000").out, HasSubstr("333.333 counts/tick\n"));
}

// Each needed number missing, 0, negative, not finite, or given twice.
TEST(MotionUnits, RefusesBadUsage) {
  expect_all_refused({"motion units --feed-mm-min 100", "motion units --cycle-hz 1000",
                      "motion units --cycle-hz 0 --feed-mm-min 100",
                      "motion units --cycle-hz nan --feed-mm-min 100",
                      "motion units --cycle-hz 1000 --feed-mm-min -100",
                      "motion units --cycle-hz 1000 --feed-mm-min ten",
                      "motion units --cycle-hz 1000 --overload-g inf",
                      "motion units --cycle-hz 1000 --overload-g 0",
                      "motion units --cycle-hz 1000 --count-mm 0 --overload-g 1",
                      "motion units --cycle-hz 1000 --counts-per-tick -3",
                      "motion units --cycle-hz 1000 --counts-per-tick2 nan",
                      "motion units --cycle-hz 1000 --feed-mm-min 1 --counts-per-tick 1",
                      "motion units --cycle-hz 1000 --overload-g 1 --counts-per-tick2 1"});
}

// Eq. 6: lines = W·h/v = 300 kHz · 10 mm/125 mm/s = 24 000; eq. 8: count = h/(4·lines) = 0.1 µm.
TEST(MotionEncoder, GivesTheLinesForAFeed) {
  const json lathe = answer_of(kEncoder + "--feed-mm-min 7500 --lead-mm 10");
  EXPECT_NEAR(lathe["lines_per_rev"], 24000.0, 1e-6);
  EXPECT_EQ(lathe["whole_lines_per_rev"], 24000.0);
  EXPECT_NEAR(lathe["count_mm"], 1e-4, 0.05e-4);
  const json fast = answer_of(kEncoder + "--feed-mm-min 60000 --lead-mm 10");
  EXPECT_NEAR(fast["lines_per_rev"], 3000.0, 1e-6);
  EXPECT_NEAR(fast["count_mm"], 0.83e-3, 0.005e-3);
}

// Eq. 7: lines = W/n; 7000 rpm gives 2571.4, and only whole lines can be bought.
TEST(MotionEncoder, GivesTheLinesForASpindle) {
  EXPECT_NEAR(answer_of(kEncoder + "--speed-rpm 2000")["lines_per_rev"], 9000.0, 1e-6);
  EXPECT_NEAR(answer_of(kEncoder + "--speed-rpm 10000")["lines_per_rev"], 1800.0, 1e-6);
  EXPECT_EQ(answer_of(kEncoder + "--speed-rpm 7000")["whole_lines_per_rev"], 2571.0);
}

// The way back, and an intended count of 1 µm: 2500 lines.
TEST(MotionEncoder, GivesTheLargestSpeedForLines) {
  const json back = answer_of(kEncoder + "--lines-per-rev 3000 --lead-mm 10");
  EXPECT_NEAR(back["feed_mm_min"], 60000.0, 1e-6);
  EXPECT_NEAR(back["speed_rpm"], 6000.0, 1e-6);
  EXPECT_NEAR(back["count_mm"], 0.83e-3, 0.005e-3);
  const json wanted = answer_of(kEncoder + "--count-mm 0.001 --lead-mm 10");
  EXPECT_NEAR(wanted["lines_per_rev"], 2500.0, 1e-9);
  EXPECT_NEAR(wanted["feed_mm_min"], 72000.0, 1e-6);
}

// Eq. 5: 180 000 lines at 5000 rpm are 15 MHz, beyond any counter: why finer is not the answer.
TEST(MotionEncoder, GivesTheSignalFrequency) {
  const std::string a110 = "motion encoder --lines-per-rev 180000 --speed-rpm 5000";
  EXPECT_NEAR(answer_of(a110)["signal_frequency_hz"], 15e6, 1e-3);
}

TEST(MotionEncoder, RefusesBadUsage) {
  expect_all_refused(
      {"motion encoder", "motion encoder --max-frequency-hz 300000",
       "motion encoder --max-frequency-hz 300000 --feed-mm-min 7500",
       "motion encoder --max-frequency-hz 300000 --feed-mm-min 7500 --lead-mm 0",
       "motion encoder --max-frequency-hz 300000 --feed-mm-min 0 --lead-mm 10",
       "motion encoder --max-frequency-hz nan --feed-mm-min 7500 --lead-mm 10",
       "motion encoder --max-frequency-hz 300000 --speed-rpm -1",
       "motion encoder --max-frequency-hz 300000 --speed-rpm 1 --feed-mm-min 1 --lead-mm 1",
       "motion encoder --speed-rpm 2000", "motion encoder --lines-per-rev 0 --lead-mm 10",
       "motion encoder --lines-per-rev 100 --lead-mm -1 --feed-mm-min 10",
       "motion encoder --count-mm 0.001", "motion encoder --count-mm -1 --lead-mm 10"});
}

}  // namespace
}  // namespace steadyrest::test
