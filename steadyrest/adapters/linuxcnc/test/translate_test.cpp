// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/test/fake_hal.hpp>
#include <steadyrest/adapters/linuxcnc/translate.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::signal::Command;
using kernel::signal::Motion;
using test::cutting;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Units kMillUnits{.servo_period_s = 0.001};

TEST(TranslateLinuxCnc, TakesTimeFromTheControlsOwnCount) {
  EXPECT_DOUBLE_EQ(frame_of(cutting(2500), kMillUnits).time_s, 2.5);
  EXPECT_EQ(frame_of(cutting(2500), kMillUnits).cycle, 2500U);
}

TEST(TranslateLinuxCnc, ConvertsInchesAndDegrees) {
  Units units = kMillUnits;
  units.linear_unit_mm = 25.4;
  units.rotary[1] = true;
  Sample sample = cutting(1);
  sample.axis[1].actual = 180.0;
  const auto frame = frame_of(sample, units);
  EXPECT_DOUBLE_EQ(frame.axis[0].command_mm, 254.0);
  EXPECT_DOUBLE_EQ(frame.axis[1].actual_mm, std::numbers::pi);
}

TEST(TranslateLinuxCnc, ShowsAFeedHoldAsTheBlockThatItHolds) {
  Sample sample = cutting(1);
  sample[Column::path_speed] = 0.0;
  sample[Column::feed_mm_s] = 0.0;
  const auto frame = frame_of(sample, kMillUnits);
  EXPECT_EQ(frame.motion, Motion::feed);
  EXPECT_EQ(frame.feed.effective_ratio, 0.0);
  sample[Column::enabled] = 0.0;
  EXPECT_EQ(frame_of(sample, kMillUnits).motion, Motion::idle);
}

TEST(TranslateLinuxCnc, NamesEachKindOfMotion) {
  const std::array<Motion, 9> expected{Motion::idle,  Motion::rapid,       Motion::feed,
                                       Motion::feed,  Motion::tool_change, Motion::probe,
                                       Motion::rapid, Motion::idle,        Motion::idle};
  for (std::size_t type = 0; type < expected.size(); ++type) {
    Sample sample = cutting(1);
    sample[Column::motion_type] = static_cast<double>(type);
    EXPECT_EQ(frame_of(sample, kMillUnits).motion, expected[type]) << type;
  }
  Sample sample = cutting(1);
  sample[Column::motion_type] = kNan;
  sample[Column::program_line] = kNan;
  EXPECT_EQ(frame_of(sample, kMillUnits).motion, Motion::idle);
  EXPECT_EQ(frame_of(sample, kMillUnits).program_line, 0U);
}

TEST(TranslateLinuxCnc, KnowsWhetherAProgramRuns) {
  using kernel::signal::ProgramState;
  Sample sample = cutting(1);
  EXPECT_EQ(frame_of(sample, kMillUnits).program, ProgramState::running);
  sample[Column::program_running] = 0.0;
  EXPECT_EQ(frame_of(sample, kMillUnits).program, ProgramState::stopped);
  sample[Column::program_paused] = 1.0;
  EXPECT_EQ(frame_of(sample, kMillUnits).program, ProgramState::paused);
  // A block typed by hand shows as running there.
  sample[Column::program_running] = 1.0;
  sample[Column::mode_auto] = 0.0;
  EXPECT_EQ(frame_of(sample, kMillUnits).program, ProgramState::stopped);
}

TEST(TranslateLinuxCnc, ShowsWhatIsInForceNotWhatWasWritten) {
  Sample sample = cutting(1);
  sample[Column::feed_panel] = 0.8;
  sample[Column::layer_feed] = 0.5;
  sample[Column::feed_mm_s] = 0.8 * 66.7;  // M52 P0: the layer is not let in
  EXPECT_NEAR(frame_of(sample, kMillUnits).feed.effective_ratio, 0.8, 1e-12);
  sample[Column::feed_mm_s] = 0.4 * 66.7;
  EXPECT_NEAR(frame_of(sample, kMillUnits).feed.effective_ratio, 0.4, 1e-12);
  sample[Column::feed_mm_s] = 0.5 * 66.7;  // M49: the panel is not let in
  EXPECT_NEAR(frame_of(sample, kMillUnits).feed.effective_ratio, 0.5, 1e-12);
}

// 3D_Chips.ngc has F4500000; the axes permit 200 mm/s, and the ratios multiply that.
TEST(TranslateLinuxCnc, AnFBeyondTheAxesTellsNoRatio) {
  Sample sample = cutting(1);
  sample[Column::requested_speed] = 200.0;
  sample[Column::layer_feed] = 0.25;
  sample[Column::feed_mm_s] = 75000.0 * 0.25;
  EXPECT_EQ(frame_of(sample, kMillUnits).feed.effective_ratio, 0.25);
  EXPECT_EQ(frame_of(sample, kMillUnits).programmed_feed_mm_s, 200.0);
}

