// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <expected>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>
#include <steadyrest/motion/offline/log/rollover.hpp>
#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::motion::offline {

// How a log is read: `table` finds lines, columns and numbers; the parser here checks how rows
// follow one another. A fault that casts doubt on all rows refuses the file; one that casts doubt
// on a single row ends it there and keeps the rows before it; anything merely unusual is reported.
using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using table::Fault;
using table::Row;

namespace {

constexpr std::size_t kLongestLine = 65536;
constexpr double kMaxTime_s = 9e9;             // nanoseconds fit into 64 bits
constexpr std::int64_t kMaxCount = 1LL << 52;  // positions stay exact to a fraction of a count
constexpr double kLeap = 10.0;  // a stamp that leaps this much farther is the wrong one
constexpr std::string_view kRepair = "repair the row or cut the log before it";

// Integers first: a count beyond 2⁵³ read as a double would silently lose digits. Some recorders
// write 10.000 or 1.1e+01; a fraction, though, means that the column is not a count.
// Within ± 2⁵² positions in mm stay exact to a fraction of a count.
std::expected<std::int64_t, Fault> count_of(const Row& row, std::size_t column) {
  const std::string_view field = row.field(column);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  const bool whole = error == std::errc{} && end == field.data() + field.size();
  if (whole && value >= -kMaxCount && value <= kMaxCount) {
    return value;
  }
  const auto real = row.number(column);
  if (!real) {
    return std::unexpected(real.error());
  }
  if (std::abs(*real) > static_cast<double>(kMaxCount)) {
    return std::unexpected(Fault{
        row.line(),
        fmt::format("count = {} is out of range; allowed: ±{}", table::shown(field), kMaxCount),
        std::string(kRepair)});
  }
  if (*real != std::trunc(*real)) {
    return std::unexpected(
        Fault{row.line(), fmt::format("count = {} is not a whole number", table::shown(field)),
              "give the counter's value; positions in mm are not counts"});
  }
  return static_cast<std::int64_t>(*real);
}

}  // namespace

/// Takes rows from the column reader and checks how they follow one another.
class EdgeLogReader::Parser final : public table::Sink {
 public:
  Parser(std::string file, EdgeLogConfig config)
      : config_(std::move(config)), reader_(config_.format, *this) {
    log_.file = std::move(file);
  }

  /// One line without its LF. False: no more lines are wanted.
  bool line(std::string_view text, bool ended) {
    if (ended) {
      check_line_end(text.ends_with('\r'));
    }
    ended_ = ended;
    text_ = text;
    // The end of recording may cut off the last line: that is not a fault.
    const auto fault = reader_.line(text);
    if (fault && !ended && reader_.has_head()) {
      cut_off();
      return true;
    }
    return !fault || take(*fault);
  }

  /// A line that is too long to be one.
  void endless() {
    take({line_number() + 1, fmt::format("a line longer than {} characters", kLongestLine),
          "give a log with LF or CR LF line ends"});
  }

  // The gravest first; findings are reported in line order, wherever they were found.
  EdgeLogResult finish() {
    if (!refused_ && !log_.stopped) {
      if (const auto fault = reader_.finish()) {
        refuse(*fault);
      }
    }
    if (!refused_ && line_number() == 0) {
      refuse({0, "is empty", "give a log with the columns t_s and count"});
    } else if (!refused_ && !reader_.has_head()) {
      refuse({0, "has no header", "name the columns t_s and count in the header"});
    } else if (!refused_ && log_.rows.empty()) {
      refuse({0, "has no rows after its header", "give a log with at least one row"});
    }
    if (refused_) {
      return std::unexpected(std::move(*refused_));
    }
    for (const Fault& note : reader_.notes()) {
      report(note);
    }
    log_.counter_bits = counter_.bits();
    if (log_.rollovers > 0) {
      report(
          {first_rollover_,
           fmt::format("the counter of {} bits rolls over here{}", log_.counter_bits,
                       log_.rollovers > 1 ? fmt::format(", the first of {} times", log_.rollovers)
                                          : std::string()),
           "it is unwrapped: the count goes on"});
    }
    std::ranges::stable_sort(log_.findings, {}, &Refusal::line);
    return std::move(log_);
  }

  std::optional<Fault> head(const table::Head& head) override {
    constexpr std::string_view kWay =
        "name the columns t_s and count once each in the header, separated by , or ; or tab, or "
        "name them with --columns";
    const auto missing = [&](std::string_view name) {
      std::string names;
      for (const std::string& one : head.name) {
        names += (names.empty() ? "" : ",") + one;
      }
      return Fault{0, fmt::format("the column {} is missing in \"{}\"", name, table::shown(names)),
                   std::string(kWay)};
    };
    for (const std::string_view name : {"t_s", "count"}) {
      if (auto fault = head.twice(name)) {
        return fault;
      }
    }
    clock_ = table::Clock::of(head, config_.format);
    if (!clock_) {
      return missing("t_s");
    }
    const auto count = head.place("count");
    if (!count) {
      return missing("count");
    }
    count_ = *count;
    all_ = head.name.size();
    return std::nullopt;
  }

