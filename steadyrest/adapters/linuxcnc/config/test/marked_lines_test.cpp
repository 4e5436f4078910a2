// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/adapters/linuxcnc/config/marked_lines.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using testing::HasSubstr;

const std::string kText = "a\nb\nc\n";

TEST(MarkedLines, InsertAndReplaceInBlocks) {
  const std::string out = with_blocks(
      kText,
      {{.first = 2, .removed = 1, .added = {"B"}}, {.first = 4, .removed = 0, .added = {"d"}}},
      "m.ini");
  const auto lines = lines_of(out);
  ASSERT_EQ(lines.size(), 9U);
  EXPECT_EQ(lines[0], "a\n");
  EXPECT_THAT(lines[1], testing::StartsWith("# steadyrest begin "));
  EXPECT_EQ(lines[2], "# was: b\n");
  EXPECT_EQ(lines[3], "B\n");
  EXPECT_EQ(lines[4], "# steadyrest end\n");
  EXPECT_EQ(lines[5], "c\n");
  EXPECT_EQ(lines[7], "d\n");
  const auto back = without_blocks(out, "f", "m.ini");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->text, kText);
  EXPECT_THAT(back->added, testing::ElementsAre("B", "d"));
  EXPECT_EQ(back->blocks, 2U);
}

TEST(MarkedLines, KeepEditsElsewhereAndBlocksOfOthers) {
  const std::string one = with_blocks(kText, {{.first = 2, .removed = 0, .added = {"x"}}}, "1.ini");
  const std::string two = with_blocks(one, {{.first = 1, .removed = 0, .added = {"y"}}}, "2.ini");
  const auto back = without_blocks("mine\n" + two + "more\n", "f", "2.ini");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->text, "mine\n" + one + "more\n");
  EXPECT_EQ(back->blocks, 1U);
}

TEST(MarkedLines, AreRefusedWhenEdited) {
  const std::string out = with_blocks(kText, {{.first = 2, .removed = 1, .added = {"B"}}}, "m.ini");
  const auto refused = [](std::string text, std::size_t line, const char* what) {
    const auto back = without_blocks(text, "f.hal", "m.ini");
    ASSERT_FALSE(back) << text;
    EXPECT_EQ(back.error().file, "f.hal");
    EXPECT_EQ(back.error().line, line) << text;
    EXPECT_THAT(back.error().what, HasSubstr(what)) << text;
  };
  const auto with = [&out](const std::string& from, const std::string& to) {
    std::string text = out;
    return text.replace(text.find(from), from.size(), to);
  };
  refused(with("B\n", "C\n"), 2, "was edited since setup");
  refused(with("was: b", "was: bb"), 2, "was edited since setup");
  refused(with("B\n", ""), 2, "was edited since setup");
  refused(with("# steadyrest end\n", ""), 2, "has no end");
  refused(with("# steadyrest begin", "# begin"), 5, "has no beginning");
}

TEST(OwnFile, ShowsThatItWasEdited) {
  const std::string own = own_file("net a b\n", "m.ini");
  EXPECT_EQ(is_own_file(own), Own::yes);
  EXPECT_EQ(is_own_file(own + "net c d\n"), Own::edited);
  EXPECT_EQ(is_own_file("net a b\n"), Own::no);
  EXPECT_EQ(is_own_file(""), Own::no);
}

/// A text of short lines, ended by \n, \r\n or nothing.
rc::Gen<std::string> any_text(bool crlf) {
  return rc::gen::map(
      rc::gen::tuple(rc::gen::container<std::vector<std::string>>(
                         rc::gen::container<std::string>(rc::gen::element('a', 'b', ' ', '='))),
                     rc::gen::arbitrary<bool>()),
      [crlf](const std::tuple<std::vector<std::string>, bool>& made) {
        std::string out;
        for (const std::string& line : std::get<0>(made)) {
          out += line + (crlf ? "\r\n" : "\n");
        }
        if (std::get<1>(made) && !out.empty()) {
          out.erase(out.find_last_not_of("\r\n") + 1);
        }
        return out;
      });
}

TEST(MarkedLines, UndoIsExactForAnyText) {
  EXPECT_TRUE(rc::check([] {
    const std::string text = *any_text(*rc::gen::arbitrary<bool>());
    const std::size_t lines = lines_of(text).size();
    std::vector<Edit> edits;
    for (std::size_t at = 1; at <= lines + 1;) {
      at += *rc::gen::inRange<std::size_t>(0, 4);
      if (at > lines + 1) {
        break;
      }
      const std::size_t removed = *rc::gen::inRange<std::size_t>(0, 3);
      edits.push_back(
          {.first = at, .removed = std::min(removed, lines + 1 - at), .added = {"new", "newer"}});
      at += edits.back().removed + 1;
    }
    const auto back = without_blocks(with_blocks(text, edits, "m.ini"), "f", "m.ini");
    RC_ASSERT(back.has_value());
    RC_ASSERT(back->text == text);
    RC_ASSERT(back->blocks == edits.size());
  }));
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc::config
