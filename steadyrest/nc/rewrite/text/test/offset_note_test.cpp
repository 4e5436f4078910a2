// SPDX-License-Identifier: Apache-2.0
// Where corrections are noted, by LinuxCNC's table of parameters: #5221 … #5229 are X Y Z A B C U V
// W of G54, each further work offset is 20 up. What the texts do, by the interpreter.
#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/text/linuxcnc_text.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr std::string_view kLettersInTable = "XYZABCUVW";
constexpr int kOffsetStep = 20;

/// The number of an axis in G54.
int in_g54(char letter) {
  return 5221 + static_cast<int>(kLettersInTable.find(letter));
}

TEST(OffsetNote, OfAMillIsInTheAxesThatItLacks) {
  const Way mill;
  const auto numbers = [&](char letter) {
    const OffsetNote note = offset_note(mill, letter).value();
    return std::pair(note.sum + kOffsetStep, note.offset + kOffsetStep);
  };
  EXPECT_EQ(numbers('Z'), std::pair(5229, 5228));  // W, V
  EXPECT_EQ(numbers('Y'), std::pair(5227, 5226));  // U, C
  EXPECT_EQ(numbers('X'), std::pair(5225, 5224));  // B, A
}

// Two slots for each axis that has a note, none of them an axis of the machine's, none shared.
RC_GTEST_PROP(OffsetNote, NeverMeetsAnAxisOrAnotherNote, ()) {
  Way way;
  way.axes.clear();
  for (const char letter : kLettersInTable) {
    way.axes += *rc::gen::arbitrary<bool>() ? std::string(1, letter) : "";
  }
  RC_PRE(!way.axes.empty());
  std::set<int> taken;
  for (const char letter : way.axes) {
    taken.insert(in_g54(letter) - kOffsetStep);
  }
  std::size_t notes = 0;
  for (const char letter : std::string_view("XYZUVW")) {
    const auto note = offset_note(way, letter);
    if (way.axes.find(letter) == std::string::npos || !note) {
      continue;
    }
    ++notes;
    RC_ASSERT(taken.insert(note->sum).second);
    RC_ASSERT(taken.insert(note->offset).second);
  }
  RC_ASSERT(*taken.begin() >= 5201 && *taken.rbegin() <= 5209);
  // There is room for a note in every two free letters of A, B, C, U, V and W.
  const auto linear = static_cast<std::size_t>(
      std::ranges::count_if(way.axes, [](char c) { return c < 'A' || c > 'C'; }));
  const auto slots =
      static_cast<std::size_t>(std::ranges::count_if(way.axes, [](char c) { return c < 'X'; }));
  RC_ASSERT(notes == std::min(linear, (6 - slots) / 2));
}

TEST(NamesNote, InAnyOfTheNineWorkOffsets) {
  const Way mill;
  for (int offset = 0; offset < 9; ++offset) {
    for (const char letter : kLettersInTable) {
      const int number = in_g54(letter) + kOffsetStep * offset;
      const bool noted = mill.axes.find(letter) == std::string::npos;
      EXPECT_EQ(names_note(mill, fmt::format("G1 X[#{}+1]", number)), noted) << number;
    }
  }
  EXPECT_TRUE(names_note(mill, "# 5 2 29 = 1"));
  for (const char* line : {"#52290", "#5230", "#5209", "#5409", "5229", "#4294972525", ""}) {
    EXPECT_FALSE(names_note(mill, line)) << line;
  }
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
