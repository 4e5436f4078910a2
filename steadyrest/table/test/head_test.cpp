// SPDX-License-Identifier: Apache-2.0
// Column names and units as loggers, spreadsheets and analysers write them.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/table/head.hpp>

namespace steadyrest::table {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(UnitOf, IsOneFormForEverySpelling) {
  const std::pair<std::string_view, std::string_view> cases[] = {{"[mm]", "mm"},
                                                                 {"(mm)", "mm"},
                                                                 {"mm", "mm"},
                                                                 {"MM", "mm"},
                                                                 {"[µm]", "um"},
                                                                 {"\xCE\xBCm", "um"},
                                                                 {"microns", "um"},
                                                                 {"[°C]", "c"},
                                                                 {"degC", "c"},
                                                                 {"Celsius", "c"},
                                                                 {"[1/min]", "rpm"},
                                                                 {"U/min", "rpm"},
                                                                 {"min-1", "rpm"},
                                                                 {"rev/min", "rpm"},
                                                                 {"m/s^2", "m/s2"},
                                                                 {"m/s²", "m/s2"},
                                                                 {"((m/s²)/N)", "m/s2/n"},
                                                                 {"[ s ]", "s"},
                                                                 {"sec", "s"},
                                                                 {"\"[mm]\"", "mm"},
                                                                 {"[%]", "1"},
                                                                 {"-", "1"},
                                                                 {"counts", "1"},
                                                                 {"mm/min", "mm/min"}};
  for (const auto& [written, unit] : cases) {
    EXPECT_EQ(unit_of(written), unit) << written;
  }
}

// A word that is no unit belongs to the name.
TEST(UnitOf, IsEmptyForOtherWords) {
  for (const std::string_view word : {"left", "(left)", "", "[]", "metre", "12", "kg"}) {
    EXPECT_EQ(unit_of(word), "") << word;
  }
}

TEST(NameOf, EndsInTheUnit) {
  const std::pair<std::string_view, std::string_view> cases[] = {
      {"z [µm]", "z_um"},
      {"z (mm)", "z_mm"},
      {"z_um", "z_um"},
      {"\"spindle speed [1/min]\"", "spindle speed_rpm"},
      {"  t [s]  ", "t_s"},
      {"real ((m/s²)/N)", "real_m/s2/n"},
      {"load (left)", "load (left)"},
      {"load (left) [N]", "load (left)_n"},
      {"share [%]", "share"},
      {"(mm)", "(mm)"},
      {"", ""}};
  for (const auto& [written, name] : cases) {
    EXPECT_EQ(name_of(written), name) << written;
  }
}

using Fields = std::vector<std::string_view>;

// A row of ones and blanks may be numbers; one true unit settles it.
TEST(AreUnits, NeedsOneThatIsCertainlyAUnit) {
  EXPECT_TRUE(are_units(Fields{"s", "", "°C"}));
  EXPECT_TRUE(are_units(Fields{"[s]", "-", "[%]"}));
  EXPECT_FALSE(are_units(Fields{"1", "1", ""}));
  EXPECT_FALSE(are_units(Fields{"s", "left"}));
  EXPECT_FALSE(are_units(Fields{"0.5", "mm"}));
  EXPECT_FALSE(are_units(Fields{}));
}

TEST(AddUnits, EndsEachNameOnce) {
  Head head;
  head.name = {"t", "z_um", "note", "Z_MM", ""};
  const auto fault = add_units(Fields{"s", "µm", "-", "mm", "N"}, 2, head);
  EXPECT_FALSE(fault);
  EXPECT_THAT(head.name, ElementsAre("t_s", "z_um", "note", "Z_MM", ""));
}

TEST(AddUnits, ToleratesARowThatIsShorterOrLonger) {
  Head head;
  head.name = {"t", "z"};
  EXPECT_FALSE(add_units(Fields{"s"}, 2, head));
  EXPECT_THAT(head.name, ElementsAre("t_s", "z"));
  EXPECT_FALSE(add_units(Fields{"", "um", "N", "N"}, 2, head));
  EXPECT_THAT(head.name, ElementsAre("t_s", "z_um"));
}

// `z_um` under `mm`: a thousand times too much, whichever is right.
TEST(AddUnits, RefusesASecondUnit) {
  Head head;
  head.name = {"t_s", "z_um"};
  const auto fault = add_units(Fields{"s", "mm"}, 3, head);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->line, 3U);
  EXPECT_THAT(fault->what, HasSubstr("the unit of z_um is \"mm\""));
}

TEST(Head, FindsTheFirstColumnOfAName) {
  Head head;
  head.name = {"t_s", "", "z_um", "z_um"};
  EXPECT_EQ(head.place("z_um"), 2U);
  EXPECT_FALSE(head.place("z_mm"));
}

// Only where it matters: columns without a name are ignored, and `only` asks about one.
TEST(Head, RefusesANameThatAppearsTwice) {
  Head head;
  head.line = 4;
  head.name = {"t_s", "", "", "z_um"};
  EXPECT_FALSE(head.twice());
  head.name = {"t_s", "z_um", "x", "z_um"};
  const auto fault = head.twice();
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->line, 4U);
  EXPECT_THAT(fault->what, HasSubstr("z_um appears twice"));
  EXPECT_TRUE(head.twice("z_um"));
  EXPECT_FALSE(head.twice("t_s"));
}

}  // namespace
}  // namespace steadyrest::table
