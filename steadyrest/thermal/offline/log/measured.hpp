// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>
#include <steadyrest/table/stamp.hpp>

/// Measurements of the parts (the paper's eighth block): CSV with a head.
namespace steadyrest::thermal::offline {

struct Measured {
  std::size_t line = 0;
  std::string part;
  std::string axis;        ///< empty: the plan's only one
  std::string transition;  ///< its number from 1, or its name; empty: use `time_s`
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< since the plan's start
  double deviation_mm = 0.0;                                 ///< actual tool position less nominal
  double tolerance_mm = 0.0;                                 ///< 0 = the plan's own
};

inline constexpr std::size_t kMostMeasured = 100'000;
/// A larger one is no thermal deviation: the unit must be wrong.
inline constexpr double kLargestDeviation_mm = 1.0;

/// How the file was written, and when the plan's work began: needed for parts with stamps.
struct MeasuredFormat {
  table::Format table;
  std::optional<table::Stamp> started;
};

/// Columns: `part`; `transition`, `time_min` (`time_s`, `time_h`) or stamps under any name;
/// `deviation_um` (`_mm`); optional `tolerance_um` (`_mm`) and `axis`. Other columns are refused,
/// so that none is misread; so are an empty file, words in place of numbers, and values that no
/// heat can cause. table::RowReader reads the rows.
[[nodiscard]] kernel::outcome::Result<std::vector<Measured>> read_measured(
    const std::string& path, const MeasuredFormat& format = {});
[[nodiscard]] kernel::outcome::Result<std::vector<Measured>> parse_measured(
    std::string_view text, const std::string& file, const MeasuredFormat& format = {});

}  // namespace steadyrest::thermal::offline
