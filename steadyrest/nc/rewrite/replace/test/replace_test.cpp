// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/replace/replace.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using read::Dialect;
using test::text_of_file;
using test::Workshop;
using test::write_file;

const std::vector<Told> kTold = {{.name = "changes", .value = "feeds"}};

/// The program with these lines replaced.
std::string changed(const Workshop& shop, const std::string& program, const NewLines& lines,
                    Dialect dialect = Dialect::linuxcnc) {
  write_file(shop.original(), program);
  const auto out = replace(shop.original(), dialect, lines, kTold);
  EXPECT_TRUE(out.has_value());
  write_file(shop.changed(), out->text);
  return out->text;
}

TEST(Replace, KeepsTheOriginalBesideWhatReplacesIt) {
  const Workshop shop;
  const std::string text =
      changed(shop, "%\nG90\nG1 X1 F10 (cut)\nM2\n", {{3, {"G1 X0.5 F10.0", "G1 X1.0 F9.0"}}});
  EXPECT_TRUE(text.starts_with("%\n(STEADYREST head made --changes feeds --blocks ")) << text;
  EXPECT_EQ(text.substr(text.find("G90")),
            "G90\n"
            ";STEADYREST was 2 G1 X1 F10 (cut)\n"
            "G1 X0.5 F10.0 ;STEADYREST new\n"
            "G1 X1.0 F9.0 ;STEADYREST new\n"
            "M2\n");
}

TEST(Replace, SaysWhichLineEachNewOneComesFrom) {
  const Workshop shop;
  write_file(shop.original(), "G90\nG1 X1 F10\nG1 X2\nM2\n");
  const auto out = replace(shop.original(), Dialect::linuxcnc,
                           {{2, {"G1 X1.1 F10.0", "G1 X2.0 F9.0"}}, {3, {}}}, kTold);
  ASSERT_TRUE(out.has_value());
  // Number 0 is no line; 1 is the head.
  EXPECT_EQ(out->origin, (std::vector<std::uint32_t>{0, 0, 1, 2, 2, 2, 3, 4}));
  EXPECT_EQ(out->replaced, 2U);
  EXPECT_EQ(out->new_lines, 2U);
}

TEST(Replace, ChangesNothingWithoutLines) {
  const Workshop shop;
  EXPECT_EQ(changed(shop, "G90\r\nM2", {}), "G90\r\nM2");
}

RC_GTEST_PROP(Replace, IsUndoneToTheByte, ()) {
  const Workshop shop;
  const auto dialect = *rc::gen::element(Dialect::linuxcnc, Dialect::fanuc, Dialect::sinumerik);
  const auto lines = *rc::gen::inRange(1, 30);
  std::string program = "G90\n";
  NewLines fresh;
  for (int i = 1; i <= lines; ++i) {
    program += *rc::gen::element<std::string>("G1 X5", "N10 G2 X1 (a) ;b", "", "( )", "\xc4%=;()");
    const bool last = i == lines;
    program += *rc::gen::element<std::string>("\n", "\r\n", last ? "" : "\n");
    if (*rc::gen::inRange(0, 3) == 0) {
      fresh[static_cast<std::uint32_t>(i) + 1] =
          std::vector<std::string>(static_cast<std::size_t>(*rc::gen::inRange(0, 4)), "G1 X1.0");
    }
  }
  const std::string text = changed(shop, program, fresh, dialect);
  const auto back = put_back(shop.changed());
  RC_ASSERT(back.has_value());
  RC_ASSERT(back->text == program);
  RC_ASSERT(strip(shop.changed(), shop.original()).has_value());
  RC_ASSERT(text_of_file(shop.original()) == program);
  // A number beyond the program's end replaces nothing.
  if (back->lines.size() == fresh.size()) {
    RC_ASSERT(changed(shop, program, back->lines, dialect) == text);
  }
}

TEST(PutBack, RefusesAGroupChangedByHandWithItsLine) {
  const Workshop shop;
  const std::string text =
      changed(shop, "G90\nG1 X1 F10\nM2\n", {{2, {"G1 X0.5 F10.0", "G1 X1.0 F9.0"}}});
  const auto fault_of = [&](const std::string& changed_text) {
    write_file(shop.changed(), changed_text);
    const auto back = put_back(shop.changed());
    return back ? std::string("passes") : std::to_string(back.error().line) + back.error().what;
  };
  EXPECT_EQ(fault_of(test::replaced(text, "G1 X1.0 F9.0 ;STEADYREST new\n", "")),
            "5a replaced line has fewer new lines than it says");
  EXPECT_EQ(fault_of(test::replaced(text, "M2\n", "G1 X3 ;STEADYREST new\n")),
            "6a new line that belongs to no replaced one");
  EXPECT_EQ(fault_of(text.substr(0, text.find("G1 X1.0"))),
            "5the program ends within a replaced line");
  EXPECT_EQ(fault_of(text), "passes");
}

TEST(PutBack, TheMarkShowsThatAnOptionWasEdited) {
  const Workshop shop;
  const std::string text = changed(shop, "G90\nG1 X1 F10\nM2\n", {{2, {"G1 X1.0 F9.0"}}});
  const auto told = read_replaced_mark(shop.changed());
  ASSERT_TRUE(told.has_value());
  ASSERT_EQ(told->size(), 2U);
  EXPECT_EQ(told->front(), kTold.front());
  EXPECT_EQ(told->back().name, kBlocksSum);
  write_file(shop.changed(), test::replaced(text, "--changes feeds", "--changes speed"));
  EXPECT_FALSE(read_replaced_mark(shop.changed()).has_value());
  EXPECT_FALSE(strip(shop.changed(), shop.original()).has_value());
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
