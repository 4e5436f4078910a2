// SPDX-License-Identifier: Apache-2.0
// One line of `linuxcnc` or `fanuc` as words, without expressions.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::read {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Letters and values of a line's words; the reason and the word where it is refused.
class LetterWords {
 public:
  LetterWords(std::string text, Dialect dialect) : text_(std::move(text)), reader_(dialect) {
    accepted_ = reader_.read(text_, 3, 1, block_);
  }
  [[nodiscard]] const Block& block() const { return block_; }
  [[nodiscard]] std::vector<std::pair<char, double>> words() const {
    EXPECT_TRUE(accepted_) << text_ << ": " << reader_.refused().text;
    std::vector<std::pair<char, double>> out;
    for (const Word& word : block_.words()) {
      out.emplace_back(word.letter, word.value);
    }
    return out;
  }
  [[nodiscard]] std::string reason() const {
    return accepted_ ? "" : reader_.refused().reason + ' ' + reader_.refused().word;
  }

 private:
  std::string text_;
  Reader reader_;
  Block block_;
  bool accepted_ = false;
};

std::vector<std::pair<char, double>> letters_in(const std::string& text,
                                                Dialect dialect = Dialect::linuxcnc) {
  return LetterWords(text, dialect).words();
}
std::string fault_of_line(const std::string& text, Dialect dialect = Dialect::linuxcnc) {
  return LetterWords(text, dialect).reason();
}

using W = std::pair<char, double>;

// RS274/NGC: blanks and case have no meaning, N is first and alone.
TEST(LetterLine, IgnoresBlanksCaseAndTheLineNumber) {
  const auto wanted = ElementsAre(W('G', 1), W('X', 10.5), W('Y', -2));
  EXPECT_THAT(letters_in("N10 G1 X10.5 Y-2"), wanted);
  EXPECT_THAT(letters_in("g1x10.5y-2"), wanted);
  EXPECT_THAT(letters_in("G 1 X 1 0 . 5 Y - 2"), wanted);
  EXPECT_THAT(letters_in("\tn 0010 g01\tx+10.50y-2."), wanted);
  EXPECT_EQ(fault_of_line("G1 N10"), "misplaced_n N10");
  EXPECT_EQ(fault_of_line("N10 N20"), "misplaced_n N10");
}

TEST(LetterLine, LeavesOutComments) {
  EXPECT_THAT(letters_in("G1 (to X5) X10 ; and X6"), ElementsAre(W('G', 1), W('X', 10)));
  EXPECT_THAT(letters_in("(all of it)"), IsEmpty());
  EXPECT_EQ(fault_of_line("G1 (a (b) c)"), "nested_comment (a (b) c)");
  EXPECT_EQ(fault_of_line("G1 (open"), "unclosed_comment (open");
  EXPECT_EQ(fault_of_line("G1 )"), "unopened_comment )");
  EXPECT_EQ(fault_of_line("(a\x01)"), "control_character \\x01");
  EXPECT_EQ(fault_of_line("; a\x1b"), "control_character \\x1b");
}

// `;` opens a comment for LinuxCNC; for a FANUC it is the end of the block (EOB).
TEST(LetterLine, OfFanucEndsAtTheSemicolon) {
  EXPECT_THAT(letters_in("G1 X5;", Dialect::fanuc), ElementsAre(W('G', 1), W('X', 5)));
  EXPECT_EQ(fault_of_line("G1 X5; Y6", Dialect::fanuc), "text_after_end_of_block ; Y6");
  EXPECT_EQ(fault_of_line("G1 X5; Y6"), "");
}

TEST(LetterLine, MarksABlockThatMayBeLeftOut) {
  for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc}) {
    const LetterWords marked("/ G1 X5", dialect);
    EXPECT_TRUE(marked.block().deleted());
    EXPECT_EQ(marked.words().size(), 2U);
    EXPECT_EQ(fault_of_line("G1 / X5", dialect), "misplaced_block_delete / X5");
  }
  EXPECT_EQ(fault_of_line("/3 G1", Dialect::fanuc), "block_delete_switch /3");
}

TEST(LetterLine, HasPolarWordsInLinuxcncOnly) {
  EXPECT_THAT(letters_in("@10 ^45"), ElementsAre(W('@', 10), W('^', 45)));
  EXPECT_EQ(fault_of_line("@10", Dialect::fanuc), "polar_coordinates @10");
  EXPECT_EQ(fault_of_line("M3 $0", Dialect::fanuc), "spindle_selection $0");
}

TEST(LetterLine, ShowsTheWordAtFault) {
  const std::pair<const char*, const char*> cases[] = {
      {"X", "missing_value X"},
      {"XY1", "missing_value XY1"},
      {"X--1", "bad_number X--1"},
      {"X1.2.3", "bad_number X1.2.3"},
      {"X.", "bad_number X."},
      {"X#1", "parameter X#1"},
      {"#1=2", "parameter #1=2"},
      {"X[1+2]", "expression X[1+2]"},
      {"[1]", "expression [1]"},
      {"Xsin[30]", "expression Xsin[30]"},
      {"G1 %", "misplaced_percent %"},
      {"G1 X1 \xc3\xa4", "not_ascii \\xc3"},
      {"G1 \x7f", "control_character \\x7f"},
      {"\xef\xbb\xbfG1", "byte_order_mark \\xef\\xbb\\xbf"}};
  for (const auto& [text, fault] : cases) {
    EXPECT_EQ(fault_of_line(text), fault) << text;
  }
}

TEST(LetterLine, HoldsAHundredAndTwentyEightWordsAndNoMore) {
  std::string text;
  for (std::size_t i = 0; i < Block::kMostWords; ++i) {
    text += i % 2 == 0 ? "X" : "Y";
    text += "1";
  }
  EXPECT_EQ(letters_in(text, Dialect::fanuc).size(), Block::kMostWords);
  EXPECT_EQ(fault_of_line(text + "Z1", Dialect::fanuc), "too_many_words Z1");
}

// Line end included: LinuxCNC's 255-byte buffer takes 253, the others as in README.md.
TEST(LetterLine, IsRefusedWhereItIsTooLongForItsControl) {
  for (const auto& [dialect, longest] : {std::pair{Dialect::linuxcnc, std::size_t{253}},
                                         std::pair{Dialect::fanuc, std::size_t{1024}},
                                         std::pair{Dialect::sinumerik, std::size_t{514}}}) {
    Reader reader(dialect);
    Block block;
    // A comment fills the line.
    const std::string text = dialect == Dialect::sinumerik
                                 ? ";" + std::string(longest - 2, 'x')
                                 : "(" + std::string(longest - 3, 'x') + ")";
    EXPECT_TRUE(reader.read(text, 1, 1, block)) << longest;
    EXPECT_FALSE(reader.read(text, 1, 2, block)) << longest;
    EXPECT_EQ(reader.refused().reason, "line_too_long");
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
