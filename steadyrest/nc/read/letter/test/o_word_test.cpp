// SPDX-License-Identifier: Apache-2.0
// LinuxCNC 2.9, "O Codes": labels, keywords and how many values each takes.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/letter/o_word.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>

namespace steadyrest::nc::read {
namespace {

/// What follows the letter O, with #1 = 5 and #2 = 0.5.
struct AfterO {
  explicit AfterO(const std::string& text, bool evaluate = true) {
    const test::MapValues values{{{1, 5.0}, {2, 0.5}}};
    OWord word(text, 0, values);
    accepted = word.read(flow, evaluate);
    reason = word.reason();
    length = word.length();
  }
  Flow flow{};
  bool accepted = false;
  std::string reason;
  std::size_t length = 0;
};

std::string label_of(const std::string& text) {
  return std::string{AfterO(text).flow.label.view()};
}

TEST(OWord, HasANumberANameOrACalculatedLabel) {
  EXPECT_EQ(label_of("100 sub"), "100");
  EXPECT_EQ(label_of("1 0 0 sub"), "100");
  EXPECT_EQ(label_of("007 sub"), "7");
  EXPECT_EQ(label_of("<Drill Row> call"), "drillrow");
  EXPECT_EQ(label_of("#1 if [1]"), "5");
  EXPECT_EQ(label_of("[100 + #1] endif"), "105");
  EXPECT_EQ(label_of("[2 * #2 + 0.00005] endif"), "1");  // whole within 0.0001
}

TEST(OWord, TakesAsManyValuesAsItsKeyword) {
  const std::map<std::string, std::size_t> taken = {
      {"sub", 3},      {"call", 3},  {"endsub", 1},    {"return", 1}, {"if", 1},
      {"elseif", 1},   {"while", 1}, {"repeat", 1},    {"else", 0},   {"endif", 0},
      {"endwhile", 0}, {"do", 0},    {"endrepeat", 0}, {"break", 0},  {"continue", 0}};
  for (const auto& [keyword, count] : taken) {
    const AfterO word("7 " + keyword + "[4][5][6]");
    EXPECT_TRUE(word.accepted) << keyword;
    EXPECT_EQ(word.flow.count, count) << keyword;
    // The line refuses what is left over.
    EXPECT_EQ(word.length, 2 + keyword.size() + 3 * count) << keyword;
    if (count > 0) {
      EXPECT_EQ(word.flow.values[count - 1], 3.0 + static_cast<double>(count)) << keyword;
    }
  }
  for (const char* asks : {"if", "elseif", "while", "repeat"}) {
    EXPECT_EQ(AfterO(std::string{"7 "} + asks).reason, "o_word") << asks;
  }
}

TEST(OWord, TakesThirtyArgumentsAndNoMore) {
  std::string text = "1 call";
  for (int i = 0; i < 30; ++i) {
    text += "[1]";
  }
  EXPECT_EQ(AfterO(text).flow.count, 30U);
  EXPECT_EQ(AfterO(text + "[1]").reason, "o_word");
}

TEST(OWord, OfASkippedLineAsksForNoValue) {
  EXPECT_EQ(AfterO("1 if [#<unset>]").reason, "unset_parameter");
  const AfterO skipped("1 if [#<unset>]", false);
  EXPECT_TRUE(skipped.accepted);
  EXPECT_EQ(skipped.flow.kind, FlowKind::when);
  EXPECT_EQ(AfterO("1 if [1]", false).flow.count, 0U);
}

TEST(OWord, IsRefusedForALabelOrKeywordThatIsNone) {
  for (const char* text : {"", "sub", "<> sub", "<a sub", "[1.5] sub", "[0-1] sub", "#2 sub",
                           "1 gosub", "1 subs", "1000000000 sub"}) {
    EXPECT_EQ(AfterO(text).reason, "o_word") << text;
  }
  EXPECT_EQ(AfterO("#9 sub").reason, "unset_parameter");
  EXPECT_EQ(AfterO("1 if [1/0]").reason, "division_by_zero");
  EXPECT_EQ(AfterO("1234").flow.kind, FlowKind::label);
}

TEST(OWord, ComesAfterTheDeleteMarkAndTheLineNumberOnly) {
  EXPECT_EQ(o_word_at("o1 sub"), 1U);
  EXPECT_EQ(o_word_at(" / N10 O2 if"), 8U);
  EXPECT_EQ(o_word_at("n1.5\to3"), 6U);
  for (const char* text : {"", " ", "G1 O5", "N10", "(o1)", "; o1"}) {
    EXPECT_EQ(o_word_at(text), 0U) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
