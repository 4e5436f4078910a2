// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/page/shared/json_numbers.hpp>
#include <steadyrest/apps/page/shared/page.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::apps::page {
namespace {

// printf's six digits are the truth, over 600 decades and both signs.
TEST(ShortNumber, HasTheSixDigitsThatPrintfGives) {
  for (int decade = -290; decade <= 300; decade += 7) {
    for (const double mantissa : {1.0, 1.2345678, 3.14159265358979, 9.87654321, 9.999999}) {
      for (const double sign : {1.0, -1.0}) {
        const double value = sign * mantissa * std::pow(10.0, decade);
        const double truth = std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
        EXPECT_NEAR(short_number(value), truth, 1e-14 * std::abs(truth)) << value;
      }
    }
  }
}

TEST(ShortNumber, KeepsWhatHasNoDigits) {
  EXPECT_EQ(short_number(0.0), 0.0);
  EXPECT_TRUE(std::isnan(short_number(kernel::units::kNan)));
  EXPECT_EQ(short_number(kernel::units::kInfinity), kernel::units::kInfinity);
  EXPECT_EQ(short_number(std::numeric_limits<double>::denorm_min()), 0.0) << "too small to draw";
}

// A page's size is in these columns: what is written is short, and a gap is null.
TEST(ShortNumbers, AreWrittenShortWithGapsAsNull) {
  const auto column = short_numbers({1.0 / 3.0, kernel::units::kNan, 2.0, -1e-7 / 3.0});
  EXPECT_EQ(text_of(column), "[0.333333,null,2.0,-3.33333e-08]");
}

// Whatever the data contain, the page returns them to a JSON reader, and its script element ends
// where it should.
TEST(Page, GivesItsDataBackWhateverTheyHold) {
  const std::string hostile = "</script><!--<script>\"\\\n\t\u2028 <b>µm</b> & ]]>";
  Json data = page_head("steadyrest-test/1");
  data["text"] = hostile;
  data["<key>"] = {1, 2};
  const std::string with = to_html(text_of(data));
  const std::string without = to_html("");
  // Only the data differ: they are where the two pages diverge.
  std::size_t place = 0;
  while (with[place] == without[place]) {
    ++place;
  }
  const std::string inside = with.substr(place, with.size() - without.size());
  EXPECT_EQ(inside.find('<'), std::string::npos);
  EXPECT_EQ(with.substr(place + inside.size()), without.substr(place));
  EXPECT_EQ(Json::parse(inside), data);
}

TEST(Page, BeginsWithItsSchemaAndTheVersion) {
  const Json head = page_head("steadyrest-test/1");
  ASSERT_EQ(head.size(), 2U);
  EXPECT_EQ(head.begin().key(), "schema");
  EXPECT_EQ(head["schema"], "steadyrest-test/1");
  EXPECT_FALSE(head["version"].get<std::string>().empty());
}

}  // namespace
}  // namespace steadyrest::apps::page
