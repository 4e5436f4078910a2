// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>

namespace steadyrest::apps::cli {

void add_log_options(CLI::App& verb, LogOptions& options, const std::string& columns,
                     bool over_time) {
  verb.add_option(
          "--columns", options.columns,
          fmt::format("Column names, for a file without a header: {}; - skips a column{}", columns,
                      over_time ? "; sample is the sample number of halsampler -t" : ""))
      ->delimiter(',');
  verb.add_option("--decimal", options.decimal,
                  "Decimal mark of the log, point or comma, if the log itself is ambiguous")
      ->check(CLI::IsMember({"point", "comma"}));
  if (over_time) {
    verb.add_option("--sample-hz", options.sample_hz,
                    "Samples per second, for a log without a time column: counts the column "
                    "sample, or the rows")
        ->check(within(1e-3, 1e9));
  }
}

/// What the user did not specify comes from the file (Decimal::by_file).
table::Format format_of(const LogOptions& options, double sample_hz) {
  table::Format out;
  out.columns = options.columns;
  out.decimal = options.decimal == "comma"   ? table::Decimal::comma
                : options.decimal == "point" ? table::Decimal::point
                                             : table::Decimal::by_file;
  out.sample_hz = options.sample_hz.value_or(sample_hz);
  // Only an explicit rate turns rows into samples; the verb's default rate does not.
  out.rows_are_samples = options.sample_hz.has_value();
  return out;
}

}  // namespace steadyrest::apps::cli
