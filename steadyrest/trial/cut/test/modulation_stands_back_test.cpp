// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/trial/cut/test/modulated_slot.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Motion;
using test::in_slot;
using test::kSpeed_rev_s;
using test::mill;
using test::play;
using test::slot;

// Modal like M3: from M38 to M39 and nowhere else.
TEST(Modulation, WithoutItsMWordAndAfterM39TheSpindleStandsStill) {
  for (const auto& s : in_slot(play(mill(), slot("", "")))) {
    ASSERT_FALSE(s.command.spindle_masks_panel);
    ASSERT_NEAR(s.true_rev_s, kSpeed_rev_s, 1e-6);
  }
  const auto all = play(mill(), slot());
  const auto& last = all[all.size() - 200];
  ASSERT_EQ(last.frame.motion, Motion::feed);
  EXPECT_FALSE(last.frame.speed_modulation);
  EXPECT_FALSE(last.command.spindle_masks_panel);
  EXPECT_FALSE(last.command.feed_masks_panel);
  EXPECT_NEAR(last.true_rev_s, kSpeed_rev_s, 1e-6);
}

TEST(Modulation, OnlyTheCutIsModulated) {
  for (const auto& s : play(mill(), slot())) {
    if (s.frame.motion != Motion::feed && s.frame.path_position_mm == 0.0) {
      ASSERT_FALSE(s.command.spindle_masks_panel);
      ASSERT_FALSE(kernel::override::is_wish(s.modulator.spindle.reason));
    }
  }
}

// The operator's 0 applies to the feed; the spindle must not stop in the cut.
TEST(Modulation, ThePanelAtZeroStopsTheFeedAndTheSpindleGoesOnWithinItsSwitch) {
  // Feed switch to 0 % at 6 s: code of the table's first step.
  const auto samples = play(
      mill(), slot(), {{.time_s = 6.0, .act = sim::OperatorAct::turn_feed, .code = 0b00001}}, 9.0);
  for (const auto& s : samples) {
    if (s.frame.time_s > 6.5) {
      ASSERT_EQ(s.frame.path_speed_mm_s, 0.0);
      ASSERT_EQ(s.command.feed_ratio, 0.0);
    }
  }
}

// To the bit: any change of speed spoils a thread.
TEST(Modulation, TappingAndThreadingWithdrawIt) {
  auto m = mill();
  m.chatter.m_code_on = m.chatter.m_code_off = 0;
  const std::string program =
      "G21 G90 G94 S3000 M3\nG0 X0 Y0 Z0\nG1 X60 F1000\nG95\nG33 X100 K1\nG94\nG1 X150 F1000\nM2\n";
  std::size_t threading = 0;
  double first_rev_s = 0.0;
  for (const auto& s : play(m, program)) {
    if (s.frame.motion != Motion::thread) {
      continue;
    }
    ++threading;
    EXPECT_EQ(s.modulator.spindle.reason, Reason::withdrawn_thread);
    first_rev_s = threading == 200 ? s.true_rev_s : first_rev_s;
    if (threading > 200) {
      ASSERT_EQ(s.true_rev_s, first_rev_s) << "the spindle must not move in the thread";
    }
  }
  EXPECT_GT(threading, 300U);
}

}  // namespace
}  // namespace steadyrest::trial::cut
