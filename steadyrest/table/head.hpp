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
  /// With their unit at the end, `z_um`, whether the file has `z [µm]` or names its units in a row
  /// of their own; empty: to be passed over.
  std::vector<std::string> name;
  std::size_t line = 0;  ///< 0 = the names come from the command line
  /// The only column whose values are dates with a time (ISO 8601), if there is one.
  std::optional<std::size_t> stamped;

  /// The first column of that name.
  [[nodiscard]] std::optional<std::size_t> place(std::string_view wanted) const;
  /// The refusal of a name that stands twice; of `only` where that is given.
  [[nodiscard]] std::optional<Fault> twice(std::string_view only = {}) const;
};

/// A unit as names end in it: `um` for `[µm]`, `c` for `°C`, `rpm` for `1/min`; empty for a word
/// that is no unit, `1` for what says that there is none.
[[nodiscard]] std::string unit_of(std::string_view field);

/// A column's name: quotes off, `z (µm)` as `z_um`.
[[nodiscard]] std::string name_of(std::string_view field);

/// Whether the fields behind a head are its units: all of them words for units, or empty.
[[nodiscard]] bool are_units(const std::vector<std::string_view>& fields);

/// Puts the units of a row to the names; the refusal where they contradict them.
[[nodiscard]] std::optional<Fault> add_units(const std::vector<std::string_view>& fields,
                                             std::size_t line, Head& head);

}  // namespace steadyrest::table
