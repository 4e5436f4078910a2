// SPDX-License-Identifier: Apache-2.0
// What a block must and must not contain. Each fault stands beside the nearest text that is none.
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

std::string fault_in_block(const std::string& block) {
  return reason_of("G21 G90 G17\nF100 S600 M3\nG0 X0 Y0 Z5\n" + block + "\nM2\n");
}

/// `wrong` is refused for `reason`; `right` is accepted.
struct Neighbours {
  const char* reason;
  const char* wrong;
  const char* right;
};

void expect_border(const Neighbours& pair) {
  EXPECT_EQ(fault_in_block(pair.wrong), pair.reason) << pair.wrong;
  EXPECT_EQ(fault_in_block(pair.right), "") << pair.right;
}

// RS274/NGC: two G words that both use the axis words are an error; so are axis words that nobody
// uses.
TEST(BlockCheck, AxisWordsHaveExactlyOneUser) {
  const Neighbours cases[] = {{"two_users_of_axis_words", "G1 G92 X5", "G92 X5"},
                              {"two_users_of_axis_words", "G0 G28 Z10", "G28 Z10"},
                              {"two_users_of_axis_words", "G1 G10 L2 P1 X5", "G10 L2 P1 X5"},
                              {"axis_words_with_g80", "G80 X5", "G80"},
                              {"no_motion_mode", "G80\nX5", "G80\nG0 X5"},
                              {"axis_words_missing", "G81", "G81 Z1 R2"},
                              {"axis_words_missing", "G33 K1", "G33 Z1 K1"},
                              {"axis_words_missing", "G92", "G92 X0"},
                              {"axis_words_missing", "G52", "G52 X0"}};
  for (const Neighbours& pair : cases) {
    expect_border(pair);
  }
  // A G word of an offset in the block takes the axis words of a modal motion.
  EXPECT_EQ(moves_of("G21 F100\nG1 X5\nG92 X0\nX1\nM2\n").size(), 2U);
}

TEST(BlockCheck, MachineCoordinatesNeedAStraightAbsoluteMotion) {
  const Neighbours cases[] = {
      {"g53_without_straight_motion", "G53 G2 X5 I2.5", "G53 G1 X5"},
      {"g53_without_straight_motion", "G81 Z1 R2\nG53 X5", "G81 Z1 R2\nG53 G0 X5"},
      {"g53_incremental", "G91 G53 G0 X5", "G90 G53 G0 X5"},
      {"g53_incremental", "G91\nG53 G0 X5", "G91\nG90 G53 G0 X5"}};
  for (const Neighbours& pair : cases) {
    expect_border(pair);
  }
}

TEST(BlockCheck, ADwellHasATimeWithinReason) {
  const Neighbours cases[] = {{"dwell_missing", "G4", "G4 P0"},
                              {"dwell_missing", "G4 P-0.1", "G4 P0.1"},
                              {"out_of_range", "G4 P1000001", "G4 P1000000"}};
  for (const Neighbours& pair : cases) {
    expect_border(pair);
  }
}

// The bound keeps all later arithmetic finite.
TEST(BlockCheck, ValuesAreWithinTenMillion) {
  const Neighbours cases[] = {{"out_of_range", "G0 X10000000.1", "G0 X10000000"},
                              {"out_of_range", "G0 X-10000000.1", "G0 X-10000000"},
                              {"out_of_range", "F-1", "F0"},
                              {"out_of_range", "S-1", "S0"},
                              {"not_an_integer", "T1.5", "T1"},
                              {"not_an_integer", "T-1", "T0"},
                              {"not_an_integer", "G43 H0.5", "G49"}};
  for (const Neighbours& pair : cases) {
    expect_border(pair);
  }
}

// A word that no G or M word of its block uses is a post processor's mistake.
TEST(BlockCheck, EveryWordHasAUser) {
  const Neighbours cases[] = {{"unused_word", "G1 X5 P1", "G2 X5 I2.5 P1"},
                              {"unused_word", "G1 X5 R2", "G2 X5 R2.5"},
                              {"unused_word", "G1 X5 I2", "G2 X5 I2.5"},
                              {"unused_word", "G1 X5 J2", "G3 X5 I2.5 J0"},
                              {"unused_word", "G1 X5 K2", "G33 Z5 K2"},
                              {"unused_word", "G1 X5 Q1", "G73 Z1 R2 Q1"},
                              {"unused_word", "G1 X5 L2", "G81 Z1 R2 L2"},
                              {"unused_word", "G1 X5 D1", "G96 D1000 S100"},
                              {"unused_word", "G1 X5 E1", "M66 P0 L0"},
                              {"unused_word", "G1 X5 H1", "G43 H0"},
                              {"unused_word", "G61 P0.1", "G64 P0.1"},
                              {"unused_word", "G81 Z1 R2 Q1", "G83 Z1 R2 Q1"},
                              {"unused_word", "G81 Z1 R2 P1", "G82 Z1 R2 P1"}};
  for (const Neighbours& pair : cases) {
    expect_border(pair);
  }
}

// The article goes by how a letter is spoken: "an R", "a Q".
TEST(BlockCheck, NamesTheWordThatIsNotUsed) {
  const std::pair<const char*, const char*> cases[] = {{"G1 X1 R2", "an R word, but"},
                                                       {"G1 X1 Q2", "a Q word, but"},
                                                       {"G1 X1 H2", "an H word, but"}};
  for (const auto& [block, text] : cases) {
    Kept kept;
    const auto report = run_text("F100\n" + std::string(block) + "\nM2\n", {}, kept);
    ASSERT_TRUE(report && !report->refused.empty()) << block;
    EXPECT_NE(report->refused.front().text.find(text), std::string::npos)
        << report->refused.front().text;
  }
}

TEST(BlockCheck, ACuttingMoveHasAFeed) {
  const std::string start = "G21 G90\n";
  EXPECT_EQ(reason_of(start + "G1 X5\nM2\n"), "feed_missing");
  EXPECT_EQ(reason_of(start + "F0 G1 X5\nM2\n"), "feed_missing");
  EXPECT_EQ(reason_of(start + "G0 X5\nM2\n"), "");
  // In G93 F belongs to its block; the one before does not count.
  EXPECT_EQ(reason_of(start + "G93 G1 X5 F2\nX6\nM2\n"), "feed_missing");
  EXPECT_EQ(reason_of(start + "G93 G1 X5 F2\nX6 F2\nM2\n"), "");
  EXPECT_EQ(reason_of(start + "G93 G1 X5 F0\nM2\n"), "feed_missing");
  // In G95 the spindle must have a speed, or the axis never moves.
  EXPECT_EQ(reason_of(start + "G95 F0.1\nG1 X5\nM2\n"), "spindle_speed_missing");
  EXPECT_EQ(reason_of(start + "G95 F0.1 S100\nG1 X5\nM2\n"), "");
  EXPECT_EQ(reason_of(start + "G96 D1000 S100\nG95 F0.1\nG1 X5\nM2\n"), "");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
