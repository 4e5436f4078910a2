// SPDX-License-Identifier: Apache-2.0
// A scale fails and shows the same position for ever; or the whole control does, stamps included.
#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Frame;

constexpr std::size_t kFrozen = 1000;
constexpr std::size_t kThaws = 1500;

TEST(FeedbackFrozen, AScaleThatStandsSlowsTheFeedToItsFloor) {
  Stage stage;
  double stands_mm = 0.0;
  stage.show = [&stands_mm](std::size_t cycle, Frame& frame) {
    if (cycle == kFrozen) {
      stands_mm = frame.axis[0].actual_mm;
    }
    if (cycle >= kFrozen && cycle < kThaws) {
      frame.axis[0].actual_mm = stands_mm;
      frame.axis[0].following_error_mm = frame.axis[0].command_mm - stands_mm;
    }
  };
  stage.run(2500);
  EXPECT_LE(stage.log()[kThaws - 1].feed_ratio(), stage.machine().contour.min_ratio + 1e-9);
  EXPECT_GT(stage.named(Reason::contour_feed_floor, kFrozen, kThaws), 100U);
  EXPECT_GT(stage.log()[2499].feed_ratio(), stage.machine().contour.min_ratio);
}

/// The machine's watchdog is 0.2 s = 50 cycles: so long a standing stamp is a glitch, then the
/// source is dead and the layer falls silent, so that the watchdog hands back.
TEST(FeedbackFrozen, AControlThatStandsIsStaleAndGetsNothingMore) {
  Stage stage;
  Frame stands;
  stage.show = [&stands](std::size_t cycle, Frame& frame) {
    if (cycle == kFrozen) {
      stands = frame;
      stands.path = {};
    }
    if (cycle >= kFrozen && cycle < kThaws) {
      frame = stands;
    }
  };
  stage.run(2500);
  const auto& log = stage.log();
  EXPECT_EQ(stage.largest_rise(kFrozen, kFrozen + 40), 0.0);
  for (std::size_t i = kFrozen + 55; i < kThaws; ++i) {
    ASSERT_FALSE(log[i].written) << i;
    ASSERT_EQ(log[i].status.reasons[0], Reason::input_stale) << i;
  }
  std::size_t first = kThaws;
  while (!log[first].written) {
    ++first;
  }
  EXPECT_LE(first, kThaws + 3);
  EXPECT_FALSE(log[first].masks()) << "the watchdog has dropped it";
  EXPECT_LT(log[2499].feed_ratio(), 0.6) << "it corrects again";
}

}  // namespace
}  // namespace steadyrest::scenarios
