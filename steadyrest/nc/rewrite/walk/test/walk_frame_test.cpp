// SPDX-License-Identifier: Apache-2.0
// What lines do to the frame that holds a correction of Z, and what of them the correction needs to
// know.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/walk/test/walk_shop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::WalkShop;

/// What this line does, behind one that sets the modes.
Frame frame_of(const std::string& line, const WalkShop& shop = {}) {
  Frame found = Frame::kept;
  shop.walk("G90 G54\n" + line + "\nM30\n",
            [&](const Walk& walk) { found = walk.line() == 2 ? walk.frame('Z') : found; });
  return found;
}

// LinuxCNC: G10 L2 writes an offset, G10 L20 measures one from the position shown, G28.1 stores the
// machine's position. P0 is the active offset, P1 is G54.
TEST(WalkFrame, IsChangedByWhatSelectsOrSetsTheActiveOffset) {
  const std::pair<const char*, Frame> cases[] = {{"G0 Z5", Frame::kept},
                                                 {"G54", Frame::kept},
                                                 {"G55", Frame::changed},
                                                 {"G59.3", Frame::changed},
                                                 {"G10 L2 P1 Z3", Frame::changed},
                                                 {"G10 L2 P0 Z3", Frame::changed},
                                                 {"G10 L2 P2 Z3", Frame::kept},
                                                 {"G10 L2 P1 X3", Frame::kept},
                                                 {"G10 L20 P1 Z3", Frame::kept},
                                                 {"G10 L20 P0 Z3", Frame::kept},
                                                 {"G10 L20 P2 Z3", Frame::measured},
                                                 {"G10 L20 P2 X3", Frame::kept},
                                                 {"G28.1", Frame::stored},
                                                 {"G30.1", Frame::stored},
                                                 {"G28 Z9", Frame::kept},
                                                 {"G92 Z1", Frame::kept}};
  for (const auto& [line, frame] : cases) {
    EXPECT_EQ(frame_of(line), frame) << line;
  }
}

// A SINUMERIK loads the stored frame again at every G54, and G500 switches it off.
TEST(WalkFrame, IsTakenAnewByEveryG54OfASinumerik) {
  WalkShop shop;
  shop.config.dialect = read::Dialect::sinumerik;
  shop.way.method = Method::frame_fine;
  for (const char* line : {"G54", "G55", "G500", "G505"}) {
    EXPECT_EQ(frame_of(line, shop), Frame::changed) << line;
  }
  EXPECT_EQ(frame_of("TRANS Z5", shop), Frame::kept);
}

TEST(WalkFrame, TellsWhatALineSetsStoresAndMoves) {
  using Question = bool (*)(const Walk&);
  const auto asked = [](const std::string& line, Question question) {
    bool found = false;
    WalkShop().walk("G90 G54 F9\nG0 Z9\n" + line + "\nM30\n",
                    [&](const Walk& walk) { found = walk.line() == 3 ? question(walk) : found; });
    return found;
  };
  const Question sets = [](const Walk& walk) { return walk.sets_offset('Z'); };
  EXPECT_TRUE(asked("G92 Z0", sets) && asked("G52 X1", sets) && asked("G10 L20 P1 Z3", sets));
  EXPECT_FALSE(asked("G10 L20 P2 Z3", sets) || asked("G10 L20 P1 X3", sets) || asked("G0", sets));
  const Question stores = [](const Walk& walk) { return walk.stores(); };
  EXPECT_TRUE(asked("G10 L2 P3 X1", stores) && asked("G30.1", stores));
  EXPECT_FALSE(asked("G28", stores) || asked("G92 Z1", stores));
  const Question moves = [](const Walk& walk) { return walk.moves_axis(2); };
  EXPECT_TRUE(asked("G1 X5 Z8", moves));
  EXPECT_FALSE(asked("G1 X5 Z9", moves) || asked("G4 P1", moves));
  const Question machine = [](const Walk& walk) { return walk.machine_frame(); };
  EXPECT_TRUE(asked("G53 G0 Z0", machine) && asked("G28 Z9", machine));
  EXPECT_FALSE(asked("G28.1", machine) || asked("G0 Z0", machine));
}

TEST(WalkFrame, KnowsItsTopLineAndItsEnd) {
  std::vector<std::uint32_t> top;
  std::vector<bool> ends;
  WalkShop().walk("G21\no1 repeat [2]\nG4 P0\no1 endrepeat\nM2\n", [&](const Walk& walk) {
    if (walk.run().executed()) {
      top.push_back(walk.top_line());
    }
    ends.push_back(walk.ends());
    EXPECT_TRUE(walk.units_said());
  });
  EXPECT_EQ(top, (std::vector<std::uint32_t>{1, 2, 2, 5})) << "line 3 is in a loop";
  EXPECT_EQ(std::ranges::count(ends, true), 1);
  EXPECT_TRUE(ends.back());
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
