// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Opaque stretches: what is not understood is fenced. Truth: whatever such a word does on some
// control, all that counts as known behind it is the same on all of them.
namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Config fenced(read::Dialect dialect) {
  Config config;
  config.dialect = dialect;
  config.opaque_stretches = true;
  config.axes = "XYZ";
  return config;
}

struct Outcome {
  std::vector<Move> moves;
  Report report;
};

Outcome fenced_run(const std::string& text, const Config& config) {
  Kept kept;
  auto report = run_text(text, config, kept);
  EXPECT_TRUE(report.has_value());
  return {.moves = std::move(kept.moves), .report = report ? std::move(*report) : Report{}};
}

std::string reason_in(const Outcome& of) {
  return of.report.refused.empty() ? "" : of.report.refused.front().reason;
}

/// Lines with moves that do not count as known.
std::vector<std::uint32_t> opaque_lines(const Outcome& of) {
  std::vector<std::uint32_t> lines;
  for (const Move& move : of.moves) {
    if (move.opaque && (lines.empty() || lines.back() != move.line)) {
      lines.push_back(move.line);
    }
  }
  return lines;
}

constexpr std::string_view kFanucHead =
    "G21 G17 G90 G94 G40 G49 G54 G64\nG0 X0 Y0 Z5\nG1 X10 F500\n";
constexpr std::string_view kFanucSaid = "G21 G17 G90 G94 G40 G49 G54 G64 G80\n";

TEST(Opaque, AStretchEndsWhereTheTextHasSaidAllOfItAgain) {
  const std::string text = std::string(kFanucHead) +  // 1 … 3
                           "M150\n"                   // 4
                           "G1 X20 F500\n" +          // 5
                           std::string(kFanucSaid) +  // 6
                           "G0 X0 Y0\n"               // 7
                           "G1 Z2\n"                  // 8: Z was not said before it
                           "G1 X5\nM30\n";            // 9
  const Outcome seen = fenced_run(text, fenced(read::Dialect::fanuc));
  EXPECT_EQ(reason_in(seen), "");
  ASSERT_EQ(seen.report.opaque.size(), 1U);
  EXPECT_EQ(seen.report.opaque[0].line, 4U);
  EXPECT_EQ(seen.report.opaque[0].last_line, 8U);
  EXPECT_EQ(seen.report.opaque[0].word, "M150");
  EXPECT_THAT(opaque_lines(seen), ElementsAre(5, 7, 8));
}

TEST(Opaque, OneModeOrAxisLessKeepsItOpen) {
  const std::string head = std::string(kFanucHead) + "M150\n";
  for (const std::string_view left :
       {"G21", "G17", "G90", "G94", "G40", "G49", "G54", "G64", "F500", "G1 ", "X1", "Y1", "Z1"}) {
    std::string again = "G21 G17 G90 G94 G40 G49 G54 G64\nG1 X1 Y1 Z1 F500\n";
    again.erase(again.find(left), left.size());
    const Outcome seen = fenced_run(head + again + "X2\nM30\n", fenced(read::Dialect::fanuc));
    EXPECT_EQ(reason_in(seen), "") << left;
    ASSERT_EQ(seen.report.opaque.size(), 1U) << left;
    EXPECT_EQ(seen.report.opaque[0].last_line, left == "X1" ? 7U : 0U) << left;
  }
  const Outcome whole =
      fenced_run(head + "G21 G17 G90 G94 G40 G49 G54 G64\nG1 X1 Y1 Z1 F500\nX2\nM30\n",
                 fenced(read::Dialect::fanuc));
  ASSERT_EQ(whole.report.opaque.size(), 1U);
  EXPECT_EQ(whole.report.opaque[0].last_line, 6U);
}

TEST(Opaque, WithoutItTheProgramIsRefusedAsBefore) {
  Config strict = fenced(read::Dialect::fanuc);
  strict.opaque_stretches = false;
  EXPECT_EQ(reason_in(fenced_run(std::string(kFanucHead) + "M150\nM30\n", strict)),
            "m_code_not_interpreted");
}

TEST(Opaque, OtherWordsBesideAnUnknownFunctionDoWhatTheySay) {
  const Outcome seen =
      fenced_run(std::string(kFanucHead) + "G1 X40 M150\nM30\n", fenced(read::Dialect::fanuc));
  ASSERT_FALSE(seen.moves.empty());
  EXPECT_EQ(seen.moves.back().end[0], 40.0);
  EXPECT_TRUE(seen.moves.back().opaque);
}

