// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/live/chatter_watch.hpp>
#include <steadyrest/supervisor/test/listening/chattering_cut.hpp>

namespace steadyrest::live {
namespace {

using kernel::machine::Mode;
using kernel::signal::Motion;
using supervisor::Supervisor;
using supervisor::test::ChatteringCut;

/// A watched layer on that cut.
class Cut {
 public:
  explicit Cut(Mode mode, bool acts = true)
      : layer_(Supervisor::make(ChatteringCut::machine(), ChatteringCut::kPort).value()) {
    layer_.set_mode(mode);
    EXPECT_TRUE(layer_.listen(ChatteringCut::listener(acts)));
  }

  /// What the watch says after so many seconds more.
  const LiveChatter& run(double seconds, Motion motion = Motion::feed) {
    cut_.move(motion);
    const LiveChatter* now = nullptr;
    for (int i = 0; i < static_cast<int>(seconds / ChatteringCut::kCycle_s); ++i) {
      cut_.obey(layer_.update(cut_.next()));
      now = &watch_.update(layer_, ChatteringCut::kCycle_s);
    }
    return *now;
  }

  Supervisor layer_;
  ChatteringCut cut_;
  ChatterWatch watch_;
};

TEST(ChatterWatch, KnowsHowLoudItWasBeforeTheLayerSteppedIn) {
  Cut cut(Mode::act);
  const LiveChatter quiet = cut.run(0.6);
  EXPECT_TRUE(quiet.listens);
  EXPECT_FALSE(quiet.chatters);
  EXPECT_EQ(quiet.events, 0U);
  EXPECT_EQ(quiet.before, 0.0);
  const LiveChatter after = cut.run(4.0);
  EXPECT_FALSE(after.chatters);
  EXPECT_EQ(after.events, 1U);
  EXPECT_DOUBLE_EQ(after.better_ratio, 0.9);
  EXPECT_GT(after.before, 0.5);
  EXPECT_LT(after.level, 0.1);
  EXPECT_GT(after.chatter_s, 0.05);
  EXPECT_LT(after.chatter_s, 3.0);
  EXPECT_DOUBLE_EQ(after.threshold, 0.25);
}

TEST(ChatterWatch, InAdviseItTellsTheBetterStepAndNoBefore) {
  Cut cut(Mode::advise);
  const LiveChatter now = cut.run(2.0);
  EXPECT_TRUE(now.chatters);
  EXPECT_NEAR(now.frequency_hz, 943.0, 10.0);
  EXPECT_DOUBLE_EQ(now.better_ratio, 0.9);
  EXPECT_EQ(now.before, 0.0);
}

TEST(ChatterWatch, OneThatOnlyHearsNeverAsks) {
  Cut cut(Mode::act, false);
  const LiveChatter now = cut.run(2.0);
  EXPECT_TRUE(now.chatters);
  EXPECT_EQ(now.better_ratio, 1.0);
  EXPECT_EQ(now.before, 0.0);
}

TEST(ChatterWatch, OutOfTheCutThereIsNoChatter) {
  Cut cut(Mode::observe);
  const LiveChatter in = cut.run(2.0);
  EXPECT_TRUE(in.chatters);
  const LiveChatter out = cut.run(1.0, Motion::rapid);
  EXPECT_FALSE(out.chatters);
  EXPECT_EQ(out.level, 0.0);
  EXPECT_GT(in.level, 0.5);
  EXPECT_EQ(out.events, 1U);
  EXPECT_NEAR(out.chatter_s, in.chatter_s, 1e-9);
}

TEST(ChatterWatch, SaysWhereTheLineIsAmongTheOrdersAndHowSureItIs) {
  Cut cut(Mode::observe);
  const LiveChatter quiet = cut.run(0.6);
  EXPECT_EQ(quiet.line.frequency_hz, 0.0);
  EXPECT_EQ(quiet.confidence, 0.0);
  const LiveChatter now = cut.run(1.5);
  ASSERT_TRUE(now.chatters);
  // 943 Hz at 80 1/s: 17 Hz below order 12.
  EXPECT_NEAR(now.line.frequency_hz, 943.0, 1.0);
  EXPECT_EQ(now.line.order, 12.0);
  EXPECT_NEAR(now.line.off_hz, -17.0, 1.0);
  EXPECT_GT(now.line.sd_hz, 0.0);
  EXPECT_LT(now.line.sd_hz, 2.0);
  EXPECT_FALSE(now.line.folded);
  EXPECT_FALSE(now.forced);
  EXPECT_GT(now.confidence, 0.95);
  EXPECT_LE(now.confidence, 1.0);
  EXPECT_EQ(now.mode_hz, 922.0);
  EXPECT_FALSE(now.clips);
  const LiveChatter out = cut.run(0.5, Motion::rapid);
  EXPECT_EQ(out.line.frequency_hz, 0.0);
  EXPECT_EQ(out.confidence, 0.0);
  EXPECT_EQ(out.mode_hz, 0.0);
}

TEST(ChatterWatch, AllocatesNothing) {
  Cut cut(Mode::act);
  cut.run(0.7);
  const kernel::rt::testing::AllocationGuard guard;
  cut.watch_.update(cut.layer_, ChatteringCut::kCycle_s);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::live
