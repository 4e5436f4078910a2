// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/offline/log/test/log_text.hpp>

namespace steadyrest::thermal::offline {
namespace {

using test::kRows;
using test::log_text;
using test::parsed;
using test::Row;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ThermalLog, SingleReadingsThatCannotBeAreLeftOut) {
  const Log log = parsed(log_text([](int i, Row& row) { row.z = i == 40 ? "99999" : row.z; }));
  EXPECT_TRUE(std::isnan(log.displacement[0].value[40]));
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("day.csv:42: z_um = 99999 is implausible")));
}

TEST(ThermalLog, ReadingsThatNoMachineCanHaveAreLeftOutAndCounted) {
  const Log half_an_hour = parsed(log_text([](int i, Row& row) {
    if (i >= 100 && i < 130) {
      row.t = "95";
    }
  }));
  EXPECT_TRUE(std::isnan(half_an_hour.temperature[0].value[110]));
  EXPECT_EQ(half_an_hour.temperature[0].value[130], 21.3);
  EXPECT_THAT(
      half_an_hour.notes,
      ElementsAre(HasSubstr("day.csv:102: t1_c is implausible in 30 rows, starting here (95 °C)"),
                  HasSubstr("t1_c has gaps longer than 10 min")));
  const Log now_and_then = parsed(log_text([](int i, Row& row) {
    // 85 °C is what a DS18B20 sensor shows after a reset.
    if (i % 40 == 7) {
      row.t = "85";
    }
  }));
  EXPECT_NEAR(now_and_then.temperature[0].value[47], 20.47, 1e-9) << "bridged";
  EXPECT_THAT(now_and_then.notes, ElementsAre(HasSubstr("day.csv:9: t1_c is implausible in 10")));
}

TEST(ThermalLog, AStepThatNoMachineCanMakeIsLeftOut) {
  const Log log = parsed(log_text([](int i, Row& row) {
    if (i >= 100 && i < 130) {
      row.t = "60";
    }
  }));
  EXPECT_TRUE(std::isnan(log.temperature[0].value[110]));
  EXPECT_THAT(log.notes,
              ElementsAre(HasSubstr("is implausible in 30 rows"), HasSubstr("has gaps")));
  const Log dead = parsed(log_text([](int /*i*/, Row& row) { row.t = "149.9"; }));
  EXPECT_TRUE(dead.temperature.empty());
}

// 60 °C only in the first row: the second row contradicts it, and all others confirm the second.
TEST(ThermalLog, AWrongFirstReadingDoesNotSpeakForTheOthers) {
  const Log log = parsed(log_text([](int i, Row& row) { row.t = i == 0 ? "60" : row.t; }));
  ASSERT_EQ(log.temperature.size(), 1U);
  EXPECT_TRUE(std::isnan(log.temperature[0].value[0]));
  EXPECT_EQ(log.temperature[0].value[1], 20.01);
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("day.csv:2: t1_c is implausible in 1 rows"),
                                     HasSubstr("has gaps")));
}

// Milliseconds in a column of seconds: a test of 400 min would last nine months.
TEST(ThermalLog, RowsThatAreHoursApartAreAWrongUnit) {
  const auto spread = [](double factor) {
    return parse_log(log_text([factor](int, Row& row) { row.time_s *= factor; }), "day.csv");
  };
  EXPECT_TRUE(spread(10.0).has_value());
  const auto wrong = spread(1000.0);
  ASSERT_FALSE(wrong.has_value());
  EXPECT_THAT(wrong.error().what, HasSubstr("1000.0 min apart in time_s"));
  EXPECT_THAT(wrong.error().to_do, HasSubstr("unit"));
}

TEST(ThermalLog, ATimeThatCannotBeIsNamedWithItsRow) {
  const auto log = parse_log(log_text([](int i, Row& row) {
                               if (i == kRows - 1) {
                                 row.time_s = 1e300;
                               }
                             }),
                             "day.csv");
  ASSERT_FALSE(log.has_value());
  EXPECT_EQ(log.error().line, 401U);
  EXPECT_THAT(log.error().what, HasSubstr("time_s = 1e+300 is not a time"));
}

TEST(ThermalLog, ADisplacementThatHardlyMovesMayHaveAnotherUnit) {
  const Log log =
      parsed(log_text([](int i, Row& row) { row.z = fmt::format("{:.6f}", 0.0001 * i); }));
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("z_um moves by 0.0399 µm in all")));
}

}  // namespace
}  // namespace steadyrest::thermal::offline