TEST(Opaque, WhatIsWrongOnEveryControlIsStillRefused) {
  for (const auto& [line, reason] :
       std::map<std::string, std::string>{{"G1 X1 X2", "word_twice"},
                                          {"G2 X3 R0.1", "arc_radius_too_small"},
                                          {"G1 Xfoo", "bad_number"}}) {
    EXPECT_NE(reason_in(fenced_run(std::string(kFanucHead) + line + "\nM30\n",
                                   fenced(read::Dialect::fanuc))),
              "")
        << line;
  }
  // LinuxCNC knows all of its G words: it refuses others itself.
  EXPECT_EQ(reason_in(fenced_run("G21 G90\nG77\nM2\n", fenced(read::Dialect::linuxcnc))),
            "unknown_g_code");
}

TEST(Opaque, ALastingActionIsRefused) {
  for (const std::string_view action :
       {"WHEN $AA_IM[X]>10 DO M50", "ID=1 WHENEVER TRUE DO $AC_OVR=50", "TRAILON(Y,X,1)"}) {
    EXPECT_NE(reason_in(fenced_run("G90 G71\n" + std::string(action) + "\nM30\n",
                                   fenced(read::Dialect::sinumerik))),
              "")
        << action;
  }
}

TEST(Opaque, OnLinuxcncAUsersCommandIsFenced) {
  const Outcome seen =
      fenced_run("G21 G90 G94 F100\nG0 X1\nM150 P2\nG1 X2\nM2\n", fenced(read::Dialect::linuxcnc));
  EXPECT_EQ(reason_in(seen), "");
  EXPECT_THAT(opaque_lines(seen), ElementsAre(4));
}

TEST(Opaque, ALineThatBlockDeleteLeavesOutOpensNothing) {
  Config config = fenced(read::Dialect::sinumerik);
  config.block_delete = true;
  const Outcome seen = fenced_run("G90 G71 G94 F100\n/M50\n/FOO(1)\nG0 X1\nM30\n", config);
  EXPECT_EQ(reason_in(seen), "");
  EXPECT_THAT(seen.report.opaque, IsEmpty());
}

TEST(Opaque, EveryUnknownWordOfSinumerikIsFenced) {
  for (const std::string_view word :
       {"M50", "CYCLE999(1,2)", "L_TIME", "L_TIME(1)", "MY_SUB(\"A\",2)", "H12", "TRAORI(1)",
        "X=$AA_IM[X]+1", "R5=R99+1", "G147", "FOO=3", "GROUP_END(0)", "SPOS=90"}) {
    const Outcome seen =
        fenced_run("G90 G71 G94 F100\nG0 X1 Y1 Z1\n" + std::string(word) + "\nG1 X2\nM30\n",
                   fenced(read::Dialect::sinumerik));
    EXPECT_EQ(reason_in(seen), "") << word;
    EXPECT_EQ(seen.report.opaque.size(), 1U) << word;
    EXPECT_THAT(opaque_lines(seen), ElementsAre(4)) << word;
  }
}

using kernel::machine::BuildersWord;
using Does = BuildersWord::Does;

Config declared(std::vector<BuildersWord> words, read::Dialect dialect = read::Dialect::sinumerik) {
  Config config = fenced(dialect);
  config.settings.words = std::move(words);
  return config;
}

TEST(BuildersWords, DoWhatTheMachineFileSays) {
  const std::string text =
      "G90 G71 G94 F100\nG0 X1 Y1 Z1\nM50\nG1 X2 M51\nL_TIME\nG1 X3\nM52\nX4\nZ2\nX5\nM30\n";
  const Outcome seen =
      fenced_run(text, declared({{.word = "M50", .does = Does::nothing, .axes = {}},
                                 {.word = "M51", .does = Does::dwell, .dwell_s = 0.5, .axes = {}},
                                 {.word = "L_TIME", .does = Does::nothing, .axes = {}},
                                 {.word = "M52", .does = Does::moves, .axes = "Z"}}));
  EXPECT_EQ(reason_in(seen), "");
  double waited_s = 0.0;
  for (const Move& move : seen.moves) {
    waited_s += move.dwell_s;
  }
  EXPECT_DOUBLE_EQ(waited_s, 0.5);
  EXPECT_EQ(seen.moves.back().end[0], 5.0);
  // M52 moves Z: until Z is said again, nothing counts as known.
  EXPECT_THAT(opaque_lines(seen), ElementsAre(8, 9));
}

TEST(BuildersWords, TakeTheirArgumentsWithThem) {
  const Outcome seen = fenced_run(
      "G21 G90 G94 F100\nG0 X1 Y1 Z1\nG187 P2 E0.1\nG1 X2\nM30\n",
      declared({{.word = "G187", .does = Does::nothing, .axes = {}}}, read::Dialect::fanuc));
  EXPECT_EQ(reason_in(seen), "");
  EXPECT_THAT(seen.report.opaque, IsEmpty());
  EXPECT_THAT(opaque_lines(seen), IsEmpty());
}

