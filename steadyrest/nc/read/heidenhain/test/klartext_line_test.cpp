// SPDX-License-Identifier: Apache-2.0
// Lines of a Klartext program as words.
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>

namespace steadyrest::nc::read {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Reads line after line of one program.
class KlartextProgram {
 public:
  KlartextProgram() {
    reader_.set_values(&values);
    EXPECT_TRUE(line("0 BEGIN PGM A NAME MM"));
  }
  bool line(const std::string& text) {
    text_ = text;
    block_.reset(0);
    return reader_.read(text_, ++number_, 1, block_);
  }
  /// `X10`, `FMAX`, `IX5` for increments.
  std::vector<std::string> words(const std::string& text) {
    EXPECT_TRUE(line(text)) << text << ": " << reader_.refused().text;
    std::vector<std::string> out;
    for (const Word& word : block_.words()) {
      const std::string head = word.qualifier == Qualifier::incremental ? "I" : "";
      out.push_back(head + (word.letter != 0 ? fmt::format("{}{:g}", word.letter, word.value)
                                             : std::string{word.name}));
    }
    return out;
  }
  std::string reason(const std::string& text) {
    return line(text) ? std::string{} : reader_.refused().reason;
  }
  [[nodiscard]] const Block& block() const { return block_; }
  [[nodiscard]] const Refused& refused() const { return reader_.refused(); }

  test::MapValues values{{{1, 2.0}}};

