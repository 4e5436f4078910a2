// SPDX-License-Identifier: Apache-2.0
// The modulator on the simulated machine, from the program's M words to the spindle's true speed.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/trial/cut/test/modulated_slot.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::signal::Motion;
using test::in_slot;
using test::kSpeed_rev_s;
using test::mill;
using test::Moment;
using test::play;
using test::slot;

struct Band {
  double low = 1e9;
  double high = -1e9;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Band speeds(const std::vector<Moment>& samples) {
  Band band;
  for (const auto& s : samples) {
    band.take(s.true_rev_s / kSpeed_rev_s);
  }
  return band;
}

// ± 5 of 50 rev/s are 90 … 110 %. The word moves in steps of 5 %; the drive's ramp rounds them off.
TEST(Modulation, TheSpindleFollowsTheTriangleWithinWhatItsDriveCan) {
  const auto samples = in_slot(play(mill(), slot()));
  ASSERT_GT(samples.size(), 5000U);
  const Band band = speeds(samples);
  EXPECT_NEAR(band.low, 0.90, 0.002);
  EXPECT_NEAR(band.high, 1.10, 0.002);
  double worst = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double change = samples[i].true_rev_s - samples[i - 1].true_rev_s;
    EXPECT_LE(std::abs(change), 50.0 * 0.001 + 1e-9);
    worst = std::max(worst,
                     std::abs(samples[i].true_rev_s / kSpeed_rev_s - samples[i].modulator.ratio));
  }
  // One step of 5 %, one scan of the walk, and the feed that the spindle waits for.
  EXPECT_LT(worst, 0.075);
  EXPECT_GT(worst, 0.02) << "the steps must show";
}

// At 90 % of the speed and full feed each tooth would take 1/0.9 = 111 %; the band allows 105 %,
// so the feed must go down to 94.5 %.
TEST(Modulation, TheFeedPerToothStaysInItsBand) {
  Band band;
  double lowest_feed = 1.0;
  for (const auto& s : in_slot(play(mill(), slot()))) {
    const double feed = s.frame.path_speed_mm_s / s.frame.programmed_feed_mm_s;
    band.take(feed / (s.true_rev_s / kSpeed_rev_s));
    lowest_feed = std::min(lowest_feed, feed);
  }
  EXPECT_LE(band.high, 1.05 + 1e-3);
  EXPECT_GE(band.low, 0.80 - 1e-3);
  EXPECT_LT(lowest_feed, 0.96) << "without the feed 90 % speed would be 111 % per tooth";
}

TEST(Modulation, WithoutAnMWordInTheMachineFileItIsAlwaysOn) {
  auto m = mill();
  m.chatter.m_code_on = m.chatter.m_code_off = 0;
  EXPECT_NEAR(speeds(in_slot(play(m, slot("", "")))).high, 1.10, 0.002);
}

// Without the right to exceed the panel, the swing of ± 20 % must fit below 80 %.
TEST(Modulation, AnOperatorsLowerSwitchWins) {
  auto m = mill();
  m.spindle_override.layer_may_exceed_panel = false;
  // 80 % on the spindle's switch: step 6, Gray code of 7.
  const auto samples = play(
      m, slot(), {{.time_s = 4.0, .act = sim::OperatorAct::turn_spindle, .code = 0b00100}}, 12.0);
  Band band;
  for (const auto& s : samples) {
    if (s.frame.time_s > 5.5 && s.frame.motion == Motion::feed) {
      band.take(s.true_rev_s / kSpeed_rev_s);
    }
  }
  EXPECT_LE(band.high, 0.80 + 1e-6);
  EXPECT_NEAR(band.low, 0.60, 0.01) << "the whole swing moved down";
}

// In G95 the control itself keeps the feed per tooth; a second correction would be too much.
TEST(Modulation, FeedPerRevolutionFollowsTheSpindleByItself) {
  const auto samples =
      in_slot(play(mill(), "G21 G90 G95 S3000 M3\nG0 X0 Y0 Z0\nM38\nG1 X300 F0.333\nM2\n"));
  for (const auto& s : samples) {
    ASSERT_FALSE(s.command.feed_masks_panel);
  }
  EXPECT_NEAR(speeds(samples).low, 0.90, 0.002);
}

}  // namespace
}  // namespace steadyrest::trial::cut
