// SPDX-License-Identifier: Apache-2.0
// FANUC Series 30i operator's manuals, machining centre system: what its words mean where
// LinuxCNC's mean something else.
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;

Config fanuc_config(DecimalRule rule = DecimalRule::calculator) {
  Config config;
  config.dialect = read::Dialect::fanuc;
  config.decimal_rule = rule;
  return config;
}
std::vector<Move> fanuc_moves(const std::string& text, const Config& config = fanuc_config()) {
  return moves_of(text + "\nM30\n", config);
}
std::string fanuc_reason(const std::string& text) {
  return reason_of(text + "\nM30\n", fanuc_config());
}

// IS-B: 0.001 mm, 0.0001 in, 0.001°; F, S and cycle counts are no lengths.
TEST(DecodeFanuc, CountsIncrementsInLengthsAndAnglesWithoutPoint) {
  const Config config = fanuc_config(DecimalRule::least_increment);
  const auto moves = fanuc_moves(
      "G1 X1500 Y1.5 A90000 F200\nG2 X3500 I1000\nG20\nG1 X10000 F10\nG4 X1500\nG4 X1.5", config);
  ASSERT_EQ(moves.size(), 5U);
  EXPECT_DOUBLE_EQ(moves[0].end[0], 1.5);
  EXPECT_EQ(moves[0].end[1], 1.5);
  EXPECT_DOUBLE_EQ(moves[0].end[3], 90.0);
  EXPECT_DOUBLE_EQ(moves[0].feed_mm_s, 200.0 / 60.0);
  EXPECT_DOUBLE_EQ(moves[1].centre_mm[0], 2.5);
  EXPECT_DOUBLE_EQ(moves[2].end[0], 25.4);
  EXPECT_DOUBLE_EQ(moves[3].dwell_s, 1.5);
  EXPECT_DOUBLE_EQ(moves[4].dwell_s, 1.5);
}

// G61 is the exact stop mode here, G9 that of one block; on LinuxCNC G61 is the exact path.
TEST(DecodeFanuc, StopsExactlyInG61AndForOneBlockInG9) {
  const auto moves = fanuc_moves("G1 X1. F100\nG61 X2.\nX3.\nG64 X4.\nG9 X5.\nX6.");
  ASSERT_EQ(moves.size(), 6U);
  for (const std::size_t at : {0U, 3U, 5U}) {
    EXPECT_EQ(moves[at].path_mode, PathMode::continuous) << at;
  }
  for (const std::size_t at : {1U, 2U, 4U}) {
    EXPECT_EQ(moves[at].path_mode, PathMode::exact_stop) << at;
  }
}

// K is the number of repeats of a drilling cycle.
TEST(DecodeFanuc, RepeatsACycleKTimes) {
  const auto moves = fanuc_moves("G0 Z10.\nG91 G81 X5. Z-3. R-8. K3 F100");
  std::vector<double> bottoms;
  for (const Move& move : moves) {
    if (move.kind == MoveKind::linear) {
      bottoms.push_back(move.end[0]);
    }
  }
  EXPECT_THAT(bottoms, ElementsAre(5, 10, 15));
}

// U V W are increments to the intermediate point, whatever G90 says.
TEST(DecodeFanuc, GoesToTheReferencePointByAnIncrement) {
  const auto moves = fanuc_moves("G90 G0 X50. Z20.\nG28 W5.");
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(moves[1].end[2], 25.0);
  EXPECT_EQ(moves[2].end[2], 0.0);
  EXPECT_EQ(moves[2].end[0], 50.0);
}

TEST(DecodeFanuc, RefusesWordsThatWouldDoNothingOrAnythingElse) {
  const std::pair<const char*, const char*> cases[] = {
      {"G1 X1. E1 F100", "unused_word"},     {"G0 X1. P500", "unused_word"},
      {"G0 X1. V2.", "lathe_word"},          {"G43 Z1.", "tool_missing"},
      {"G28", "axis_words_missing"},         {"G28 G2 X1. Y1. R1.", "two_users_of_axis_words"},
      {"G54.1 P301", "out_of_range"},        {"G52 X1.\nG92 X0", "ambiguous_code"},
      {"G92 X0\nG52 X1.", "ambiguous_code"}, {"M60", "machine_builders_code"},
      {"M62 P1", "m_code_not_interpreted"},  {"M98 P2 L0", "bad_value"},
      {"M98 P20002 L3", "bad_value"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(fanuc_reason(text), expected) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