 private:
  Reader reader_{Dialect::heidenhain};
  std::string text_;
  Block block_;
  std::uint32_t number_ = 0;
};

TEST(KlartextLine, SplitsPathFunctionsIntoWords) {
  KlartextProgram program;
  EXPECT_THAT(program.words("6 L X+10,5 Y-.25 IZ-3 R0 F MAX M3"),
              ElementsAre("L", "X10.5", "Y-0.25", "IZ-3", "R0", "FMAX", "M3"));
  EXPECT_THAT(program.words("C X+Q1 Y-Q1 DR- F500"), ElementsAre("C", "X2", "Y-2", "DR", "F500"));
  EXPECT_THAT(program.words("CP IPA+720 IZ-4 DR+"), ElementsAre("CP", "IPA", "IZ-4", "DR"));
  EXPECT_THAT(program.words("N12 RND R5 F100 ; corner"), ElementsAre("RND", "LENGTH", "F100"));
  EXPECT_THAT(program.words("CHF 2"), ElementsAre("CHF", "LENGTH"));
  EXPECT_THAT(program.words("M13"), ElementsAre("M13"));
  EXPECT_THAT(program.words("Z+100 R0 FMAX"), ElementsAre("Z", "Z100", "R0", "FMAX"));
}

TEST(KlartextLine, HasCommentsAndStructure) {
  KlartextProgram program;
  for (const char* text :
       {"* - Roughing", "12 ; comment", "", "  ", "BLK FORM 0.1 Z X+0 Y+0 Z-20", "7 * text \xe4",
        "PLANE SPATIAL SPA+0 SPB0 SPC+0 STAY SEQ+", "PLANE RESET STAY", "FUNCTION RESET TCPM"}) {
    EXPECT_THAT(program.words(text), IsEmpty()) << text;
  }
  EXPECT_TRUE(program.line("/12 M30"));
  EXPECT_TRUE(program.block().deleted());
}

TEST(KlartextLine, ContinuesCyclesAndComments) {
  KlartextProgram program;
  EXPECT_THAT(program.words("CYCL DEF 200 BOHREN ~"), ElementsAre("CYCL DEF 200", "NUMBER"));
  EXPECT_THAT(program.words("  Q200=+2 ;ABSTAND ~"), ElementsAre("Q200"));
  EXPECT_THAT(program.words("  Q201=-15 ;TIEFE"), ElementsAre("Q201", "COMPLETE"));
  EXPECT_EQ(program.values.numbers.at(200), 2.0);
  EXPECT_EQ(program.values.numbers.at(201), -15.0);
  EXPECT_THAT(program.words("Q3 = 1 ; a long comment ~"), IsEmpty());
  EXPECT_THAT(program.words("that goes on (here)"), IsEmpty());
  EXPECT_THAT(program.words("M5"), ElementsAre("M5"));
}

// The line of the value is named, not that of the definition.
TEST(KlartextLine, NamesTheLineOfACyclesValue) {
  KlartextProgram program;
  EXPECT_TRUE(program.line("CYCL DEF 200 BOHREN ~"));
  EXPECT_TRUE(program.line("  Q200=+2 ;ABSTAND ~"));
  EXPECT_EQ(program.reason("  Q201=TIEF ;TIEFE ~"), "missing_value");
  EXPECT_EQ(program.refused().line, 4U);
  EXPECT_EQ(program.reason("  Q206=+150 ;VORSCHUB"), "continued_block");
  EXPECT_EQ(program.reason("M5"), "");
}

TEST(KlartextLine, CalculatesParameters) {
  KlartextProgram program;
  const auto after = [&](const std::string& text, int index) {
    EXPECT_TRUE(program.line(text)) << text << ": " << program.refused().text;
    return program.values.numbers[index];
  };
  EXPECT_DOUBLE_EQ(after("FN 0: Q5 = +60", 5), 60.0);
  EXPECT_DOUBLE_EQ(after("FN 1: Q6 = -Q1 + -5", 6), -7.0);
  EXPECT_DOUBLE_EQ(after("FN 2: Q6 = +10 - +5", 6), 5.0);
  EXPECT_DOUBLE_EQ(after("FN 3: Q6 = +3 * +3", 6), 9.0);
  EXPECT_DOUBLE_EQ(after("FN 4: Q6 = +8 DIV +Q1", 6), 4.0);
  EXPECT_DOUBLE_EQ(after("FN 5: Q6 = SQRT 4", 6), 2.0);
  EXPECT_DOUBLE_EQ(after("FN 6: Q6 = SIN +30", 6), 0.5);
  EXPECT_DOUBLE_EQ(after("FN 7: Q6 = COS +60", 6), 0.5);
  EXPECT_DOUBLE_EQ(after("FN 8: Q6 = +3 LEN +4", 6), 5.0);
  EXPECT_DOUBLE_EQ(after("FN 13: Q6 = -1 ANG +1", 6), 315.0);
  EXPECT_DOUBLE_EQ(after("FN0 : Q6 = -200.66", 6), -200.66);
  EXPECT_DOUBLE_EQ(after("Q7 = Q1 * ( 3 + 2,5 )", 7), 11.0);
}

TEST(KlartextLine, SaysWhereTheProgramGoes) {
  KlartextProgram program;
  EXPECT_TRUE(program.line("LBL 007"));
  EXPECT_EQ(program.block().flow().kind, FlowKind::mark);
  EXPECT_EQ(program.block().flow().label.view(), "7");
  EXPECT_TRUE(program.line("CALL LBL \"SUB A\" REP 5/5"));
  EXPECT_EQ(program.block().flow().label.view(), "\"SUB A");
  EXPECT_EQ(program.block().flow().values[0], 5.0);
  EXPECT_TRUE(program.line("CALL LBL 1 REPQ1"));
  EXPECT_EQ(program.block().flow().values[0], 2.0);
  EXPECT_TRUE(program.line("FN 11: IF +Q1 GT +1,5 GOTO LBL 7"));
  EXPECT_EQ(program.block().flow().values[0], 1.0);
  EXPECT_TRUE(program.line("CALL PGM TNC:\\PARTS\\HOLES.H ; now"));
  EXPECT_EQ(program.block().flow().label.view(), "HOLES.H");
  EXPECT_EQ(program.reason("FN 9: IF +Q1 EQU +2.0000000001 GOTO LBL 7"), "comparison_too_close");
}

TEST(KlartextLine, RefusesByName) {
  KlartextProgram program;
  EXPECT_EQ(program.reason("L X+"), "missing_value");
  EXPECT_EQ(program.reason("L X+1.2.3"), "bad_number");
  EXPECT_EQ(program.reason("L X+1 K5"), "unknown_word");
  EXPECT_EQ(program.reason("G1 X5"), "unknown_word");
  EXPECT_EQ(program.reason("L X+1 \xe4"), "not_ascii");
  EXPECT_EQ(program.reason("APPR LT X+1 LEN15 RR"), "approach");
  EXPECT_EQ(program.reason("PLANE SPATIAL SPA+0 SPB+45 SPC+0 MOVE"), "tilted_plane");
  EXPECT_EQ(program.reason("PLANE SPATIAL SPA+0 SPB+0 SPC+0 MOVE"), "tilted_plane");
  EXPECT_EQ(program.reason("FN 18: SYSREAD Q1 = ID210 NR4"), "system_value");
  EXPECT_EQ(program.reason("L X+Q55"), "unset_parameter");
  EXPECT_EQ(program.reason("CYCL CALL PAT FMAX"), "pattern");
  EXPECT_EQ(program.reason("L X+1 ~"), "continued_block");
  EXPECT_EQ(program.reason("anything"), "continued_block");
  EXPECT_EQ(program.reason("FN 14: ERROR = 1000"), "abort");
  EXPECT_EQ(program.reason("X+10 R+ FMAX"), "cutter_comp");
  EXPECT_EQ(program.reason("TOOL CALL 1 Z S1000 ("), "bad_character");
}

TEST(KlartextLine, BeginsWithItsUnit) {
  Reader reader(Dialect::heidenhain);
  Block block;
  EXPECT_FALSE(reader.read("L X+1", 1, 1, block));
  EXPECT_EQ(reader.refused().reason, "begin_missing");
  EXPECT_FALSE(reader.read("BEGIN PGM A", 1, 1, block));
  EXPECT_EQ(reader.refused().reason, "begin_unit");
  EXPECT_TRUE(reader.read("BEGIN PGM 2.5D PART INCH", 2, 1, block));
  EXPECT_EQ(block.words()[1].name, "INCH");
}

}  // namespace
}  // namespace steadyrest::nc::read
