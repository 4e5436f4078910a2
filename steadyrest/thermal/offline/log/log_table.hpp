// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>

/// The text of a log as columns of numbers; log.hpp says what they mean.
namespace steadyrest::thermal::offline {

enum class Quantity : std::uint8_t { time, speed, displacement, temperature, other };

struct LogColumn {
  std::string name;
  Quantity quantity = Quantity::other;
  double factor = 1.0;  ///< into s, rev/s, mm, °C: factor·value + offset
  double offset = 0.0;
  std::vector<double> value;  ///< converted; NaN where the field is empty or says NaN
};

struct LogTable {
  std::vector<LogColumn> column;  ///< without columns of other names
  std::vector<std::size_t> line;  ///< of each row
  std::vector<std::string> passed_over;
  std::size_t head_line = 0;
  bool stamped = false;             ///< the clock shows dates
  std::vector<table::Fault> notes;  ///< what was skipped
};

[[nodiscard]] kernel::outcome::Result<LogTable> parse_log_table(std::string_view text,
                                                                const std::string& file,
                                                                const table::Format& format);

}  // namespace steadyrest::thermal::offline
