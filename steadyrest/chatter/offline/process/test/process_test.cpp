// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/process/process.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Process milled(Direction direction, double immersion) {
  Process p;
  p.cut.direction = direction;
  p.cut.radial_immersion = immersion;
  return p;
}

// With the feed along x and φ from the y axis, a tip is R·(1 − cos φ) deep in the work: a quarter
// of the diameter at 60°, half at 90°.
TEST(ProcessAngles, UpMillingEntersWithoutAChip) {
  for (const auto& [immersion, exit_deg] : {std::pair{0.25, 60.0}, std::pair{0.5, 90.0},
                                            std::pair{0.75, 120.0}, std::pair{1.0, 180.0}}) {
    const Process up = milled(Direction::up, immersion);
    EXPECT_EQ(up.entry_rad(), 0.0);
    EXPECT_NEAR(up.exit_rad(), exit_deg * kDegree, 1e-12) << immersion;
    EXPECT_NEAR(0.5 * (1.0 - std::cos(up.exit_rad())), immersion, 1e-12);
  }
}

TEST(ProcessAngles, DownMillingIsUpMillingMirrored) {
  for (const double immersion : {0.01, 0.25, 0.4, 0.75, 1.0}) {
    const Process up = milled(Direction::up, immersion);
    const Process down = milled(Direction::down, immersion);
    EXPECT_NEAR(down.exit_rad(), std::numbers::pi, 1e-15) << "leaves without a chip";
    EXPECT_NEAR(down.entry_rad(), std::numbers::pi - up.exit_rad(), 1e-12) << immersion;
  }
  EXPECT_NEAR(milled(Direction::down, 0.25).entry_rad(), 120.0 * kDegree, 1e-12);
}

TEST(ProcessAngles, ASlotIsTheSameInBothDirections) {
  const Process up = milled(Direction::up, 1.0);
  const Process down = milled(Direction::down, 1.0);
  EXPECT_NEAR(up.entry_rad(), down.entry_rad(), 1e-12);
  EXPECT_NEAR(up.exit_rad(), down.exit_rad(), 1e-12);
}

TEST(ProcessAngles, ATurningToolNeverLeavesTheCut) {
  Process turning = milled(Direction::down, 0.25);
  turning.cut.operation = Operation::turning;
  EXPECT_EQ(turning.entry_rad(), 0.0);
  EXPECT_NEAR(turning.exit_rad(), 360.0 * kDegree, 1e-12);
}

TEST(ProcessPitch, IsEvenUntilAToothIsElsewhere) {
  Process p = milled(Direction::up, 1.0);
  p.tool.teeth = 4;
  EXPECT_TRUE(p.even_pitch());
  EXPECT_NEAR(p.pitch_rad(3), 90.0 * kDegree, 1e-15);
  p.tool.pitch_rad = {90 * kDegree, 90 * kDegree, 90 * kDegree, 90 * kDegree};
  EXPECT_TRUE(p.even_pitch()) << "even, though listed";
  p.tool.pitch_rad = {70 * kDegree, 110 * kDegree, 70 * kDegree, 110 * kDegree};
  EXPECT_FALSE(p.even_pitch());
  EXPECT_NEAR(p.pitch_rad(1), 110.0 * kDegree, 1e-15);
  EXPECT_NEAR(p.pitch_rad(2), 70.0 * kDegree, 1e-15);
}

}  // namespace
}  // namespace steadyrest::chatter::offline
