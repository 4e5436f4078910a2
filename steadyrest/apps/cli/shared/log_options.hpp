// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::apps::cli {

/// Options of every verb that reads a log: how it was written.
struct LogOptions {
  std::vector<std::string> columns;
  std::string decimal;
  std::optional<double> sample_hz;
};

/// Adds --columns, --decimal and, for a log over time, --sample-hz. `columns` are those of the
/// verb, for its help: "t_s,count".
void add_log_options(CLI::App& verb, LogOptions& options, const std::string& columns,
                     bool over_time = true);

/// For the reader of columns. `sample_hz` is the rate of sample numbers if --sample-hz is not
/// given.
[[nodiscard]] table::Format format_of(const LogOptions& options, double sample_hz = 0.0);

}  // namespace steadyrest::apps::cli
