// SPDX-License-Identifier: Apache-2.0
// Stamps against the calendar of the standard library.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/table/stamp.hpp>

namespace steadyrest::table {
namespace {

namespace chrono = std::chrono;

constexpr std::int64_t kDay_s = 86'400;

std::string date_of(std::int64_t days, const char* pattern) {
  const chrono::year_month_day date{chrono::sys_days(chrono::days(days))};
  return fmt::format(fmt::runtime(pattern), static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

// Any second from 1970 to 2199: in the extended and the basic form, with any offset from UTC.
RC_GTEST_PROP(StampCalendar, EverySecondIsItself, ()) {
  const auto days = *rc::gen::inRange<std::int64_t>(1, 230 * 365);
  const auto of_day = *rc::gen::inRange<std::int64_t>(0, kDay_s);
  const std::int64_t instant_s = days * kDay_s + of_day;
  const int offset_min = *rc::gen::inRange(-12 * 60, 14 * 60);
  const std::int64_t there_s = instant_s + 60 * offset_min;
  const std::int64_t day = there_s / kDay_s;
  const std::int64_t second = there_s % kDay_s;
  const std::string sign = offset_min < 0 ? "-" : "+";
  const int away = std::abs(offset_min);
  const auto extended =
      stamp_of(date_of(day, "{:04}-{:02}-{:02}") +
               fmt::format("T{:02}:{:02}:{:02}{}{:02}:{:02}", second / 3600, second / 60 % 60,
                           second % 60, sign, away / 60, away % 60));
  RC_ASSERT(extended.has_value());
  RC_ASSERT(extended->whole_s == instant_s);
  RC_ASSERT(extended->zoned);
  const auto basic =
      stamp_of(date_of(day, "{:04}{:02}{:02}") +
               fmt::format("T{:02}{:02}{:02}", second / 3600, second / 60 % 60, second % 60));
  RC_ASSERT(basic.has_value());
  RC_ASSERT(basic->whole_s == there_s);
  RC_ASSERT(!basic->zoned);
}

// For every month of the 230 years the last day is a day and the next one is not.
TEST(StampCalendar, KnowsHowLongEachMonthIs) {
  for (int year = 1970; year < 2200; ++year) {
    for (unsigned month = 1; month <= 12; ++month) {
      const auto last = static_cast<unsigned>(
          chrono::year_month_day_last(chrono::year(year),
                                      chrono::month_day_last(chrono::month(month)))
              .day());
      const auto stamp = [&](unsigned day) {
        return stamp_of(fmt::format("{:04}-{:02}-{:02} 00:00:00", year, month, day));
      };
      ASSERT_TRUE(stamp(last)) << year << '-' << month;
      ASSERT_FALSE(stamp(last + 1)) << year << '-' << month;
      ASSERT_FALSE(stamp(0)) << year << '-' << month;
    }
  }
}

// The two ends of the years, and one day beyond each.
TEST(StampCalendar, EndsWithItsYears) {
  EXPECT_TRUE(stamp_of("1970-01-01T00:00:00"));
  EXPECT_TRUE(stamp_of("2199-12-31T23:59:59"));
  EXPECT_FALSE(stamp_of("2200-01-01T00:00:00"));
  EXPECT_FALSE(stamp_of("1969-12-31T00:00:00"));
}

// However many digits the fraction has, it equals a decimal reading of them.
RC_GTEST_PROP(StampCalendar, KeepsItsFraction, ()) {
  const int digits = *rc::gen::inRange(1, 10);
  const auto value = *rc::gen::inRange<std::int64_t>(
      0, static_cast<std::int64_t>(std::lround(std::pow(10.0, digits))));
  const std::string text = fmt::format("2026-11-22T23:47:06.{:0{}}", value, digits);
  const auto stamp = stamp_of(text);
  RC_ASSERT(stamp.has_value());
  RC_ASSERT(stamp->decimals == digits);
  RC_ASSERT(std::abs(stamp->fraction_s - static_cast<double>(value) / std::pow(10.0, digits)) <=
            1e-15);
}

}  // namespace
}  // namespace steadyrest::table
