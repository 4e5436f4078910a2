// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <vector>

#include <steadyrest/thermal/offline/log/log_table.hpp>

/// The times of a log's rows.
namespace steadyrest::thermal::offline {

struct LogClock {
  std::vector<double> time_s;    ///< ascending
  double origin_s = 0.0;         ///< as Log::origin_s
  std::vector<std::size_t> row;  ///< of the table, for each time
  std::vector<std::size_t> gap;  ///< as Log::gap
  std::vector<table::Fault> notes;
};

/// Refused, by line: a row without a time, a clock that runs back or leaps ahead for a row, two
/// rows with the same time but different values, fewer than kLeastRows, rows more than 10 min apart
/// (median), one or two isolated rows at an end of the log. Duplicate rows are taken once.
[[nodiscard]] std::expected<LogClock, table::Fault> clock_of(const LogTable& table);

}  // namespace steadyrest::thermal::offline
