// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/machine/dialect.hpp>
#include <steadyrest/nc/rewrite/text/replaced_text.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using read::Dialect;

// Truth: the line itself. Any byte but a line end may be in a program.
RC_GTEST_PROP(ReplacedText, KeepsAnyLineToTheByte, ()) {
  const auto dialect = *rc::gen::element(Dialect::linuxcnc, Dialect::fanuc, Dialect::sinumerik);
  std::string line;
  for (const int byte : *rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 256))) {
    line += byte == '\n' || byte == '\r' ? ' ' : static_cast<char>(byte);
  }
  const auto count = static_cast<std::size_t>(*rc::gen::inRange(0, 400));
  const std::string text = was_text(dialect, line, count);
  const auto was = read_was(text);
  RC_ASSERT(was.has_value());
  RC_ASSERT(was->line == line);
  RC_ASSERT(was->new_lines == count);
  RC_ASSERT(is_inserted(text));
  RC_ASSERT(!is_new(text) || line.find("STEADYREST new") != std::string::npos);
}

TEST(ReplacedText, IsAsTheReadmeShowsIt) {
  EXPECT_EQ(was_text(Dialect::sinumerik, "N130 G3 X66 (a)", 2),
            ";STEADYREST was 2 N130 G3 X66 (a)");
  EXPECT_EQ(was_text(Dialect::fanuc, "N130 G3 X66 (a)", 1),
            "(STEADYREST was 1 N130 G3 X66 =28a=29)");
  EXPECT_EQ(new_text(Dialect::linuxcnc, "G1 X1 F3"), "G1 X1 F3 ;STEADYREST new");
  EXPECT_EQ(new_text(Dialect::fanuc, "G1 X1 F3"), "G1 X1 F3 (STEADYREST new)");
}

TEST(ReplacedText, IsNoOtherComment) {
  for (const char* line : {"G1 X5 (STEADYREST newer)", "(STEADYREST 3)", "STEADYREST new",
                           ";STEADYREST was", ";STEADYREST was x G1", "(STEADYREST was 1 =4)",
                           "(STEADYREST was 1 =GG)", ";STEADYREST was 3"}) {
    EXPECT_FALSE(is_new(line)) << line;
    EXPECT_FALSE(read_was(line).has_value()) << line;
  }
  EXPECT_TRUE(is_new("G1 X5 ;STEADYREST new"));
}

TEST(ReplacedText, LeavesLinesThatWouldNotFitIntoABlock) {
  const std::string line(234, 'X');
  EXPECT_TRUE(too_long_to_keep(Dialect::linuxcnc, line));
  EXPECT_FALSE(too_long_to_keep(Dialect::linuxcnc, line.substr(10)));
  // Each bracket takes three characters.
  EXPECT_TRUE(too_long_to_keep(Dialect::fanuc, std::string(80, '(')));
  EXPECT_FALSE(too_long_to_keep(Dialect::sinumerik, std::string(80, '(')));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
