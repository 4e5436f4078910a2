// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/trial/timing/judgement.hpp>

namespace steadyrest::trial::timing {
namespace {

using kernel::machine::Machine;
using passport::Finding;
using passport::Severity;
using testing::HasSubstr;
using testing::Not;

/// Of a cycle of 1 ms.
LayerTiming timing_of(double decision_p999_s) {
  LayerTiming timing;
  timing.cycle_s = 0.001;
  timing.cycles = 8000;
  timing.decisions = 2000;
  timing.decision_s.p999 = decision_p999_s;
  timing.decision_s.worst = 0.1;  // one of two thousand is no finding
  return timing;
}

Machine falling(double fall_1_s) {
  Machine machine;
  machine.envelope.feed_fall_1_s = fall_1_s;
  return machine;
}

// Half of the cycle remains for the port and the operating system.
TEST(Judgement, FindsNothingUpToHalfOfTheCycle) {
  EXPECT_TRUE(judge(timing_of(0.0), {}).empty());
  EXPECT_TRUE(judge(timing_of(0.0005), {}).empty());
}

TEST(Judgement, WarnsBeyondHalfOfTheCycle) {
  for (const double took_s : {0.000501, 0.001}) {
    const auto findings = judge(timing_of(took_s), {});
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].severity, Severity::warning);
    EXPECT_EQ(findings[0].check, "cycle_time");
    EXPECT_THAT(findings[0].what, HasSubstr("more than 50 % of it"));
  }
}

TEST(Judgement, IsAnErrorBeyondTheCycle) {
  const auto findings = judge(timing_of(0.0015), falling(0.2));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_EQ(findings[0].check, "cycle_time");
  EXPECT_EQ(findings[0].what,
            "the layer takes 1500 µs of a control cycle of 1000 µs (p99.9 of 2000 decisions): it "
            "would miss cycles");
  EXPECT_EQ(findings[0].to_do,
            "raise feed_fall_percent_s or contour.min_percent to shorten the forecasts (the fall "
            "takes 4.5 s), lengthen interpolator_period_ms or use a faster computer");
}

// 0.9 of ratio at 10 1/s is 0.09 s: shortening it would not help.
TEST(Judgement, DoesNotBlameAQuickFall) {
  EXPECT_THAT(judge(timing_of(0.0015), falling(10.0))[0].to_do, Not(HasSubstr("feed_fall")));
}

// Without decisions the forecasts are not to blame.
TEST(Judgement, OfALayerThatDecidesNothingIsByAllCycles) {
  LayerTiming timing = timing_of(0.0);
  timing.decisions = 0;
  timing.work_s.p999 = 0.002;
  const auto findings = judge(timing, falling(0.2));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_THAT(findings[0].what, HasSubstr("(p99.9 of 8000 cycles)"));
  EXPECT_THAT(findings[0].to_do, Not(HasSubstr("feed_fall")));
}

}  // namespace
}  // namespace steadyrest::trial::timing
