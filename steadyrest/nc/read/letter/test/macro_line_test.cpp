// SPDX-License-Identifier: Apache-2.0
// Lines of FANUC custom macros.
#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>

namespace steadyrest::nc::read {
namespace {

/// Lines of one program, with the variables that they set.
class MacroLines {
 public:
  MacroLines() { reader_.set_values(&values); }
  /// The line's only word, or one without a letter.
  Word word(const std::string& line) {
    EXPECT_TRUE(reader_.read(line, 1, 1, block_)) << line << ": " << reader_.refused().text;
    return block_.words().size() == 1 ? block_.words()[0] : Word{};
  }
  std::string fault(const std::string& line) {
    return reader_.read(line, 1, 1, block_) ? "" : reader_.refused().reason;
  }
  test::MapValues values;

 private:
  Reader reader_{Dialect::fanuc};
  Block block_;
};

TEST(MacroLine, AnAssignmentSetsAVariableAndHasNoWords) {
  MacroLines lines;
  EXPECT_EQ(lines.word("#1=2*[3+4]").letter, 0);
  EXPECT_EQ(lines.word("N20 # 101 = #1/7 ; ").letter, 0);
  EXPECT_EQ(lines.word("#[#101+3]=-#1 (five)").letter, 0);
  EXPECT_EQ(lines.values.numbers[1], 14.0);
  EXPECT_EQ(lines.values.numbers[101], 2.0);
  EXPECT_EQ(lines.values.numbers[5], -14.0);
}

// The manual, "Undefined variable": #0 is always vacant, and a variable set to it becomes vacant.
TEST(MacroLine, OnlyTheVacantVariableItselfEmptiesAnother) {
  for (const char* line : {"#1=#0", "#1 = #0 ", "#1=#0;", "#1=#0(none)"}) {
    MacroLines lines;
    lines.word(line);
    EXPECT_TRUE(std::isnan(lines.values.numbers[1])) << line;
  }
  MacroLines lines;
  EXPECT_EQ(lines.fault("#1=-#0"), "vacant_variable");
  EXPECT_FALSE(lines.values.numbers.contains(1));
}

TEST(MacroLine, ACalculatedAddressIsRoundedToItsIncrement) {
  MacroLines lines;
  lines.values.increments = {{'X', 0.001}};
  lines.values.numbers = {{1, 1.0}};
  const Word x = lines.word("X-[#1/3]");
  EXPECT_DOUBLE_EQ(x.value, -0.333);
  EXPECT_TRUE(x.calculated);
  EXPECT_TRUE(x.decimal_point);  // millimetres, whatever a number without point would mean
  EXPECT_DOUBLE_EQ(lines.word("F[#1/3]").value, 1.0 / 3.0);
  EXPECT_FALSE(lines.word("X1").calculated);
}

TEST(MacroLine, NamesTheStatementThatItDoesNotExecute) {
  MacroLines lines;
  for (const char* line : {"IF[1EQ1]G0", "X1GOTO10", "while[1LT2]", "X1DO1", "THEN#1=1"}) {
    EXPECT_EQ(lines.fault(line), "flow_control") << line;
  }
  for (const char* line : {"POPEN", "DPRNT[X#1]", "BPRNT[A]", "pclos", "SETVN500[A]"}) {
    EXPECT_EQ(lines.fault(line), "macro_output") << line;
  }
  EXPECT_EQ(lines.word("D1").letter, 'D');  // one letter is an address
}

TEST(MacroLine, AnAssignmentHasItsBlockToItselfAndAValue) {
  const std::pair<const char*, const char*> cases[] = {
      {"#1=2 X5", "macro_statement"},   {"X5 #1=2", "macro_statement"},
      {"#1=2 #2=3", "macro_statement"}, {"#1", "bad_assignment"},
      {"#1 2", "bad_assignment"},       {"#1=", "missing_value"},
      {"#=2", "bad_parameter"},         {"#1=[2", "unclosed_expression"}};
  for (const auto& [line, expected] : cases) {
    MacroLines lines;
    EXPECT_EQ(lines.fault(line), expected) << line;
    EXPECT_TRUE(lines.values.numbers.empty()) << line;  // a refused block sets nothing
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
