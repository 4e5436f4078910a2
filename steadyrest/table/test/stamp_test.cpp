// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/table/stamp.hpp>

namespace steadyrest::table {
namespace {

// From `date -u -d … +%s`.
constexpr std::int64_t kInstant_s = 1795391226;  // 2026-11-22T23:47:06Z

// Basic and extended forms of ISO 8601, with T or a blank, with point or comma.
TEST(Stamp, IsReadInEachSpelling) {
  for (const auto* text :
       {"2026-11-22T23:47:06", "2026-11-22 23:47:06", "2026-11-22T23:47:06Z",
        "2026-11-23T00:47:06+01:00", "2026-11-23T00:47:06+01", "2026-11-22T18:17:06-0530",
        "20261122T234706Z", "2026-11-22t23:47:06z", "2026-11-22T23:47:06.000"}) {
    const auto stamp = stamp_of(text);
    ASSERT_TRUE(stamp) << text;
    EXPECT_EQ(stamp->whole_s, kInstant_s) << text;
    EXPECT_EQ(stamp->fraction_s, 0.0) << text;
  }
  EXPECT_EQ(stamp_of("2026-11-22T23:47")->whole_s, kInstant_s - 6);
  EXPECT_EQ(stamp_of("1970-01-01T00:00:00")->whole_s, 0);
  EXPECT_EQ(stamp_of("2024-02-29T00:00:00Z")->whole_s, 1709164800);
}

// Seven decimals after a point or a comma; whether a zone was given is stored separately from the
// instant.
TEST(Stamp, HasItsFractionAndItsZone) {
  const auto point = stamp_of("2026-11-22T23:47:06.1234567");
  const auto comma = stamp_of("2026-11-22T23:47:06,1234567+02:00");
  ASSERT_TRUE(point && comma);
  EXPECT_DOUBLE_EQ(point->fraction_s, 0.1234567);
  EXPECT_EQ(point->decimals, 7);
  EXPECT_FALSE(point->zoned);
  EXPECT_DOUBLE_EQ(comma->fraction_s, 0.1234567);
  EXPECT_TRUE(comma->zoned);
}

// Dates that do not exist, half a separator, anything behind: not a stamp.
TEST(Stamp, IsNothingElse) {
  for (const auto* text : {"", "0.001", "08:00:00", "2026-11-22", "2026-02-29T00:00:00",
                           "2026-13-01T00:00:00", "2026-11-22T24:00:00", "2026-11-22T23:60:00",
                           "2026-11-22T23:47:06x", "2026-11-22T23:47:06.", "2026-1122T23:47:06",
                           "2026-11-22T23:47:06+", "2026-11-22T23:47:06+1", "1969-12-31T23:59:59",
                           "2026-11-22T23:47:06+01:0", "20261122", "2026-11-22T2347:06"}) {
    EXPECT_FALSE(stamp_of(text)) << text;
  }
}

// `date -u -d '2026-11-02 08:00:00' +%s` = 1793606400.
TEST(Stamp, ReadsTheDatesOfRecordersAndSpreadsheets) {
  for (const auto* text :
       {"2026-11-02T08:00:00", "02.11.2026 08:00:00", "2.11.2026 8:00:00", "02.11.2026, 08:00",
        "2026/11/02 08:00:00", "2026/11/2 8:00", "2026.11.02 08:00:00", "02-Nov-2026 08:00:00",
        "2-NOV-26 08:00:00", "02 nov 2026 08:00:00", "02/Nov/2026 08:00:00",
        "2026/11/02 08:00:00 AM", "02.11.2026 8:00 am", "02.11.2026 08:00:00.000",
        "02.11.2026 08:00:00:000", "02.11.2026  08:00:00,000"}) {
    const auto stamp = stamp_of(text);
    ASSERT_TRUE(stamp) << text;
    EXPECT_EQ(stamp->whole_s, 1793606400) << text;
    EXPECT_FALSE(stamp->ambiguous) << text;
  }
  EXPECT_EQ(stamp_of("02.11.2026 12:00:00 AM")->whole_s, 1793606400 - 8 * 3600);
  EXPECT_EQ(stamp_of("02.11.2026 01:00:00 PM")->whole_s, 1793606400 + 5 * 3600);
  EXPECT_DOUBLE_EQ(stamp_of("02.11.2026 08:00:00:125")->fraction_s, 0.125);
  EXPECT_EQ(stamp_of("02.11.2026 08:00:00:125")->decimals, 3);
  for (const auto* text : {"02.13.2026 08:00:00", "31.02.2026 08:00:00", "02.11.26 08:00:00",
                           "26-11-02 08:00:00", "02.11.2026 13:00:00 PM", "02.11/2026 08:00:00",
                           "02-Novem-2026 08:00", "02.11.2026 08:00:00:12", "02 11 2026 08:00:00",
                           "13/13/2026 08:00:00", "2.11 08:00", "02.11.2026"}) {
    EXPECT_FALSE(stamp_of(text)) << text;
  }
}

TEST(Stamp, SaysWhetherTheDayOrTheMonthMayComeFirst) {
  EXPECT_TRUE(stamp_of("02/11/2026 08:00:00")->ambiguous);
  EXPECT_TRUE(stamp_of("02-11-2026 08:00:00")->ambiguous);
  EXPECT_FALSE(stamp_of("05/05/2026 08:00:00")->ambiguous);
  EXPECT_EQ(stamp_of("22/11/2026 08:00:00")->order, DateOrder::day_first);
  EXPECT_EQ(stamp_of("11/22/2026 08:00:00")->order, DateOrder::month_first);
  EXPECT_EQ(stamp_of("11/22/2026 08:00:00")->whole_s, stamp_of("22/11/2026 08:00:00")->whole_s);
  // What another row proved decides; a row that contradicts it is none.
  EXPECT_EQ(stamp_of("02/11/2026 08:00:00", DateOrder::day_first)->whole_s, 1793606400);
  EXPECT_EQ(stamp_of("11/02/2026 08:00:00", DateOrder::month_first)->whole_s, 1793606400);
  EXPECT_FALSE(stamp_of("22/11/2026 08:00:00", DateOrder::month_first));
  EXPECT_FALSE(stamp_of("11/22/2026 08:00:00", DateOrder::day_first));
}

// The count since 1970 has no number for a leap second: `date -u -d 2016-12-31T23:59:60Z +%s` is an
// error too, and 1483228800 is midnight.
TEST(Stamp, IsNoLeapSecond) {
  EXPECT_EQ(stamp_of("2016-12-31T23:59:59Z")->whole_s, 1483228799);
  EXPECT_EQ(stamp_of("2017-01-01T00:00:00Z")->whole_s, 1483228800);
  for (const auto* text : {"2016-12-31T23:59:60Z", "2016-12-31 23:59:60.5", "20161231T235960Z",
                           "2017-01-01T00:59:60+01:00", "2026-11-22T23:47:60"}) {
    EXPECT_FALSE(stamp_of(text)) << text;
  }
}

// The count goes up by one from each second of a day to the next, even on a day with a leap second.
TEST(Stamp, GivesEachSecondItsOwnNumber) {
  std::int64_t last = stamp_of("2016-12-30T23:59:59Z")->whole_s;
  for (int s = 0; s < 86'400; ++s) {
    const std::string text =
        fmt::format("2016-12-31T{:02}:{:02}:{:02}Z", s / 3600, s / 60 % 60, s % 60);
    const auto stamp = stamp_of(text);
    ASSERT_TRUE(stamp && stamp->whole_s == last + 1) << text;
    last = stamp->whole_s;
  }
}

}  // namespace
}  // namespace steadyrest::table
