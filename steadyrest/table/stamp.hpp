// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace steadyrest::table {

/// Which of two numbers in a date is the day.
enum class DateOrder : std::uint8_t {
  unknown,  ///< the stamp does not show it, or has no such numbers
  day_first,
  month_first
};

/// A date with the time of day.
struct Stamp {
  std::int64_t whole_s = 0;              ///< since 1970-01-01 0:00, in UTC if the zone is given
  double fraction_s = 0.0;               ///< 0 … 1
  bool zoned = false;                    ///< Z or an offset from UTC was written
  int decimals = 0;                      ///< digits of the fraction
  DateOrder order = DateOrder::unknown;  ///< that the date proves, as 11/22/2026 does
  bool ambiguous = false;                ///< 02/11/2026: read as day first, but may be either
};

/// ISO 8601-1:2019: `2026-11-22T23:47:06`, a blank instead of the T, `20261122T234706`; seconds may
/// be missing or have a fraction after a point, a comma or a colon; `Z`, `+01:00`, `+0100` and
/// `+01` name the zone. Dates also as `2026/11/22`, `22.11.2026` (day first), `22-Nov-2026`,
/// `22-Nov-26` and, in either order, `22/11/2026` and `22-11-2026`; `order` is what other stamps of
/// the file proved. Times also with `AM` or `PM`. Years 1970 … 2199. Empty: the field is no such
/// stamp, or a leap second (`:60`), which a count of seconds since 1970 cannot tell from the next
/// second.
[[nodiscard]] std::optional<Stamp> stamp_of(std::string_view field,
                                            DateOrder order = DateOrder::unknown) noexcept;

/// Half a stamp, for logs that write them in two columns.
[[nodiscard]] bool is_date(std::string_view field) noexcept;
[[nodiscard]] bool is_time_of_day(std::string_view field) noexcept;
/// Both together.
[[nodiscard]] std::optional<Stamp> stamp_of(std::string_view date, std::string_view time,
                                            DateOrder order) noexcept;

}  // namespace steadyrest::table
