// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

/// Universal files as they are written: functions between nodes, nothing converted or judged.
///
/// Datasets lie between lines of −1. Read are 58 (function at nodal degree of freedom, as text or,
/// 58b, with IEEE numbers of either byte order behind its eleven lines) and 164 (units); all others
/// are skipped. Source: SDRC Universal File Datasets Summary, datasets 58, 58b and 164.
namespace steadyrest::chatter::offline {

/// A degree of freedom: node of an entity and direction, ±1 … ±3 along x, y, z, ±4 … ±6 about them.
struct UffPoint {
  std::string entity;  ///< empty: not named
  long node = 0;
  long direction = 0;  ///< 0: not stated

  [[nodiscard]] bool stated() const noexcept { return node != 0 || direction != 0; }
};

/// Records 8 … 11: what an axis is, and the words for it.
struct UffAxis {
  std::size_t line = 0;
  int kind = 0;
  std::string label;
  std::string unit;  ///< as written; empty: none
};

/// Dataset 164: how many of the file's units make 1 m and 1 N.
struct UffUnits {
  std::size_t line = 0;
  std::string name;
  double per_m = 1.0;
  double per_n = 1.0;
};

inline constexpr int kUffTimeResponse = 1;
inline constexpr int kUffFrequencyResponse = 4;
inline constexpr int kUffCoherence = 6;

struct UffFunction {
  int type = 0;
  std::string title;     ///< first of the five ID lines, as written
  std::size_t line = 0;  ///< of its type
  std::size_t end = 0;   ///< last line of its data
  UffPoint response;
  UffPoint reference;
  bool points_read = false;  ///< record 6 could be read to its end
  UffAxis abscissa;
  UffAxis numerator;
  UffAxis denominator;
  int number_type = 5;     ///< 2, 4: real single, double; 5, 6: complex
  std::vector<double> at;  ///< abscissa, in its unit
  std::vector<std::complex<double>> value;
  std::optional<UffUnits> units;  ///< in force here

  [[nodiscard]] bool complex() const noexcept { return number_type >= 5; }
};

/// The word for a function type: "coherence".
[[nodiscard]] std::string_view uff_type_name(int type) noexcept;

/// `node 1 +X`, `TOOL:1 −Z`.
[[nodiscard]] std::string uff_point_name(const UffPoint& point);

/// All functions of the text, those of the `wanted` types with their values. Refused by line: a
/// truncated text, VAX and IBM numbers, counts that the text does not hold, no dataset 58 at all.
[[nodiscard]] kernel::outcome::Result<std::vector<UffFunction>> read_uff_functions(
    std::string_view text, const std::string& file, std::span<const int> wanted);

}  // namespace steadyrest::chatter::offline
