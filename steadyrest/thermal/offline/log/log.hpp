// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>

/// The log of a thermal test or of a working day: CSV, plain or packed by gzip.
///
/// A head with names that end in their unit: a time (`time_s`, `t_s`, or `_ms`, `_min`, `_h`), the
/// spindle's speed (`spindle_rpm` or `speed_rpm`), displacements (`…_um`, `…_mm`) and temperatures
/// (`…_c`, `…_k`, `…_f`); then rows, as table::RowReader takes them. Instead of a numeric time
/// there may be stamps (ISO 8601) or sample numbers (table::Clock). Columns with other names are
/// ignored.
namespace steadyrest::thermal::offline {

struct LogChannel {
  std::string name;           ///< as in the head
  std::vector<double> value;  ///< mm or °C, one for each row; NaN: not known
};

struct Log {
  std::string file;
  std::vector<double> time_s;  ///< ascending
  /// Origin of a log's minutes: its first row if it has stamps, else the clock's 0.
  double origin_s = 0.0;
  std::vector<double> speed_rev_s;  ///< ≥ 0
  std::vector<LogChannel> displacement;
  std::vector<LogChannel> temperature;
  /// Rows preceded by unrecorded time, ascending: what the machine did in it is unknown.
  std::vector<std::size_t> gap;
  /// What was left out of the log and why, each as `FILE:LINE: what; what was done`.
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t rows() const noexcept { return time_s.size(); }
  [[nodiscard]] double hours() const noexcept {
    return time_s.empty() ? 0.0 : (time_s.back() - time_s.front()) / 3600.0;
  }
};

/// Refused, by line: missing or duplicate columns, words in place of numbers, a clock that runs
/// back, leaps ahead for a row, gives two rows the same time or has rows more than 10 min apart,
/// one or two isolated rows at an end of the log, impossible values (wrong unit). Left out with a
/// note: duplicate rows, sensors that are absent, stuck or wild for a while (temperatures by the
/// rules of online::SensorWatch). Noted: a displacement that hardly moves.
[[nodiscard]] kernel::outcome::Result<Log> read_log(const std::string& path,
                                                    const table::Format& format = {});
[[nodiscard]] kernel::outcome::Result<Log> parse_log(std::string_view text, const std::string& file,
                                                     const table::Format& format = {});

/// A sensor that repeats itself to the last digit for this long is stuck, if it changes elsewhere.
inline constexpr double kStuck_s = 2.0 * 3600.0;
/// Holes in a temperature up to this length are bridged by a straight line.
inline constexpr double kBridge_s = 600.0;
/// A gap is more than this between two rows, and more than ten times the usual step.
inline constexpr double kGap_s = 300.0;
inline constexpr std::size_t kLeastRows = 20;

}  // namespace steadyrest::thermal::offline