  std::optional<Fault> row(const Row& row) override {
    const auto t_s = clock_->seconds(row);
    if (!t_s) {
      return t_s.error();
    }
    if (std::abs(*t_s) > kMaxTime_s) {
      return Fault{row.line(),
                   fmt::format("t_s = {:g} is out of range; allowed: ±{:g} s", *t_s, kMaxTime_s),
                   std::string(kRepair)};
    }
    const auto count = count_of(row, count_);
    if (!count) {
      return count.error();
    }
    const std::size_t time_size = clock_->column() ? row.field(*clock_->column()).size() : 0;
    const LogRow next{*t_s, counter_.unwrapped(*t_s, *count)};
    if (std::abs(next.count) > kMaxCount) {
      return Fault{row.line(),
                   fmt::format("the counter rolled over {} times, out of the range of ±{}",
                               counter_.times(), kMaxCount),
                   std::string(kRepair)};
    }
    first_rollover_ = counter_.times() == 1 && log_.rollovers == 0 ? row.line() : first_rollover_;
    log_.rollovers = counter_.times();
    if (!ended_ && !goes_on(next, time_size)) {
      cut_off();
      return std::nullopt;
    }
    return follow(next, row, time_size);
  }

 private:
  [[nodiscard]] std::size_t line_number() const { return reader_.line_number(); }

  void check_line_end(bool carriage_return) {
    if (line_number() == 0) {
      carriage_return_ = carriage_return;
    } else if (carriage_return != carriage_return_ && !mixed_) {
      mixed_ = true;
      report({line_number() + 1,
              fmt::format("the line ends change from {} to {} here",
                          carriage_return_ ? "CR LF" : "LF", carriage_return ? "CR LF" : "LF"),
              "check whether two logs were joined here"});
    }
  }

  // Time first, since a step in the count can be judged only with a valid time.
  std::optional<Fault> follow(const LogRow& next, const Row& row, std::size_t time_size) {
    if (!log_.rows.empty()) {
      const LogRow before = log_.rows.back();
      if (next.t_s < before.t_s) {
        return back(before, next, row.line());
      }
      if (config_.rising_time && next.t_s == before.t_s) {
        report({row.line(), fmt::format("the time stamp {:.9f} s repeats", next.t_s),
                "the row is skipped; check that the time stamps have enough digits"});
        return std::nullopt;
      }
      check_step(before, next, row.line());
      if (next.t_s - before.t_s > log_.longest_step_s) {
        log_.longest_step_s = next.t_s - before.t_s;
        log_.longest_step_line = row.line();
      }
    }
    log_.decimals = std::max(log_.decimals, clock_->decimals(row));
    time_size_ = time_size;
    last_line_ = row.line();
    log_.rows.push_back(next);
    return std::nullopt;
  }

  /// Time that goes back ends the log. Where the previous row had leapt ahead by more than ten
  /// steps, that one is wrong and this one right.
  Fault back(const LogRow& before, const LogRow& next, std::size_t line) {
    const std::size_t rows = log_.rows.size();
    const double ahead_s = rows < 2 ? 0.0 : next.t_s - log_.rows[rows - 2].t_s;
    if (ahead_s <= 0.0 || before.t_s - log_.rows[rows - 2].t_s <= kLeap * ahead_s) {
      return {line, fmt::format("time goes back from {:.9f} s to {:.9f} s", before.t_s, next.t_s),
              "cut the log here, or read the two parts separately"};
    }
    log_.rows.pop_back();
    return {last_line_,
            fmt::format("t_s = {:.9g} leaps ahead of its neighbours; allowed: {:.9f} s to {:.9f} s",
                        before.t_s, log_.rows.back().t_s, next.t_s),
            "correct the row's time, or cut the log before it"};
  }

