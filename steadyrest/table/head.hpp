// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/table/text.hpp>

namespace steadyrest::table {

/// The columns of a file.
struct Head {
  /// With their unit at the end, `z_um`, whether the file has `z [µm]` or names its units in a
  /// separate row; empty: ignored.
  std::vector<std::string> name;
  std::vector<std::string> written;  ///< as the file or the command line has them; as many
  std::size_t line = 0;              ///< 0 = the names come from the command line
  /// The only column whose values are dates with a time (stamp.hpp), if there is one; else the only
  /// one of dates, if there is also only one of times of day, `clocked`.
  std::optional<std::size_t> stamped;
  std::optional<std::size_t> clocked;
  /// The only column of times since 1970: in ms or less by its name, or named time or timestamp
  /// without a unit, where only one unit makes its numbers years since 2001.
  std::optional<std::size_t> epoch;
  double epoch_factor = 1.0;  ///< to s

  /// Finds the three columns by the fields of the first row.
  void find_times(const std::vector<std::string_view>& row);

  /// The first column of that name.
  [[nodiscard]] std::optional<std::size_t> place(std::string_view wanted) const;
  /// The refusal of a duplicate name; of `only`, if given.
  [[nodiscard]] std::optional<Fault> twice(std::string_view only = {}) const;
};

/// Seconds in the unit of a column of times: `t_s`, `time_ms`, `timestamp_us`, `Time_min`; empty:
/// another name.
[[nodiscard]] std::optional<double> time_factor(std::string_view name);

/// A unit in the form that names end in: `um` for `[µm]`, `c` for `°C`, `rpm` for `1/min`; empty
/// for a word that is no unit, `1` for an explicit "no unit".
[[nodiscard]] std::string unit_of(std::string_view field);

/// A column's name: without quotes, `z (µm)` as `z_um`.
[[nodiscard]] std::string name_of(std::string_view field);

/// Whether the fields after a head are its units: all unit words, or empty.
[[nodiscard]] bool are_units(const std::vector<std::string_view>& fields);

/// Appends a row's units to the names; the refusal where they contradict each other.
[[nodiscard]] std::optional<Fault> add_units(const std::vector<std::string_view>& fields,
                                             std::size_t line, Head& head);

}  // namespace steadyrest::table
