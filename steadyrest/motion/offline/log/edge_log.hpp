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

/// Reads encoder logs: text with the columns `t_s` and `count`, a row each, as table::RowReader
/// takes them; times also as stamps (ISO 8601) or sample numbers (table::Clock). Counts may have a
/// fraction of noughts (`5.000e+00`). Time stamps may repeat but not go back.
///
/// Three grades of fault:
/// - *refused* (there is no log): not readable, compressed, UTF-16, binary, no header, a column
///   missing or twice, no row at all;
/// - *ends the log* (`EdgeLog::stopped`): a row that cannot be right – a field missing or too many,
///   not a number, NaN, ∞, a count with a fraction, time going back. What stood before it is kept,
///   what follows is not read: after such a row nobody knows which side is wrong. A stamp that
///   leaps ahead and back is the wrong one itself;
/// - *reported only*: jumps of the count (lost edges), mixed line ends, repeated stamps of ticks, a
///   last row without line end that is cut or may be. A last row without line end is kept when it
///   is whole and goes on as the rows before it did.
namespace steadyrest::motion::offline {

struct LogRow {
  double t_s = 0.0;
  std::int64_t count = 0;
};

struct EdgeLogConfig {
  /// Larger changes of the count from row to row are lost edges; 0 = any change is permitted.
  std::int64_t max_step = 1;
  /// Counts/s above which a change of more than one count is reported as a jump.
  double max_speed_counts_s = std::numeric_limits<double>::infinity();
  bool rising_time = false;       ///< a time stamp that repeats is reported and its row left out
  std::size_t max_findings = 20;  ///< kept with their text; all are counted
  table::Format format;           ///< what the file itself does not say
};

struct EdgeLog {
  std::string file;
  std::vector<LogRow> rows;
  std::vector<kernel::outcome::Refusal> findings;  ///< by rising line
  std::size_t finding_count = 0;                   ///< also those beyond max_findings
  std::size_t jumps = 0;                           ///< rows with lost edges
  bool stopped = false;                            ///< the last finding ended the reading
  int decimals = 0;                   ///< most decimals that a time stamp was printed with
  double longest_step_s = 0.0;        ///< between two rows
  std::size_t longest_step_line = 0;  ///< of the row behind it
};

using EdgeLogResult = kernel::outcome::Result<EdgeLog>;

/// Reads a log that comes in blocks.
class EdgeLogReader {
 public:
  EdgeLogReader(std::string file, const EdgeLogConfig& config);
  EdgeLogReader(const EdgeLogReader&) = delete;
  EdgeLogReader& operator=(const EdgeLogReader&) = delete;
  ~EdgeLogReader();

  /// The next bytes. False: nothing more is wanted.
  bool take(std::string_view block);
  /// No more bytes: the log, or why there is none.
  [[nodiscard]] EdgeLogResult finish();

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
  std::string rest_;  ///< of a line whose end has not come yet
};

[[nodiscard]] EdgeLogResult parse_edge_log(std::string_view text, const std::string& file,
                                           const EdgeLogConfig& config = {});

/// Called now and then with the share of the file that is read.
using ReadShare = std::function<void(double)>;

/// Reads a file, `-` is stdin.
[[nodiscard]] EdgeLogResult read_edge_log(const std::string& path, const EdgeLogConfig& config = {},
                                          const ReadShare& share = {});

/// The period of the time stamps: the coarsest of 1, 2 and 5·10⁻ⁿ s, n ≤ 9, of which all of them
/// are multiples within half of their last printed digit; 0 when their clock is finer.
[[nodiscard]] double clock_of(const EdgeLog& log);

}  // namespace steadyrest::motion::offline
