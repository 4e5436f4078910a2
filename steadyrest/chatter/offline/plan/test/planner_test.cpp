// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/plan/test/slot_plan.hpp>
#include <steadyrest/chatter/offline/test/machines.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::machine::Machine;
using kernel::testing::kSanitized;
using online::Law;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Limit depths of the literature's table: 5000 rpm 0.4086, 5500 rpm 2.7653 (converged: 2.7646),
/// 4500 rpm 1.2254.
TEST(Planner, SlotAt5000RpmGoesTo110Percent) {
  const Plan p = plan_at(all_steps(), 5000.0, 1.0);
  EXPECT_EQ(p.decision, PlanDecision::constant);
  EXPECT_DOUBLE_EQ(p.chosen.ratio, 1.1);
  EXPECT_NEAR(*p.chosen.limit_depth_mm, 2.7653, 1e-3);
  EXPECT_EQ(*p.chosen.probability, 1.0);
  ASSERT_EQ(p.alternatives.size(), 15U);
  EXPECT_NEAR(*p.alternatives[10].limit_depth_mm, 0.4086, 1e-4);
  EXPECT_FALSE(p.alternatives[10].stable);
  // 90 % is stable with the given figures but not reliably: yes or no would not tell.
  EXPECT_NEAR(*p.alternatives[8].limit_depth_mm, 1.2254, 1e-3);
  EXPECT_TRUE(p.alternatives[8].stable);
  EXPECT_FALSE(p.alternatives[8].accepted());
  EXPECT_GT(*p.alternatives[8].probability, 0.5);
  EXPECT_LT(*p.alternatives[8].probability, 0.95);
  EXPECT_NEAR(*p.chatter_frequency_hz, 960.0, 40.0);
}

// 5500 rpm allows 2.76 mm: any change would be pointless.
TEST(Planner, AStableCutIsLeftAlone) {
  const Plan p = plan_at(all_steps(), 5500.0, 1.0);
  EXPECT_EQ(p.decision, PlanDecision::keep);
  EXPECT_DOUBLE_EQ(p.chosen.ratio, 1.0);
  EXPECT_TRUE(p.notes.empty());
}

TEST(Planner, OfEqualStepsTheNearestTo100PercentIsTaken) {
  PlanOptions options;
  options.uncertainty = {.frequency = 0.0, .damping = 0.0, .coefficients = 0.0, .samples = 1};
  const Plan p = plan_at(all_steps(), 5000.0, 0.7, options);
  EXPECT_EQ(p.decision, PlanDecision::constant);
  // Stable there: 50, 55, 80, 90, 105 and 110 %.
  EXPECT_DOUBLE_EQ(p.chosen.ratio, 1.05);
}

/// Between the first lobes only a large change of speed or less depth helps.
TEST(Planner, SaysWhenNothingHelpsAndWhatDepthWould) {
  PlanOptions options;
  options.laws = {Law::triangle, Law::square};
  const Plan p = plan_at(light_spindle({95, 100, 105}), 15000.0, 2.0, options);
  EXPECT_EQ(p.decision, PlanDecision::nothing);
  EXPECT_DOUBLE_EQ(p.chosen.ratio, 1.0);
  ASSERT_GE(p.notes.size(), 2U);
  EXPECT_THAT(p.notes[0], HasSubstr("nothing helps at 2 mm; the deepest border is"));
  EXPECT_THAT(p.notes[1], HasSubstr("waves between two teeth"));
  EXPECT_GT(p.likely_depth_mm, 0.0);
  EXPECT_LT(p.likely_depth_mm, 2.0);
  for (const Alternative& a : p.alternatives) {
    EXPECT_FALSE(a.reasons.empty());
  }
}

// Threads share the possible cuts; their order must not affect the answer.
TEST(Planner, TwiceTheSameGivesTheSame) {
  const Plan a = plan_at(all_steps(), 5000.0, 1.0);
  const Plan b = plan_at(all_steps(), 5000.0, 1.0);
  for (std::size_t i = 0; i < a.alternatives.size(); ++i) {
    EXPECT_EQ(a.alternatives[i].probability, b.alternatives[i].probability);
    EXPECT_EQ(a.alternatives[i].limit_depth_mm, b.alternatives[i].limit_depth_mm);
  }
}

TEST(Planner, RefusesWhatIsOutOfRange) {
  const Machine m = all_steps();
  EXPECT_FALSE(plan(kSlot, m, 0.0, 1.0, {}).has_value());
  EXPECT_FALSE(plan(kSlot, m, 80.0, -1.0, {}).has_value());
  EXPECT_FALSE(plan(Process{}, m, 80.0, 1.0, {}).has_value());
  PlanOptions options;
  options.least_probability = 1.1;
  EXPECT_FALSE(plan(kSlot, m, 80.0, 1.0, options).has_value());
  options = {};
  options.rva = {1.0};
  EXPECT_FALSE(plan(kSlot, m, 80.0, 1.0, options).has_value());
}

TEST(Planner, SaysWhichOptionIsOutOfRange) {
  const Machine m = all_steps();
  const auto what = [&m](const PlanOptions& options) {
    const auto made = plan(kSlot, m, 80.0, 1.0, options);
    return made ? std::string{} : made.error().what;
  };
  PlanOptions options;
  options.least_probability = 1.1;
  EXPECT_EQ(what(options), "probability in % = 110; allowed: from 0 to 100");
  options = {};
  options.uncertainty.samples = 5000;
  EXPECT_EQ(what(options), "number of possible cuts = 5000; allowed: from 1 to 4096");
  options = {};
  options.most_depth_mm = 0.5;
  EXPECT_EQ(what(options), "the border search ends at 0.5 mm, short of the wanted depth of 1 mm");
}

/// 922 Hz, two teeth: 31 waves at 900 rpm, 5.5 at 5000.
TEST(Planner, SaysThatProcessDampingIsLeftOutAtLowSpeeds) {
  PlanOptions options;
  options.laws = {};
  options.uncertainty.samples = kSanitized ? 2 : options.uncertainty.samples;
  const auto notes = [&](const Process& process, double rpm) {
    const auto made = plan(process, all_steps(), rpm / 60.0, 0.2, options);
    return made ? made->notes : std::vector<std::string>{};
  };
  const auto slow = notes(kSlot, 900.0);
  EXPECT_THAT(slow, Contains(HasSubstr("31 waves between two teeth")));
  EXPECT_THAT(slow, Contains(HasSubstr("process_damping_N_mm")));
  EXPECT_THAT(notes(kSlot, 5000.0), Not(Contains(HasSubstr("process_damping_N_mm"))));
  Process damped = kSlot;
  damped.cut.process_damping_n_mm = 10.0;
  EXPECT_THAT(notes(damped, 900.0), Not(Contains(HasSubstr("process_damping_N_mm"))));
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
