// SPDX-License-Identifier: Apache-2.0
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
using testing::HasSubstr;

/// The table's sine RVA 0.2, RVF 0.1 says 2.768 mm; the converged border is 2.8549 (nodes 1, 1.5
/// and 2 times the usual agree to 1e-12 in ln ρ).
TEST(Planner, LimitDepthOfALaw) {
  PlanOptions options;
  options.try_steps = false;
  options.laws = {Law::sine};
  options.rva = {0.2};
  options.rvf = {0.1};
  options.most_growth = 30.0;
  options.most_depth_mm = 4.0;
  const Plan p = plan_at(all_steps(), 5000.0, 1.0, options);
  ASSERT_EQ(p.decision, PlanDecision::law);
  EXPECT_NEAR(p.chosen.modulation.rvf, 0.1, 1e-12);
  EXPECT_NEAR(*p.chosen.limit_depth_mm, 2.8549, 1e-4);
  EXPECT_NEAR(*p.chosen.peak_growth, 24.1, 0.5);
  EXPECT_EQ(*p.chosen.probability, 1.0);
  EXPECT_EQ(p.chosen.demand.written_ratio.size(), 9U);
}

TEST(Planner, WithoutTheGoodStepALawIsFound) {
  PlanOptions options;
  options.laws = {Law::triangle, Law::stop};
  const Plan p = plan_at(without_110(), 5000.0, 1.2, options);
  ASSERT_EQ(p.decision, PlanDecision::law);
  EXPECT_EQ(p.chosen.modulation.law, Law::triangle);
  EXPECT_DOUBLE_EQ(p.chosen.modulation.rva, 0.2);  // smaller ones miss a step at 110 %
  EXPECT_GT(*p.chosen.limit_depth_mm, 1.2);
  EXPECT_GE(*p.chosen.probability, 0.95);
  EXPECT_LE(*p.chosen.peak_growth, 20.0);
  EXPECT_THAT(all_reasons(p), HasSubstr("gets no nearer than 5 %"));
}

TEST(Planner, AWeakDriveGetsASlowerLawOrNone) {
  PlanOptions options;
  options.laws = {Law::triangle};
  options.rva = {0.2};
  options.least_rvf = 0.05;
  Machine m = without_110();
  const double strong = plan_at(m, 5000.0, 1.2, options).chosen.modulation.rvf;
  // Exactly what RVA 0.2 at RVF 0.12 needs; below, what RVF 0.04 needs, slower than least_rvf.
  m.spindle.acceleration_rev_s2 = 0.2 * 0.12 * 5000.0 * 5000.0 / 15.0 / 60.0;
  const Plan slower = plan_at(m, 5000.0, 1.2, options);
  EXPECT_EQ(slower.decision, PlanDecision::law);
  EXPECT_LE(slower.chosen.modulation.rvf, 0.12);
  EXPECT_LT(slower.chosen.modulation.rvf, strong);
  m.spindle.acceleration_rev_s2 = 0.2 * 0.04 * 5000.0 * 5000.0 / 15.0 / 60.0;
  const Plan none = plan_at(m, 5000.0, 1.2, options);
  EXPECT_EQ(none.decision, PlanDecision::nothing);
  EXPECT_THAT(all_reasons(none), HasSubstr("the drive delivers 13333 rpm/s (RVF 0.04 at most)"));
}

/// Stable by its radius, yet a vibration grows a hundred-thousandfold on the way.
TEST(Planner, GrowthKeepsSlowLawsOut) {
  PlanOptions options;
  options.try_steps = false;
  options.laws = {Law::triangle};
  options.rva = {0.2};
  options.rvf = {0.01};
  const Plan p = plan_at(all_steps(), 5000.0, 1.0, options);
  EXPECT_EQ(p.decision, PlanDecision::nothing);
  const Alternative& slow = p.alternatives.back();
  // ρ of 2e-27 over the period, in the reference, and yet a growth of 1.3e5 on the way.
  EXPECT_TRUE(slow.stable);
  EXPECT_GT(*slow.peak_growth, 1e3);
  EXPECT_TRUE(slow.growth_is_lower_bound);
  EXPECT_THAT(all_reasons(p), HasSubstr("grows at least"));
}

/// Steps of 10 %: the triangle has ln ρ −14.3 in a period, the staircase dwells where it is
/// unstable.
TEST(Planner, ALawThatIsUnstableAsTheOverrideWritesItIsRefused) {
  PlanOptions options;
  options.try_steps = false;
  options.laws = {Law::triangle};
  options.rva = {0.2};
  options.rvf = {0.0625};
  options.uncertainty.samples = kSanitized ? 2 : options.uncertainty.samples;
  const Plan coarse = plan_at(light_spindle({80, 90, 100, 110, 120}), 4000.0, 0.8, options);
  EXPECT_EQ(coarse.decision, PlanDecision::nothing);
  const Alternative& law = coarse.alternatives.back();
  EXPECT_TRUE(law.stable);
  EXPECT_LT(*law.log_radius, -10.0);
  EXPECT_GT(*law.written_log_radius, 1.0);
  EXPECT_THAT(all_reasons(coarse), HasSubstr("but unstable as the override writes it"));
  const Plan fine = plan_at(all_steps(), 4000.0, 0.8, options);
  ASSERT_EQ(fine.decision, PlanDecision::law);
  EXPECT_LT(*fine.chosen.written_log_radius, 0.0);
}

TEST(Planner, LawsAloneThatDoNotHelpNameTheStepThatDoes) {
  PlanOptions options;
  options.try_steps = false;
  options.laws = {Law::square};
  options.rva = {0.05};
  options.rvf = {0.05};
  const Plan p = plan_at(all_steps(), 5000.0, 1.0, options);
  EXPECT_EQ(p.decision, PlanDecision::nothing);
  ASSERT_TRUE(p.helping_ratio.has_value());
  EXPECT_DOUBLE_EQ(*p.helping_ratio, 1.1);
  EXPECT_THAT(p.notes.at(0), HasSubstr("no law helps at 1 mm; a constant 110 % does"));
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
