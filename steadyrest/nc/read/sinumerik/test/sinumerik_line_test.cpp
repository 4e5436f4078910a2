// SPDX-License-Identifier: Apache-2.0
// One line of a SINUMERIK program as words, without variables. "Fundamentals", NC programming: N
// first, letters with numbers, names and values by =, comments behind ;.
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::read {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Reads one line; the block refers to its text.
class SinumerikWords {
 public:
  explicit SinumerikWords(std::string text) : text_(std::move(text)) {
    accepted_ = reader_.read(text_, 7, 1, block_);
  }
  [[nodiscard]] const Block& block() const { return block_; }
  [[nodiscard]] const Word& at(std::size_t i) const { return block_.words()[i]; }
  /// `X=10`, or its name alone where it has no value.
  [[nodiscard]] std::vector<std::string> words() const {
    EXPECT_TRUE(accepted_) << text_ << ": " << reader_.refused().text;
    std::vector<std::string> out;
    for (const Word& word : block_.words()) {
      std::string one{word.letter != 0 ? std::string(1, word.letter) : std::string(word.name)};
      if (word.has_value) {
        one += fmt::format("{}", word.value);
      }
      out.push_back(one);
    }
    return out;
  }
  [[nodiscard]] std::string reason() const {
    return accepted_ ? "" : reader_.refused().reason + ' ' + reader_.refused().word;
  }

 private:
  std::string text_;
  Reader reader_{Dialect::sinumerik};
  Block block_;
  bool accepted_ = false;
};

std::vector<std::string> words_in(const std::string& text) {
  return SinumerikWords(text).words();
}
std::string fault_in(const std::string& text) {
  return SinumerikWords(text).reason();
}

TEST(SinumerikLine, HasLettersWithNumbersAndAssignments) {
  EXPECT_THAT(words_in("N10 G1 X10 Y=-2.5 F200"), ElementsAre("G1", "X10", "Y-2.5", "F200"));
  EXPECT_THAT(words_in("g01x10y20"), ElementsAre("G1", "X10", "Y20"));
  EXPECT_THAT(words_in("CR=5 TURN=2 SUPA"), ElementsAre("CR5", "TURN2", "SUPA"));
  EXPECT_THAT(words_in("X = 10"), ElementsAre("X10"));
}

TEST(SinumerikLine, KeepsTheContentOfAString) {
  const SinumerikWords line("T=\"DRILL 8.5\" MSG ( \"X1 ; Y2\" )");
  EXPECT_THAT(line.words(), ElementsAre("T", "MSG"));
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_EQ(line.at(i).qualifier, Qualifier::text);
    EXPECT_FALSE(line.at(i).has_value);
  }
  EXPECT_EQ(line.at(0).text, "DRILL 8.5");
  EXPECT_EQ(line.at(1).text, "X1 ; Y2");
}

TEST(SinumerikLine, LeavesOutNumbersLabelsAndComments) {
  for (const char* text : {"", "  ", "N10", ":20", "; X1", "N10 ; only",
                           "START:", "N10 START:", "MSG()", "N30 MSG ( )"}) {
    EXPECT_THAT(words_in(text), IsEmpty()) << text;
  }
  EXPECT_THAT(words_in("N10 LOOP_1: X5 ; X6"), ElementsAre("X5"));
}

TEST(SinumerikLine, MarksABlockThatMayBeLeftOut) {
  EXPECT_TRUE(SinumerikWords("/N10 X1").block().deleted());
  EXPECT_TRUE(SinumerikWords(" / X1").block().deleted());
  EXPECT_FALSE(SinumerikWords("N10 X1").block().deleted());
  EXPECT_EQ(fault_in("/2 X1"), "block_delete_switch /2");
}

// S1= and M1= are the master spindle's; other numbers name another spindle or axis.
TEST(SinumerikLine, TakesTheFirstSpindleForTheMaster) {
  EXPECT_THAT(words_in("S1=500 M1=3"), ElementsAre("S500", "M3"));
  EXPECT_EQ(fault_in("S2=500"), "");
  EXPECT_EQ(fault_in("X1=500"), "extended_address X1=500");
  EXPECT_EQ(fault_in("M1.0=3"), "extended_address M1.0=3");
}

TEST(SinumerikLine, ShowsTheWordAtFault) {
  const std::pair<const char*, const char*> cases[] = {
      {"X", "missing_value X"},
      {"X ;", "missing_value X ;"},
      {"X+", "bad_number X+"},
      {"X1.2.3 Y1", "bad_number X1.2.3"},
      {"X1EX", "bad_number X1EX"},
      {"X1 + 2", "expression X1 + 2"},
      {"X=R1", "expression X=R1"},
      {"R1=5 X1", "parameter R1=5"},
      {"$P_UIFR", "parameter $P_UIFR"},
      {"X1 N20", "misplaced_n N"},
      {":X", "missing_value :"},
      {"WIDTH=5", "variable WIDTH"},
      {"POCKET3(1)", "subprogram_call POCKET3"},
      {"NOTHING", "unknown_word NOTHING"},
      {"T=\"DRILL", "unclosed_string T=\"DRILL"},
      {"MSG(1)", "expression MSG(1)"},
      {"(X1)", "bad_character (X1)"},
      {"X1 /", "misplaced_block_delete /"},
      {"X1 %", "misplaced_percent %"},
      {"X1 &", "bad_character &"},
      {"\xef\xbb\xbfX1", "byte_order_mark \\xef\\xbb\\xbf"},
      {"X1 \xc3\xbc", "not_ascii \\xc3"},
      {"X1 \x01", "control_character \\x01"},
      {"X1 ; \x07", "control_character \\x07"},
      {"T=\"A\x02\"", "control_character \\x02"}};
  for (const auto& [text, fault] : cases) {
    EXPECT_EQ(fault_in(text), fault) << text;
  }
}

TEST(SinumerikLine, HoldsAHundredAndTwentyEightWordsAndNoMore) {
  std::string text;
  for (std::size_t i = 0; i < Block::kMostWords; ++i) {
    text += "X1";
  }
  EXPECT_EQ(SinumerikWords(text).words().size(), Block::kMostWords);
  EXPECT_EQ(fault_in(text + "X1"), "too_many_words X1");
}

}  // namespace
}  // namespace steadyrest::nc::read
