// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/nc/interpret/state/move_table.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr double kQuarter = 0.5 * std::numbers::pi;
/// A quarter of a circle of radius 10 about the origin of a plane, `rise` along its normal.
Move quarter_arc(Plane plane, int turns, double rise) {
  const auto [first, second, normal] = axes_of(plane);
  Move move;
  move.kind = MoveKind::arc;
  move.start[first] = 10.0;
  move.end[second] = 10.0;
  move.end[normal] = rise;
  move.normal[normal] = 1.0;
  move.turns = turns;
  return move;
}

// A helix of angle φ is √((r·φ)² + h²) long. A quarter one way round is three the other.
TEST(PathLength, OfAnArcCountsItsTurnsAndItsRise) {
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz}) {
    const auto length = [&](int turns, double rise) {
      return path_length(quarter_arc(plane, turns, rise));
    };
    EXPECT_NEAR(length(1, 0.0), 10.0 * kQuarter, 1e-12);
    EXPECT_NEAR(length(-1, 0.0), 30.0 * kQuarter, 1e-12);
    EXPECT_NEAR(length(1, 7.0), std::hypot(10.0 * kQuarter, 7.0), 1e-12);
    EXPECT_NEAR(length(-2, 7.0), std::hypot(70.0 * kQuarter, 7.0), 1e-12);
  }
  Move circle = quarter_arc(Plane::xy, -1, 0.0);
  circle.end = circle.start;
  EXPECT_NEAR(path_length(circle), 40.0 * kQuarter, 1e-12);
}

// LinuxCNC: the feed is along X Y Z, without them along U V W, without them about A B C.
TEST(PathLength, OfALineIsOfTheAxesThatTheFeedRefersTo) {
  Move move;
  move.kind = MoveKind::linear;
  EXPECT_EQ(path_length(move), 0.0);
  move.end = {0.0, 0.0, 0.0, 2.0, 3.0, 6.0, 0.0, 0.0, 0.0};
  EXPECT_DOUBLE_EQ(path_length(move), 7.0);
  move.end[6] = 3.0;
  move.end[8] = 4.0;
  EXPECT_DOUBLE_EQ(path_length(move), 5.0);
  move.end[0] = 2.0;
  move.end[1] = -6.0;
  move.end[2] = 9.0;
  EXPECT_DOUBLE_EQ(path_length(move), 11.0);
  move.kind = MoveKind::dwell;
  EXPECT_EQ(path_length(move), 0.0);
}

TEST(MoveFeed, IsAlongThePathInEveryFeedMode) {
  Move move;
  move.kind = MoveKind::linear;
  move.end[0] = 40.0;
  move.feed_mm_s = 5.0;
  EXPECT_EQ(feed_mm_min(move), 300.0);
  move.feed_mode = FeedMode::inverse_time;
  move.feed_mm_s = 0.05;  // three moves a minute, of 40 mm each
  EXPECT_DOUBLE_EQ(feed_mm_min(move), 120.0);
  move.feed_mode = FeedMode::per_revolution;
  move.spindle_rev_s = -20.0;
  EXPECT_DOUBLE_EQ(feed_mm_min(move), 60.0);
  move.spindle_rev_s = 0.0;  // unknown at constant cutting speed
  EXPECT_EQ(feed_mm_min(move), 0.0);
}

TEST(MoveTable, HasARowForEachMoveWithItsCellsEmptyWhereTheyMeanNothing) {
  const kernel::file::testing::OwnFolder folder;
  auto out = kernel::file::OutputFile::open(folder.at("moves.csv"));
  ASSERT_TRUE(out);
  MoveTable table(*out);
  Move rapid;
  rapid.line = 3;
  rapid.end = {1.5, -0.0, 0.1, 90.0};
  table.on_move(rapid);
  Move arc = quarter_arc(Plane::xy, -2, 0.0);
  arc.line = 12;
  arc.feed_mm_s = 100.0 / 60.0;  // F100 is written again as 100
  table.on_move(arc);
  table.finish();
  ASSERT_TRUE(out->commit());
  EXPECT_EQ(kernel::file::testing::text_of_file(folder.at("moves.csv")),
            std::string{MoveTable::kHead} +
                "3,rapid,1.5,0,0.1,90,0,0,,,,,\n12,arc,0,10,0,0,0,0,100,0,0,0,-2\n");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
