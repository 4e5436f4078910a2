// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The units of the machine file and the process file: a key's name ends in its unit, and that
/// ending alone decides how the value is converted to the inner units.
namespace steadyrest::passport {

struct Unit {
  std::string_view suffix;  ///< ending of the key, without its leading `_`; empty = no unit
  std::string_view shown;   ///< as people write it
  double (*to_inner)(double) noexcept = nullptr;
  double (*from_inner)(double) noexcept = nullptr;
};

/// The unit in which `key` ends (the longest match); the one with an empty suffix if there is none.
[[nodiscard]] const Unit& unit_of(std::string_view key) noexcept;

/// `key` without its unit: `servo_gain` for `servo_gain_m_min_mm`. Also knows units that the files
/// do not use (`_in`, `_khz`, …), so that a wrong unit is told from a wrong word.
[[nodiscard]] std::string_view stem_of(std::string_view key) noexcept;

}  // namespace steadyrest::passport