  // Reported, not refused: a jump may be real. Lost edges are distinguished from an axis that was
  // too fast.
  void check_step(const LogRow& before, const LogRow& next, std::size_t line) {
    const std::int64_t step = std::abs(next.count - before.count);
    const bool lost = config_.max_step > 0 && step > config_.max_step;
    // One count may be due at any time; every further one takes the axis 1/v.
    const bool too_fast = step > 1 && static_cast<double>(step - 1) >
                                          config_.max_speed_counts_s * (next.t_s - before.t_s);
    if (!lost && !too_fast) {
      return;
    }
    ++log_.jumps;
    // Millions of jumps would otherwise be formatted only to be dropped.
    if (log_.findings.size() >= config_.max_findings) {  // there may be millions: no text
      ++log_.finding_count;
      return;
    }
    report({line,
            fmt::format("the count jumps from {} to {} within {:.3g} s{}", before.count, next.count,
                        next.t_s - before.t_s,
                        lost ? fmt::format(": {} edges are lost", step - 1)
                             : std::string(", faster than the axis")),
            "check that the recorder keeps up with the axis"});
  }

  // A stopped recorder leaves half a row; that is reported, and the rows before it are good.
  void cut_off() {
    report({line_number(),
            fmt::format("the log ends within a row: \"{}\"", table::shown(table::trimmed(text_))),
            "the row is skipped; check that the log is complete"});
  }

  /// A row without line end: whole, or cut off by the end of the file?
  [[nodiscard]] bool goes_on(const LogRow& next, std::size_t time_size) const {
    const std::size_t rows = log_.rows.size();
    if (rows == 0) {
      return false;
    }
    const LogRow& before = log_.rows[rows - 1];
    const std::int64_t step = rows == 1 ? 0 : before.count - log_.rows[rows - 2].count;
    const std::int64_t off = std::abs(next.count - (before.count + step));
    // A truncated number is still a number. The time can be cut only in the last column; the count
    // is trusted where it continues the last step.
    const bool time_may_be_cut = clock_->column() && *clock_->column() + 1 == all_;
    return next.t_s >= before.t_s && off <= std::abs(step) / 2 + 2 &&
           (!time_may_be_cut || time_size >= time_size_);
  }

  void refuse(const Fault& fault) {
    refused_ = bad_input(log_.file, fault.line, fault.what, fault.to_do);
  }
  void report(const Fault& fault) {
    ++log_.finding_count;
    if (log_.findings.size() < config_.max_findings) {
      log_.findings.push_back(bad_input(log_.file, fault.line, fault.what, fault.to_do));
    }
  }
  /// A fault in the header refuses the file. A later one ends the log and is kept whatever
  /// max_findings says. False ends the reading: rows after a fault may be shifted by a row or
  /// belong to another log.
  bool take(const Fault& fault) {
    if (!reader_.has_head() || log_.rows.empty()) {
      refuse(fault);
      return false;
    }
    ++log_.finding_count;
    log_.findings.push_back(bad_input(log_.file, fault.line, fault.what, fault.to_do));
    log_.stopped = true;
    return false;
  }

  EdgeLogConfig config_;
  table::RowReader reader_;
  EdgeLog log_;
  std::optional<Refusal> refused_;
  std::optional<table::Clock> clock_;
  Rollover counter_;
  std::size_t first_rollover_ = 0;  ///< its line
  std::size_t count_ = 0;
  std::size_t all_ = 0;
  std::size_t time_size_ = 0;
  std::size_t last_line_ = 0;  ///< of the last row that was kept
  std::string_view text_;
  bool ended_ = true;
  bool carriage_return_ = false;
  bool mixed_ = false;
};

EdgeLogReader::EdgeLogReader(std::string file, const EdgeLogConfig& config)
    : parser_(std::make_unique<Parser>(std::move(file), config)) {}
EdgeLogReader::~EdgeLogReader() = default;

// Blocks end anywhere: the rest of a line waits for the next block. A line within one block is read
// in place, without a copy.
bool EdgeLogReader::take(std::string_view block) {
  while (!block.empty()) {
    const void* at = std::memchr(block.data(), '\n', block.size());
    if (at == nullptr) {
      rest_ += block;
      // Otherwise a file without line ends would be collected in memory whole.
      if (rest_.size() > kLongestLine) {
        rest_.clear();
        parser_->endless();
        return false;
      }
      return true;
    }
    const auto size = static_cast<std::size_t>(static_cast<const char*>(at) - block.data());
    bool more = false;
    if (rest_.empty()) {
      more = parser_->line(block.substr(0, size), true);
    } else {
      rest_ += block.substr(0, size);
      more = parser_->line(rest_, true);
      rest_.clear();
    }
    if (!more) {
      return false;
    }
    block.remove_prefix(size + 1);
  }
  return true;
}

EdgeLogResult EdgeLogReader::finish() {
  if (!rest_.empty()) {
    parser_->line(rest_, false);
  }
  return parser_->finish();
}

EdgeLogResult parse_edge_log(std::string_view text, const std::string& file,
                             const EdgeLogConfig& config) {
  EdgeLogReader reader(file, config);
  reader.take(text);
  return reader.finish();
}

}  // namespace steadyrest::motion::offline
