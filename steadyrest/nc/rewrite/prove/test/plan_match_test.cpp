// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/prove/plan_match.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using ::testing::HasSubstr;
using Changes = std::vector<WrittenChange>;

/// Sums of displacement in um at these seconds, against corrections in um at those.
class PlanMatch : public ::testing::Test {
 protected:
  PlanMatch() { settings_.window_s = 10.0; }
  void plan(std::vector<PlannedStep> steps) { axis_.steps = std::move(steps); }
  std::string fault(const std::vector<std::pair<double, double>>& written) const {
    Changes changes;
    for (const auto& [time_s, um] : written) {
      changes.push_back({.line = 7, .stands_mm = um * 1e-3, .unit_mm = 1.0, .time_s = time_s});
    }
    const auto found = mismatch(axis_, settings_, changes);
    return found ? found->what : "";
  }
  AxisPlan axis_;
  Settings settings_;
};

TEST_F(PlanMatch, EveryStepHasItsChangeWithinTheWindow) {
  // Two steps at 60 and 120 s; the window is 10 s on either side.
  plan({{60, 10}, {120, 20}});
  EXPECT_EQ(fault({{55, -10}, {130, -20}}), "");
  EXPECT_THAT(fault({{55, -10}, {131, -20}}), HasSubstr("acts at 131.0 s"));
  EXPECT_THAT(fault({{55, -10}}), HasSubstr("planned at 120.0 s is missing"));
  EXPECT_THAT(fault({{55, -10}, {120, -20}, {121, -10}}), HasSubstr("has no such"));
}

TEST_F(PlanMatch, StepsThatMeetAtOnePlaceMayCancelThere) {
  // Both windows include 55 to 70 s, so the two may cancel there unseen.
  plan({{60, 10}, {65, 0}});
  EXPECT_EQ(fault({}), "");
  EXPECT_EQ(fault({{58, -10}, {66, 0}}), "");
  // 21 s apart no instant lies in both windows.
  plan({{60, 10}, {81, 0}});
  EXPECT_THAT(fault({}), HasSubstr("planned at 60.0 s is missing"));
  EXPECT_EQ(fault({{70, -10}, {71, 0}}), "");
}

TEST_F(PlanMatch, TheSameSumMayComeAgain) {
  // Which of the two 10 um steps a change answers must be found, not guessed: the first may cancel
  // with the second.
  plan({{60, 10}, {62, 0}, {200, 10}});
  EXPECT_EQ(fault({{200, -10}}), "");
  EXPECT_EQ(fault({{60, -10}, {62, 0}, {200, -10}}), "");
  EXPECT_THAT(fault({{60, -10}}), HasSubstr("missing"));
  plan({{60, 10}, {62, 0}, {64, 10}});
  EXPECT_EQ(fault({{61, -10}}), "");
}

TEST_F(PlanMatch, WhatTheControlCannotTakeIsNotMissing) {
  settings_.method = Method::fanuc;
  // The increment is 1 um: 0.4 rounds to 0, 0.8 and 1.2 to 1, 1.6 to 2.
  plan({{60, 0.4}, {100, 0.8}, {200, 1.2}, {300, 1.6}});
  EXPECT_EQ(fault({{100, -1}, {300, -2}}), "");
  EXPECT_THAT(fault({{100, -1}}), HasSubstr("300.0 s is missing"));
}

TEST_F(PlanMatch, NoStepIsPassedOverBehindALaterChange) {
  // A sum of 5 um is planned only at 302 s: taken at 60 s it would skip the steps at 300 s.
  plan({{60, 10}, {61, 0}, {300, 10}, {301, 0}, {302, 5}});
  EXPECT_EQ(fault({{302, -5}}), "");
  EXPECT_THAT(fault({{60, -5}}), HasSubstr("acts at 60.0 s"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
