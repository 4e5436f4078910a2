// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

/// What the columns of a recording are called: times, speeds of the spindle, sensors.
namespace steadyrest::chatter::offline {

/// A column's head: `Accel X (m/s^2)`.
struct ColumnName {
  std::string written;  ///< whole
  std::string name;     ///< without its unit in brackets
  std::string unit;     ///< as written, in brackets or in a row below the names; empty: none
};

/// `written` as the file has it, `in_head` as table::Head names it: with a unit from a row below.
[[nodiscard]] ColumnName column_name(std::string_view written, std::string_view in_head);

/// A name as UTF-8 for people: at most 60 bytes, with nothing that a terminal would interpret.
[[nodiscard]] std::string shown_name(std::string_view name);

/// The name without a unit at its end that is written without brackets: `accel_x_g` as `accel_x`;
/// else the name.
[[nodiscard]] std::string without_unit(std::string_view name);

/// The unit of a time, `s`, `ms`, `us`, `ns`, `min` or `h`, for one of its spellings (`sec`, `µs`).
[[nodiscard]] std::optional<std::string_view> time_unit(std::string_view unit);

struct TimeName {
  std::string_view unit = "s";  ///< time_unit()
  bool stated = true;           ///< else seconds are assumed
};
/// `t`, `Time (s)`, `Time [ms]`, `timestamp_us`, `seconds`, `Zeit (s)`, `X_Value` and the like.
[[nodiscard]] std::optional<TimeName> names_a_time(const ColumnName& column);

struct SpeedName {
  double rev_s = 1.0;  ///< per unit
  bool stated = true;  ///< else rev/min is assumed
};
/// `speed_rpm`, `RPM`, `Spindle speed (rpm)`, `n (1/min)`, whatever is in rev/min; a speed of the
/// spindle in rev/s or Hz.
[[nodiscard]] std::optional<SpeedName> names_a_speed(const ColumnName& column);

/// Whether two names are the same but for capitals, `_` and blanks.
[[nodiscard]] bool same_name(std::string_view a, std::string_view b);

/// Whether a column is a temperature, a load in percent or a pressure: not a vibration.
[[nodiscard]] bool is_slow_quantity(const ColumnName& column);

/// Whether a column numbers the rows: `Sample`, `No.`, `index`.
[[nodiscard]] bool numbers_rows(const ColumnName& column);

}  // namespace steadyrest::chatter::offline
