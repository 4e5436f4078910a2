// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace steadyrest::table {

/// A date with the time of day.
struct Stamp {
  std::int64_t whole_s = 0;  ///< since 1970-01-01 0:00, in UTC if the zone is given
  double fraction_s = 0.0;   ///< 0 … 1
  bool zoned = false;        ///< Z or an offset from UTC was written
  int decimals = 0;          ///< digits of the fraction
};

/// ISO 8601-1:2019: `2026-11-22T23:47:06`, a blank instead of the T, `20261122T234706`; seconds may
/// be missing or have a fraction after a point or a comma; `Z`, `+01:00`, `+0100` and `+01` name
/// the zone. Years 1970 … 2199. Empty: the field is no such stamp, or a leap second (`:60`), which
/// a count of seconds since 1970 cannot tell from the next second.
[[nodiscard]] std::optional<Stamp> stamp_of(std::string_view field) noexcept;

}  // namespace steadyrest::table
