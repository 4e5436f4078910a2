// SPDX-License-Identifier: Apache-2.0
// What a new move may change: its path, its feed and its speed as far as is permitted, and
// nothing else.
#include <functional>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/fresh_move.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Move;
using interpret::MoveKind;
using test::made_arc;
using test::made_line;
using ::testing::HasSubstr;
using Spoils = std::function<void(Move&)>;

Move turning_cut() {
  Move block = made_line({0, 0, 0}, {10, 0, 0}, 10.0);
  block.spindle_rev_s = 50.0;
  return block;
}

TEST(FreshMove, MayHaveAnotherPath) {
  Move arc = made_arc({3, 4, 5}, {6, 4, 5}, {4.5, 4, 5}, -1);
  arc.spindle_rev_s = 50.0;
  EXPECT_EQ(fresh_move_difference({.path = true}, turning_cut(), arc), "");
  EXPECT_EQ(fresh_move_difference({.path = true}, arc, turning_cut()), "");
}

TEST(FreshMove, MayHaveNothingElseOfItsOwn) {
  const std::pair<const char*, Spoils> cases[] = {
      {"does not cut", [](Move& m) { m.kind = MoveKind::rapid; }},
      {"does not cut", [](Move& m) { m.kind = MoveKind::spline; }},
      {"does not cut", [](Move& m) { m.kind = MoveKind::dwell; }},
      {"a feed of another kind", [](Move& m) { m.feed_mode = interpret::FeedMode::inverse_time; }},
      {"a feed of 0 mm/min", [](Move& m) { m.feed_mm_s = 0.0; }},
      {"the spindle turns at 3060 rpm", [](Move& m) { m.spindle_rev_s = 51.0; }},
      {"beyond X, Y and Z", [](Move& m) { m.end[3] = 1e-6; }},
      {"beyond X, Y and Z", [](Move& m) { m.start[8] = m.end[8] = 1.0; }},
      {"in its offset", [](Move& m) { m.offset[2] = 0.001; }},
      {"in its offset", [](Move& m) { m.machine_axes = 4; }},
      {"in its rotation", [](Move& m) { m.rotation_deg = 1.0; }},
      {"in its path mode", [](Move& m) { m.path_tolerance_mm = 0.02; }},
      {"in its spindle speed", [](Move& m) { m.speed_modulation = true; }},
      {"in its override lock", [](Move& m) { m.override_locked = true; }}};
  for (const auto& [what, spoil] : cases) {
    Move move = turning_cut();
    spoil(move);
    EXPECT_THAT(fresh_move_difference({.path = true}, turning_cut(), move), HasSubstr(what));
  }
}

// README and permitted.hpp: 0.2 to 2 times the block's F where the path is changed, at most F for
// feeds, in proportion to the spindle for speeds.
TEST(FreshMove, HasAFeedWithinWhatIsPermitted) {
  const auto may = [](const Permitted& permitted, double feed_ratio, double speed_ratio = 1.0) {
    Move move = turning_cut();
    move.feed_mm_s *= feed_ratio;
    move.spindle_rev_s *= speed_ratio;
    return fresh_move_difference(permitted, turning_cut(), move).empty();
  };
  EXPECT_TRUE(may({.path = true}, 0.2) && may({.path = true}, 2.0));
  EXPECT_FALSE(may({.path = true}, 0.199) || may({.path = true}, 2.001));
  EXPECT_TRUE(may({.feeds = true}, 1.0) && may({.feeds = true}, 0.001));
  EXPECT_FALSE(may({.feeds = true}, 1.001));
  EXPECT_TRUE(may({.speeds = true}, 1.3, 1.3) && may({.speeds = true}, 0.7, 0.7));
  EXPECT_TRUE(may({.speeds = true}, 1.0, 1.3)) << "a feed that has not followed";
  EXPECT_FALSE(may({.speeds = true}, 1.302, 1.3) || may({.speeds = true}, 0.999, 1.3));
  EXPECT_FALSE(may({.speeds = true}, 0.698, 0.7) || may({.speeds = true}, 1.001, 0.7));
  EXPECT_FALSE(may({.speeds = true}, -1.3, -1.3)) << "the other way round";
  EXPECT_TRUE(may({.path = true, .feeds = true}, 0.001) && may({.path = true, .feeds = true}, 2.0));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