TEST(BuildersWords, MayTakeAWordThatIsKnown) {
  const Outcome seen = fenced_run(
      "G21 G90 G94 F100\nG0 X1 Y1 Z1\nM8\nG1 X2\nM30\n",
      declared({{.word = "M8", .does = Does::opaque, .axes = {}}}, read::Dialect::fanuc));
  EXPECT_EQ(seen.report.opaque.size(), 1U);
  EXPECT_THAT(opaque_lines(seen), ElementsAre(4));
}

/// What the unknown word does on some control.
std::string hidden_meaning() {
  static const std::vector<std::string> kWords = {
      "G91",   "G20",       "G18",           "G19",           "G95 S100",   "G55",
      "F7",    "G52 X1 Y2", "G61",           "G0 X3 Y4",      "G1 Z-7 F33", "G43 H1",
      "X1.5",  "S77 M4",    "G10 L2 P1 X3",  "G3 X20 Y2 R30", "G98",        "G81 X1 Z-3 R1 F9",
      "M6 T3", "M8",        "G91 G20 G18 F3"};
  std::string out;
  const int count = *rc::gen::inRange(0, 4);
  for (int i = 0; i < count; ++i) {
    out += *rc::gen::elementOf(kWords) + " ";
  }
  return out;
}

std::string random_block() {
  static const std::vector<std::string> kLines = {"G21",
                                                  "G20",
                                                  "G90",
                                                  "G91",
                                                  "G17",
                                                  "G18",
                                                  "G94",
                                                  "G95 F0.1",
                                                  "F200",
                                                  "G40",
                                                  "G49",
                                                  "G54",
                                                  "G55",
                                                  "G64",
                                                  "G61",
                                                  "G80",
                                                  "G0 X1",
                                                  "G1 Y2",
                                                  "Z3",
                                                  "G0 X1 Y2 Z3",
                                                  "G1 X5 Y5 F150",
                                                  "G2 X9 Y9 R12",
                                                  "G3 X-2 R40",
                                                  "X7 Y1",
                                                  "M3 S500",
                                                  "G4 P100",
                                                  "G0 G53 Z0",
                                                  "G21 G17 G90 G94 G40 G49 G54 G64 F100",
                                                  "G0 X4 Y4 Z4",
                                                  "G1 Z-1 F90",
                                                  "G28 Z0",
                                                  "G98",
                                                  "G81 X2 Y2 Z-2 R2 F50",
                                                  "X11",
                                                  "M9"};
  return *rc::gen::elementOf(kLines);
}

bool same_move(const Move& a, const Move& b) {
  return a.kind == b.kind && a.start == b.start && a.end == b.end && a.feed_mm_s == b.feed_mm_s &&
         a.feed_mode == b.feed_mode && a.centre_mm == b.centre_mm && a.normal == b.normal &&
         a.turns == b.turns && a.path_mode == b.path_mode;
}

// For more: RC_PARAMS="max_success=10000 seed=…".
RC_GTEST_PROP(Opaque, WhatCountsAsKnownIsTheSameWhateverTheWordDoes, ()) {
  std::string unknown;
  std::string known;
  const auto both = [&](const std::string& line) {
    unknown += line + "\n";
    known += line + "\n";
  };
  both("G21 G17 G90 G94 G40 G49 G54 G64 G80 F300");
  both("G0 X0 Y0 Z5");
  const int lines = *rc::gen::inRange(4, 40);
  for (int i = 0; i < lines; ++i) {
    if (*rc::gen::inRange(0, 9) == 0) {
      unknown += "M150\n";
      known += hidden_meaning() + "\n";
    } else {
      both(random_block());
    }
  }
  both("M30");
  const Outcome fence = fenced_run(unknown, fenced(read::Dialect::fanuc));
  const Outcome truth = fenced_run(known, fenced(read::Dialect::fanuc));
  RC_PRE(truth.report.refused.empty() && fence.report.refused.empty());
  std::map<std::uint32_t, std::vector<Move>> by_line;
  for (const Move& move : truth.moves) {
    by_line[move.line].push_back(move);
  }
  std::map<std::uint32_t, std::size_t> at;
  std::size_t counted = 0;
  for (const Move& move : fence.moves) {
    const std::size_t index = at[move.line]++;
    if (move.opaque || move.kind == MoveKind::dwell) {
      continue;
    }
    ++counted;
    const auto& moves = by_line[move.line];
    RC_LOG() << "line " << move.line << " of\n" << unknown << "with\n" << known;
    RC_ASSERT(index < moves.size());
    RC_ASSERT(same_move(move, moves[index]));
  }
  RC_CLASSIFY(counted > 0);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
