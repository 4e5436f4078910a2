// SPDX-License-Identifier: Apache-2.0
// Two stages in one: what is composed is what both would have made one after the other.
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/replace/stages.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::Workshop;
using test::write_file;

TEST(Stages, TheFirstHasItsLinesWithoutMarks) {
  const Workshop shop;
  write_file(shop.original(), "G90\r\nG1 X1\r\nG1 X2\r\nM2");
  const auto stage = with_lines(shop.original(), {{2, {"G1 X.5", "G1 X1."}}, {3, {}}});
  ASSERT_TRUE(stage.has_value());
  EXPECT_EQ(stage->text, "G90\r\nG1 X.5\r\nG1 X1.\r\nM2");
  EXPECT_EQ(stage->origin, (std::vector<std::uint32_t>{0, 1, 2, 2, 4}));
}

TEST(Stages, ALineOfTheFirstMayBeReplacedAgain) {
  const Workshop shop;
  write_file(shop.original(), "S1000\nG1 X1\nM2\n");
  const NewLines first = {{1, {"S2000"}}, {2, {"G1 X.5", "G1 X1."}}};
  const auto stage = with_lines(shop.original(), first);
  ASSERT_TRUE(stage.has_value());
  const NewLines both = composed(first, *stage, {{3, {"G1 X.9", "G1 X1."}}});
  EXPECT_EQ(both, (NewLines{{1, {"S2000"}}, {2, {"G1 X.5", "G1 X.9", "G1 X1."}}}));
}

RC_GTEST_PROP(Stages, AreTheSameOneByOneAndComposed, ()) {
  const auto lines = *rc::gen::inRange(1, 12);
  std::string program;
  for (int i = 1; i <= lines; ++i) {
    program += "N" + std::to_string(i) + "\n";
  }
  const auto some = [](std::size_t count, const std::string& letter) {
    NewLines out;
    for (std::uint32_t line = 1; line <= count; ++line) {
      if (*rc::gen::arbitrary<bool>()) {
        std::vector<std::string> texts;
        for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
          texts.push_back(letter + std::to_string(line) + "." + std::to_string(i));
        }
        out[line] = texts;
      }
    }
    return out;
  };
  const Workshop shop;
  write_file(shop.original(), program);
  const NewLines first = some(static_cast<std::size_t>(lines), "A");
  const auto stage = with_lines(shop.original(), first).value();
  const NewLines second = some(stage.origin.size() - 1, "B");
  write_file(shop.changed(), stage.text);
  const std::string one_by_one = with_lines(shop.changed(), second).value().text;
  const std::string at_once =
      with_lines(shop.original(), composed(first, stage, second)).value().text;
  RC_ASSERT(one_by_one == at_once);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
