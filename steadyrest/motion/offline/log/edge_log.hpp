// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>

/// Reads encoder logs: text with the columns `t_s` and `count`, as read by table::RowReader; times
/// may also be stamps (ISO 8601) or sample numbers (table::Clock). Counts may have a fraction of
/// zeros (`5.000e+00`). Time stamps may repeat but not go back.
///
/// Three grades of fault:
/// - *refused* (there is no log): not readable, compressed, UTF-16, binary, no header, a column
///   missing or twice, no row at all;
/// - *ends the log* (`EdgeLog::stopped`): a row that cannot be right – a field missing or too many,
///   not a number, NaN, ∞, a count with a fraction, time going back. The rows before it are kept,
///   the rest is not read: after such a row either side may be wrong. A stamp that leaps ahead and
///   back is itself the wrong one;
/// - *reported only*: rollovers of the counter, which are unwrapped (rollover.hpp), jumps of the
///   count (lost edges), mixed line ends, repeated stamps of ticks, a
///   last row without line end that is or may be truncated. A last row without line end is kept
///   when it is complete and continues like the rows before it.
namespace steadyrest::motion::offline {

struct LogRow {
  double t_s = 0.0;
  std::int64_t count = 0;
};

struct EdgeLogConfig {
  /// Larger changes of the count from row to row mean lost edges; 0 = any change is permitted.
  std::int64_t max_step = 1;
  /// Counts/s above which a change of more than one count is reported as a jump.
  double max_speed_counts_s = std::numeric_limits<double>::infinity();
  bool rising_time = false;       ///< a repeated time stamp is reported and its row omitted
  std::size_t max_findings = 20;  ///< kept with text; all are counted
  table::Format format;           ///< whatever the file itself does not say
};

struct EdgeLog {
  std::string file;
  std::vector<LogRow> rows;
  std::vector<kernel::outcome::Refusal> findings;  ///< by rising line
  std::size_t finding_count = 0;                   ///< also those beyond max_findings
  std::size_t jumps = 0;                           ///< rows with lost edges
  std::size_t rollovers = 0;                       ///< of the counter, unwrapped
  int counter_bits = 0;                            ///< where it rolled over
  bool stopped = false;                            ///< the last finding ended the reading
  int decimals = 0;                                ///< most decimals of any time stamp
  double longest_step_s = 0.0;                     ///< between two rows
  std::size_t longest_step_line = 0;               ///< of the row after it
};

using EdgeLogResult = kernel::outcome::Result<EdgeLog>;

/// Reads a log that arrives in blocks.
class EdgeLogReader {
 public:
  EdgeLogReader(std::string file, const EdgeLogConfig& config);
  EdgeLogReader(const EdgeLogReader&) = delete;
  EdgeLogReader& operator=(const EdgeLogReader&) = delete;
  ~EdgeLogReader();

  /// Takes the next bytes. False: no more are wanted.
  bool take(std::string_view block);
  /// No more bytes: the log, or why there is none.
  [[nodiscard]] EdgeLogResult finish();

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
  std::string rest_;  ///< of a line whose end has not arrived yet
};

[[nodiscard]] EdgeLogResult parse_edge_log(std::string_view text, const std::string& file,
                                           const EdgeLogConfig& config = {});

/// Called now and then with the share of the file read.
using ReadShare = std::function<void(double)>;

/// Reads a file; `-` is stdin.
[[nodiscard]] EdgeLogResult read_edge_log(const std::string& path, const EdgeLogConfig& config = {},
                                          const ReadShare& share = {});

/// The period of the time stamps: the coarsest of 1, 2 and 5·10⁻ⁿ s, n ≤ 9, of which all of them
/// are multiples within half of their last printed digit; 0 when their clock is finer.
[[nodiscard]] double clock_of(const EdgeLog& log);

}  // namespace steadyrest::motion::offline
