// SPDX-License-Identifier: Apache-2.0
// What the lines of a changed program are, from its text alone. The mark is line 1.
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/tube/changed_lines.hpp>
#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::TubeShop;
using Kind = ChangedLines::Kind;

TEST(ChangedLines, KnowsWhatEachLineIs) {
  const TubeShop shop;
  shop.change("G21 G90\nG1 X1 F9\nG1 X2 (two)\nG1 X3\nM2\n",
              {{2, {"G1 X0.5 F9.0", "X1"}}, {3, {"G1 X2 (two)", "F5.0"}}, {4, {}}});
  const auto lines = ChangedLines::compare(shop.original(), shop.changed());
  ASSERT_TRUE(lines.has_value()) << lines.error().what;
  const std::vector<Kind> truth = {Kind::head,  Kind::head,  Kind::kept, Kind::was,
                                   Kind::fresh, Kind::fresh, Kind::was,  Kind::same,
                                   Kind::fresh, Kind::was,   Kind::kept};
  const std::vector<std::uint32_t> origins = {0, 0, 1, 2, 2, 2, 3, 3, 3, 4, 5};
  for (std::uint32_t line = 1; line < truth.size(); ++line) {
    EXPECT_EQ(lines->kind(line), truth[line]) << line;
    EXPECT_EQ(lines->origin(line), origins[line]) << line;
  }
  EXPECT_EQ(lines->in_place_of(1), ChangedLines::kNone);
  EXPECT_EQ(lines->in_place_of(2), 2U);
  EXPECT_EQ(lines->in_place_of(4), 0U);
  EXPECT_EQ(lines->in_place_of(99), ChangedLines::kNone);
  EXPECT_EQ(lines->place_of(3), 6U);
  EXPECT_EQ(lines->place_of(99), 0U);
  EXPECT_EQ(lines->replaced(), 3U);
  EXPECT_EQ(lines->fresh(), 4U);
}

// A comment can stop LinuxCNC (ABORT,…), and a parameter can outlive the program.
TEST(ChangedLines, RefusesWhatANewLineHides) {
  const TubeShop shop;
  const auto fault = [&](const std::string& old, const std::string& fresh) {
    shop.change("G21\n" + old + "\nM2\n", {{2, {fresh}}});
    const auto lines = ChangedLines::compare(shop.original(), shop.changed());
    return lines ? "" : std::to_string(lines.error().line) + " " + lines.error().what;
  };
  const std::string comment = "4 a new line has a comment that the original does not have";
  EXPECT_EQ(fault("G1 X1 (one)", "G1 X1.1 (one)"), "");
  EXPECT_EQ(fault("G1 X1 (one)", "G1 X1.1 (two)"), comment);
  EXPECT_EQ(fault("G1 X1 (one)", "G1 (one) X1.1 (ABORT,no)"), comment);
  EXPECT_EQ(fault("G1 X1", "G1 X1.1 (unclosed"), comment);
  EXPECT_EQ(fault("G1 X1 ;one", "G1 X1.1 ;one"), "");
  EXPECT_EQ(fault("G1 X1", "G1 X#1"), "4 a new line names a parameter");
  EXPECT_EQ(fault("G1 X1 (#1)", "G1 X1.1 (#1)"), "") << "a comment names none";
  EXPECT_EQ(fault("G1 X#1 (a)", "G1 X#1 (a)"), "") << "the line itself";
}

// Truth: which lines were given new ones.
RC_GTEST_PROP(ChangedLines, FindsTheLinesThatWereReplaced, ()) {
  const TubeShop shop;
  const auto count = static_cast<std::uint32_t>(*rc::gen::inRange(1, 30));
  std::string program = "G21\n";
  NewLines fresh;
  for (std::uint32_t line = 2; line <= count; ++line) {
    program += "G1 X" + std::to_string(line) + *rc::gen::element<std::string>("\n", "\r\n");
    if (*rc::gen::inRange(0, 3) == 0) {
      fresh[line].resize(static_cast<std::size_t>(*rc::gen::inRange(0, 4)), "G1 X0.5");
    }
  }
  shop.change(program, fresh);
  const auto lines = ChangedLines::compare(shop.original(), shop.changed());
  RC_ASSERT(lines.has_value());
  RC_ASSERT(lines->replaced() == fresh.size());
  std::uint32_t at = fresh.empty() ? 1 : 2;  // behind the mark
  for (std::uint32_t line = 1; line <= count; ++line) {
    const auto found = fresh.find(line);
    RC_ASSERT(lines->place_of(line) == at);
    RC_ASSERT((lines->in_place_of(line) == ChangedLines::kNone) == (found == fresh.end()));
    at += 1 + (found == fresh.end() ? 0U : static_cast<std::uint32_t>(found->second.size()));
  }
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
