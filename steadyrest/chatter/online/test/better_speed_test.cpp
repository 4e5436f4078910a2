// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/better_speed.hpp>
#include <steadyrest/chatter/online/test/cut_signal.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::chatter::online::test {
namespace {

using kernel::outcome::Reason;

constexpr double kProgrammed = 5000.0 / 60.0;

/// The slot of the reference: 0.4086 mm at 5000 rpm, 2.765 mm at 5500.
CutSignal slot_signal(double depth_mm) {
  CutModel m;
  m.depth_mm = depth_mm;
  m.frequency_hz = {922.0, 922.0};
  m.damping_ratio = {0.011, 0.011};
  m.stiffness_n_mm = {1340.05, 1e7};
  m.air_s = 0.2;
  return simulate(m, 1.0);
}

BetterSpeed::Config config(double max_ratio) {
  return {.detector = {},
          // Limit depths of the slot at 90, 100, 110 and 120 % of 5000 rpm, from the reference's
          // table.
          .table = {.speed_rev_s = {75.0, kProgrammed, 1.1 * kProgrammed, 100.0},
                    .limit_depth_mm = {1.2254, 0.4086, 2.7653, 0.3532},
                    .step_ratio = {0.9, 0.95, 1.0, 1.05, 1.1, 1.15},
                    .max_ratio = max_ratio}};
}

BetterSpeed::Output last_output(BetterSpeed& better, const CutSignal& signal, double programmed) {
  BetterSpeed::Output out;
  const kernel::rt::testing::AllocationGuard guard;
  for (std::size_t i = 0; i < signal.value.size(); ++i) {
    out = better.update({.value = signal.value[i],
                         .speed_rev_s = signal.speed_rev_s[i],
                         .programmed_rev_s = programmed,
                         // Above the border at 5000 rpm, well below the one at 5500: one step to
                         // the side is the right answer.
                         .depth_mm = 0.6});
    if (!out.chatter && out.reason != Reason::chatter_better_speed) {
      EXPECT_EQ(out.request.reason, Reason::none);
      EXPECT_EQ(out.request.ratio, 1.0);
    }
  }
  return out;
}

TEST(BetterSpeed, AsksForTheTablesStepOnceTheCutChatters) {
  auto better = BetterSpeed::make(config(1.2));
  ASSERT_TRUE(better);
  const auto out = last_output(*better, slot_signal(0.6), kProgrammed);
  EXPECT_TRUE(out.chatter);
  EXPECT_EQ(out.reason, Reason::chatter_better_speed);
  EXPECT_EQ(out.request.reason, Reason::chatter_better_speed);
  EXPECT_EQ(out.request.room, kernel::signal::Room::chatter);
  EXPECT_NE(out.request.ratio, 1.0);
}

// 0.25 mm, six tenths of the border.
TEST(BetterSpeed, IsNeutralInAStableCut) {
  auto better = BetterSpeed::make(config(1.2));
  ASSERT_TRUE(better);
  const auto out = last_output(*better, slot_signal(0.25), kProgrammed);
  EXPECT_FALSE(out.chatter);
  EXPECT_EQ(out.request.ratio, 1.0);
  EXPECT_EQ(out.request.reason, Reason::none);
}

// 98 to 100 % allows only the present step: the cut chatters, and no request may pretend otherwise.
TEST(BetterSpeed, SaysWhenNoStepIsBetter) {
  BetterSpeed::Config none = config(1.0);
  none.table.min_ratio = 0.98;
  auto better = BetterSpeed::make(none);
  ASSERT_TRUE(better);
  const auto out = last_output(*better, slot_signal(0.6), kProgrammed);
  EXPECT_TRUE(out.chatter);
  EXPECT_EQ(out.reason, Reason::chatter_no_better_speed);
  EXPECT_EQ(out.request.ratio, 1.0);
}

// The step is written and the line stays as it was, so the operator's speed is just as good.
TEST(BetterSpeed, TakesBackAStepThatDoesNotHelp) {
  BetterSpeed::Config once = config(1.2);
  once.again_s = 0.2;
  once.table.step_ratio = {1.0, 1.1};
  auto better = BetterSpeed::make(once);
  ASSERT_TRUE(better);
  const CutSignal signal = slot_signal(0.6);
  double ratio = 1.0;
  int changes = 0;
  BetterSpeed::Output out;
  for (std::size_t i = 0; i < signal.value.size(); ++i) {
    out = better->update({.value = signal.value[i],
                          .speed_rev_s = signal.speed_rev_s[i],
                          .programmed_rev_s = kProgrammed,
                          .ratio = ratio,
                          .depth_mm = 0.6});
    changes += out.request.ratio != ratio ? 1 : 0;
    ratio = out.request.ratio;
  }
  EXPECT_TRUE(out.chatter);
  EXPECT_EQ(changes, 2) << "there and back";
  EXPECT_EQ(out.request.ratio, 1.0);
  EXPECT_EQ(out.reason, Reason::chatter_no_better_speed);
}

// 110 % of another speed would be a speed that was never queried.
TEST(BetterSpeed, DropsTheAnswerWithTheNextProgrammedSpeed) {
  auto better = BetterSpeed::make(config(1.2));
  ASSERT_TRUE(better);
  ASSERT_NE(last_output(*better, slot_signal(0.6), kProgrammed).request.ratio, 1.0);
  const auto& out = better->update(
      {.value = 0.0, .speed_rev_s = kProgrammed, .programmed_rev_s = 1.05 * kProgrammed});
  EXPECT_EQ(out.request.ratio, 1.0);
  EXPECT_EQ(out.request.reason, Reason::none);
}

// What rounding an S word in rpm changes is the same cut; the steps of a switch are 5 % apart.
TEST(BetterSpeed, KeepsTheAnswerWhereTheProgrammedSpeedChangesByLessThanAPercent) {
  auto better = BetterSpeed::make(config(1.2));
  ASSERT_TRUE(better);
  const double ratio = last_output(*better, slot_signal(0.6), kProgrammed).request.ratio;
  ASSERT_NE(ratio, 1.0);
  const auto ratio_at = [&](double change) {
    return better
        ->update({.speed_rev_s = kProgrammed, .programmed_rev_s = (1.0 + change) * kProgrammed})
        .request.ratio;
  };
  EXPECT_EQ(ratio_at(0.007), ratio);
  EXPECT_EQ(ratio_at(0.014), 1.0);
}

// Its own setting, the detector's and the table's: each must come through make().
TEST(BetterSpeed, RefusesWhatIsOutOfRange) {
  BetterSpeed::Config bad = config(1.2);
  bad.again_s = 0.0;
  EXPECT_FALSE(BetterSpeed::make(bad));
  bad = config(1.2);
  bad.detector.teeth = 0;
  EXPECT_FALSE(BetterSpeed::make(bad));
  bad = config(1.2);
  bad.table.step_ratio.clear();
  EXPECT_FALSE(BetterSpeed::make(bad));
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