TEST(TranslateLinuxCnc, SeparatesTheSpindlesProgramFromItsOverrides) {
  Sample sample = cutting(1);
  sample[Column::spindle_panel] = 0.8;
  sample[Column::layer_spindle] = 1.1;
  const auto frame = frame_of(sample, kMillUnits);
  EXPECT_DOUBLE_EQ(frame.spindle_programmed_rev_s, 125.0);
  EXPECT_DOUBLE_EQ(frame.spindle_command_rev_s, 110.0);
  EXPECT_DOUBLE_EQ(frame.spindle_actual_rev_s, 99.0);
  EXPECT_DOUBLE_EQ(frame.spindle.effective_ratio, 0.88);
}

TEST(TranslateLinuxCnc, LeavesWhatIsNotFiniteToTheSupervisor) {
  Sample sample = cutting(1);
  sample.axis[0].actual = kNan;
  EXPECT_TRUE(std::isnan(frame_of(sample, kMillUnits).axis[0].actual_mm));
}

TEST(FeedShare, TimesPanelIsTheLesserOfLayerAndPanel) {
  for (int layer = 0; layer <= 150; ++layer) {
    for (int panel = 1; panel <= 200; ++panel) {
      const double l = 0.01 * layer;
      const double p = 0.01 * panel;
      EXPECT_NEAR(p * feed_share(l, p), std::min(l, p), 1e-12);
    }
  }
}

// The panel turns from `read` to `acts` after the sample: the feed is the layer's times acts/read
// until the next sample, and never above the panel.
TEST(FeedShare, LeavesThePanelInChargeWhenItTurnsBetweenReadingAndActing) {
  for (const double read : {0.2, 0.5, 1.0, 1.5}) {
    for (const double acts : {0.0, 0.1, 0.5, 1.0, 2.0}) {
      const double in_force = acts * feed_share(0.4, read);
      EXPECT_LE(in_force, acts);
      if (read >= 0.4) {
        EXPECT_NEAR(in_force, 0.4 * acts / read, 1e-12);
      }
    }
  }
}

TEST(FeedShare, IsThatOfAFullPanelWhileThePanelIsAtZero) {
  EXPECT_EQ(feed_share(0.4, 0.0), 0.4);
  EXPECT_EQ(feed_share(0.0, 0.0), 0.0);
}

TEST(PinsOfLinuxCnc, FollowThePanelWithoutAMask) {
  const Command command{.feed_ratio = 0.3, .spindle_ratio = 0.9, .write = true};
  const Pins pins = pins_of(command, cutting(1), kMillUnits, {});
  EXPECT_EQ(pins.feed, kNoCeiling);
  EXPECT_EQ(pins.spindle, 1.0);
}

TEST(PinsOfLinuxCnc, CarryRatiosAndOffsets) {
  Command command{.feed_ratio = 0.3,
                  .feed_masks_panel = true,
                  .spindle_ratio = 1.2,
                  .spindle_masks_panel = true,
                  .write = true};
  command.offset_mm[2] = -0.0254;
  command.path_offset_mm[1] = std::numbers::pi;
  Sample sample = cutting(1);
  sample[Column::feed_panel] = 0.6;
  sample[Column::spindle_panel] = 0.8;
  Units units = kMillUnits;
  units.linear_unit_mm = 25.4;
  units.rotary[1] = true;
  const Pins pins = pins_of(command, sample, units, {});
  EXPECT_EQ(pins.feed, 0.3) << "the panel is the HAL's own business";
  EXPECT_NEAR(pins.spindle, 1.5, 1e-12);
  EXPECT_NEAR(pins.offset[2], -0.001, 1e-12);
  EXPECT_NEAR(pins.path_offset[1], 180.0, 1e-12);
}

TEST(PinsOfLinuxCnc, AreNeutralWhereTheCommandIsNotFinite) {
  Command command{.feed_ratio = kNan,
                  .feed_masks_panel = true,
                  .spindle_ratio = kNan,
                  .spindle_masks_panel = true,
                  .write = true};
  command.offset_mm[0] = kNan;
  command.path_offset_mm[0] = kNan;
  Pins before;
  before.offset[0] = 0.042;
  before.path_offset[0] = 0.1;
  const Pins pins = pins_of(command, cutting(1), kMillUnits, before);
  EXPECT_EQ(pins.feed, kNoCeiling);
  EXPECT_EQ(pins.spindle, 1.0);
  EXPECT_EQ(pins.offset[0], 0.042);
  EXPECT_EQ(pins.path_offset[0], 0.0);
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc
