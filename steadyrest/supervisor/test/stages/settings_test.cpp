// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/supervisor/settings.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

namespace machine = kernel::machine;

/// A machine file in which no two figures are alike: any mix-up shows.
machine::Machine unlike() {
  machine::Machine out = test::mill(machine::Mode::act);
  out.envelope = {.min_feed_ratio = 0.11,
                  .max_feed_ratio = 1.12,
                  .feed_fall_1_s = 13.0,
                  .feed_rise_1_s = 1.4,
                  .min_spindle_ratio = 0.55,
                  .max_spindle_ratio = 1.16,
                  .spindle_slew_1_s = 1.7,
                  .max_offset_mm = 0.18,
                  .offset_slew_mm_s = 0.019,
                  .stale_after_s = 0.2};
  return out;
}

TEST(Settings, TheFeedFallsAndRisesByItsOwnLimits) {
  const auto config = feed_config(unlike(), test::kAll);
  EXPECT_EQ(config.table.ratio, unlike().feed_override.ratio);
  EXPECT_EQ(config.min_ratio, 0.11);
  EXPECT_EQ(config.max_ratio, 1.12);
  EXPECT_EQ(config.fall_1_s, 13.0);
  EXPECT_EQ(config.rise_1_s, 1.4);
}

// A drive works as hard at slowing down as at speeding up.
TEST(Settings, TheSpindleHasOneSlewForBothWays) {
  const auto config = spindle_config(unlike(), test::kAll);
  EXPECT_EQ(config.table.ratio, unlike().spindle_override.ratio);
  EXPECT_EQ(config.min_ratio, 0.55);
  EXPECT_EQ(config.max_ratio, 1.16);
  EXPECT_EQ(config.fall_1_s, 1.7);
  EXPECT_EQ(config.rise_1_s, 1.7);
}

// Beyond the watchdog's time the machine has dropped the word: no slew gets more credit than that.
TEST(Settings, NoSlewHasCreditBeyondTheWatchdogsTime) {
  EXPECT_EQ(feed_config(unlike(), test::kAll).max_step_s, 0.2);
  EXPECT_EQ(spindle_config(unlike(), test::kAll).max_step_s, 0.2);
  EXPECT_EQ(offset_config(unlike(), true).max_step_s, 0.2);
}

// Each capability switches off one thing and no other.
TEST(Settings, ThePortSaysWhichOverrideItCanWriteAndHow) {
  for (const bool feed : {true, false}) {
    for (const bool latched : {true, false}) {
      const kernel::port::Capability port{
          .feed_override = feed, .spindle_override = !feed, .latched_word = latched};
      EXPECT_EQ(feed_config(unlike(), port).available, feed);
      EXPECT_EQ(spindle_config(unlike(), port).available, !feed);
      EXPECT_EQ(feed_config(unlike(), port).latched, latched);
      EXPECT_EQ(spindle_config(unlike(), port).latched, latched);
    }
  }
}

// 0.18 mm at 0.019 mm/s are 9.5 s; 256 positions of 50 ms 12.9 s, after 1.2 / 1.4 s of slew; a
// spindle of 0.01 1/s takes two minutes.
TEST(Settings, TheLongestHandBackIsTheLongestOfAllWays) {
  auto wired = unlike();
  EXPECT_NEAR(longest_hand_back_s(wired), 1.0 + 0.2 + 0.18 / 0.019, 1e-9);
  wired.feed_override.ratio.assign(256, 1.2);
  wired.feed_override.scan_period_s = 0.05;
  EXPECT_NEAR(longest_hand_back_s(wired), 1.2 / 1.4 + 258 * 0.05, 1e-9);
  wired.envelope.spindle_slew_1_s = 0.01;
  EXPECT_NEAR(longest_hand_back_s(wired), 1.2 / 0.01 + 17 * 0.01, 1e-9);
}

// Together they keep the limit of the path's offset, so heat moves no faster than that gives way.
TEST(Settings, HeatMovesNoFasterThanThePathsOffset) {
  auto slow = unlike();
  slow.envelope.path_offset_slew_mm_s = 0.007;
  EXPECT_EQ(offset_config(slow, true).slew_mm_s, 0.007);
}

TEST(Settings, OffsetsGoToLinearAxesAlone) {
  const auto config = offset_config(unlike(), true);
  EXPECT_EQ(config.slew_mm_s, 0.019);
  for (std::size_t axis = 0; axis < config.max_mm.size(); ++axis) {
    EXPECT_EQ(config.max_mm[axis], axis < 3 ? 0.18 : 0.0) << "axis " << axis;
  }
  EXPECT_EQ(offset_config(unlike(), false).max_mm, kernel::signal::AxisValues{});
}

TEST(Settings, AMachineOfMoreAxesThanACommandHoldsFillsTheCommand) {
  machine::Machine many = unlike();
  many.axes.assign(12, machine::Axis{});
  const auto config = offset_config(many, true);
  for (const double max_mm : config.max_mm) {
    EXPECT_EQ(max_mm, 0.18);
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
