// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
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

const Process kSlot = benchmark_cut(1.0, Direction::up);

Plan plan_at(const Machine& machine, double rpm, double depth_mm, const PlanOptions& options = {}) {
  auto made = plan(kSlot, machine, rpm / 60.0, depth_mm, options);
  EXPECT_TRUE(made.has_value());
  return made.value_or(Plan{});
}

Machine all_steps() {
  return light_spindle({50, 55, 60, 65, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120});
}

/// The step into the pocket at 5500 rpm is missing.
Machine without_110() {
  return light_spindle({80, 85, 90, 95, 100, 105, 115, 120});
}

std::string all_reasons(const Plan& plan) {
  std::string out;
  for (const Alternative& a : plan.alternatives) {
    for (const std::string& reason : a.reasons) {
      out += reason + "\n";
    }
  }
  return out;
}

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
  // 90 % is stable by the figures as they are given and not surely so: a yes would not tell.
  EXPECT_NEAR(*p.alternatives[8].limit_depth_mm, 1.2254, 1e-3);
  EXPECT_TRUE(p.alternatives[8].stable);
  EXPECT_FALSE(p.alternatives[8].accepted());
  EXPECT_GT(*p.alternatives[8].probability, 0.5);
  EXPECT_LT(*p.alternatives[8].probability, 0.95);
  EXPECT_NEAR(*p.chatter_frequency_hz, 960.0, 40.0);
}

// 5500 rpm carries 2.76 mm: any change would be for nothing.
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
  // Just what RVA 0.2 at RVF 0.12 takes; below, what RVF 0.04 takes, slower than least_rvf.
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

/// Stable by its radius, and a vibration grows a hundred-thousandfold on the way.
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

// Threads share the possible cuts; their order must not show in the answer.
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

/// Each n-th part of a normal distribution once: the mean and variance of 64 samples are near to
/// exact.
TEST(Uncertainty, SamplesAreALatinHypercube) {
  const Uncertainty of{.frequency = 0.01, .damping = 0.2, .coefficients = 0.1, .samples = 64};
  const auto cuts = possible_cuts(kSlot, of);
  ASSERT_EQ(cuts.size(), 64U);
  double mean = 0.0;
  double square = 0.0;
  for (const Process& cut : cuts) {
    const double g = (cut.modes[0].frequency_hz / 922.0 - 1.0) / 0.01;
    mean += g / 64.0;
    square += g * g / 64.0;
    // The stiffness stays.
    EXPECT_NEAR(cut.modes[0].mass_kg * cut.modes[0].frequency_hz * cut.modes[0].frequency_hz,
                0.03993 * 922.0 * 922.0, 1e-6);
  }
  EXPECT_NEAR(mean, 0.0, 0.02);
  EXPECT_NEAR(square, 1.0, 0.1);
  EXPECT_EQ(possible_cuts(kSlot, of)[7].cut.radial_n_mm2, cuts[7].cut.radial_n_mm2);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
