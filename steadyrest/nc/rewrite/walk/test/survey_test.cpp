// SPDX-License-Identifier: Apache-2.0
// What a run through the whole program tells of its lines.
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using ::testing::ElementsAre;
using Interval = std::pair<std::uint64_t, std::uint64_t>;

Survey survey_of(const std::string& program, read::Dialect dialect = read::Dialect::linuxcnc) {
  test::Workshop shop;
  shop.config.dialect = dialect;
  test::write_file(shop.original(), program);
  return survey(shop.original(), shop.config).value();
}

std::vector<std::uint32_t> repeated_lines(const Survey& found) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t line = 0; line < 100; ++line) {
    if (found.is_repeated(line)) {
      out.push_back(line);
    }
  }
  return out;
}

// Within a loop or a condition a line counts as repeated, however often it runs.
TEST(Survey, FindsWhatMayRunMoreOrLessThanOnce) {
  EXPECT_THAT(repeated_lines(survey_of("G21\nG0 X1\nM2\n")), ElementsAre());
  const auto loop =
      repeated_lines(survey_of("G21\no1 repeat [1]\nG0 X1\nG0 X2\no1 endrepeat\nM2\n"));
  EXPECT_THAT(loop, testing::IsSupersetOf({3U, 4U}));
  EXPECT_THAT(loop, testing::Each(testing::AllOf(testing::Ge(2U), testing::Le(5U))));
  const auto branch = repeated_lines(survey_of("o1 if [1]\nG0 X1\no1 endif\nG0 X2\nM2\n"));
  EXPECT_THAT(branch, testing::Contains(2U));
  EXPECT_THAT(branch, testing::Not(testing::Contains(4U)));
}

// LinuxCNC applies a tool's length at G43; a SINUMERIK by its cutting edge D.
TEST(Survey, FindsTheLinesBetweenAToolAndItsLength) {
  EXPECT_THAT(survey_of("T1 M6\nG0 X1\nG43 H1\nG0 X2\nT2 M6\nG43.1 Z1\nM2\n").without_length,
              ElementsAre(Interval(1, 3), Interval(5, 6)));
  EXPECT_THAT(survey_of("T1 M6 G43 H1\nG0 X1\nM2\n").without_length, ElementsAre(Interval(1, 1)));
  EXPECT_THAT(survey_of("G43 H1\nG49\nM2\n").without_length, ElementsAre());
  EXPECT_THAT(survey_of("T1 M6\nD1\nG0 X2\nM30\n", read::Dialect::sinumerik).without_length,
              ElementsAre(Interval(1, 2)));
  EXPECT_THAT(survey_of("T1 M6\nD0\nD2\nM30\n", read::Dialect::sinumerik).without_length,
              ElementsAre(Interval(1, 3)));
}

// LinuxCNC ends at M2, wherever that is.
TEST(Survey, EndsWhereTheProgramDoes) {
  EXPECT_EQ(survey_of("G21\nM2\nG0 X1\n").end_line, 2U);
  EXPECT_EQ(survey_of("%\nG21\nG0 X1\n%\n").end_line, 4U);
}

TEST(Survey, RunsBothPositionsOfBlockDelete) {
  EXPECT_EQ(survey_of("G21\nM2\n").other, nullptr);
  const Survey both = survey_of("T1 M6\nG0 X1\n/G43 H1\n/M2\nG43 H1\nM2\n");
  EXPECT_EQ(both.end_line, 4U);
  ASSERT_NE(both.other, nullptr);
  EXPECT_EQ(both.other->end_line, 6U);
  EXPECT_THAT(both.other->without_length, ElementsAre(Interval(1, 5)));
}

// Truth: a set, and a count of each.
RC_GTEST_PROP(Survey, MarksWhatComesAgain, ()) {
  Survey found;
  std::vector<bool> seen;
  std::set<std::uint32_t> once;
  std::set<std::uint32_t> more;
  for (int i = *rc::gen::inRange(0, 60); i > 0; --i) {
    const auto line = static_cast<std::uint32_t>(*rc::gen::inRange(0, 40));
    const bool again = *rc::gen::inRange(0, 8) == 0;
    found.mark(line, seen, again);
    if (!once.insert(line).second || again) {
      more.insert(line);
    }
  }
  RC_ASSERT(repeated_lines(found) == std::vector<std::uint32_t>(more.begin(), more.end()));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
