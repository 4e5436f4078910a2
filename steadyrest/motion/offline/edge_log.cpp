// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/motion/offline/edge_log.hpp>
#include <steadyrest/motion/offline/edge_log_header.hpp>

namespace steadyrest::motion::offline {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;

namespace {

constexpr std::size_t kLongestLine = 65536;
constexpr double kMaxTime_s = 9e9;             // nanoseconds fit into 64 bits
constexpr std::int64_t kMaxCount = 1LL << 52;  // positions stay exact to a fraction of a count

/// A row as it stands in the file.
struct Fields {
  std::string_view time;
  std::string_view count;
};

std::string_view without_plus(std::string_view field) {
  return field.size() > 1 && field[0] == '+' && field[1] != '-' ? field.substr(1) : field;
}

std::optional<double> number(std::string_view field) {
  field = without_plus(field);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) {
    return std::nullopt;
  }
  return value;
}

/// Digits after the point, less the exponent.
int decimals_of(std::string_view field) {
  const std::size_t e = field.find_first_of("eE");
  const std::string_view mantissa = field.substr(0, e);
  const std::size_t point = mantissa.find('.');
  int out = point == std::string_view::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  if (e != std::string_view::npos) {
    int exponent = 0;
    const std::string_view text = without_plus(field.substr(e + 1));
    std::from_chars(text.data(), text.data() + text.size(), exponent);
    out -= std::clamp(exponent, -400, 400);
  }
  return std::max(out, 0);
}

LogFault no_number(std::string_view name, std::string_view field) {
  if (field.empty()) {
    return {fmt::format("{} is empty", name), "repair the row or cut the log before it"};
  }
  return {fmt::format("{} = \"{}\" is not a number", name, shown(field)),
          field.find(',') != std::string_view::npos ? "write decimals with a point"
                                                    : "repair the row or cut the log before it"};
}

std::expected<double, LogFault> time_of(std::string_view field) {
  const auto value = number(field);
  if (!value) {
    return std::unexpected(no_number("t_s", field));
  }
  if (!std::isfinite(*value) || std::abs(*value) > kMaxTime_s) {
    return std::unexpected(LogFault{
        fmt::format("t_s = {} is out of range; allowed is ±{:g} s", shown(field), kMaxTime_s),
        "repair the row or cut the log before it"});
  }
  return *value;
}

std::expected<std::int64_t, LogFault> count_of(std::string_view field) {
  std::int64_t value = 0;
  const std::string_view digits = without_plus(field);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = error == std::errc{} && end == digits.data() + digits.size();
  if (whole && value >= -kMaxCount && value <= kMaxCount) {
    return value;
  }
  const auto real = number(field);
  if (!real) {
    return std::unexpected(no_number("count", field));
  }
  if (!std::isfinite(*real) || std::abs(*real) > static_cast<double>(kMaxCount)) {
    return std::unexpected(
        LogFault{fmt::format("count = {} is out of range; allowed is ±{}", shown(field), kMaxCount),
                 "repair the row or cut the log before it"});
  }
  if (*real != std::trunc(*real)) {
    return std::unexpected(LogFault{fmt::format("count = {} is not a whole number", shown(field)),
                                    "give the counter's value; positions in mm are not counts"});
  }
  return static_cast<std::int64_t>(*real);
}

}  // namespace

class EdgeLogReader::Parser {
 public:
  Parser(std::string file, const EdgeLogConfig& config) : config_(config) {
    log_.file = std::move(file);
  }

  /// One line without its LF. False: nothing more is wanted.
  bool line(std::string_view text, bool ended) {
    ++line_;
    if (line_ == 1 && !first_line(text)) {
      return false;
    }
    const bool carriage_return = text.ends_with('\r');
    if (carriage_return) {
      text.remove_suffix(1);
    }
    if (ended) {
      check_line_end(carriage_return);
    }
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') {
      return true;
    }
    if (!have_header_) {
      return header(text);
    }
    return ended ? row(text) : last_row(text);
  }

  /// A line that is too long to be one.
  void endless() {
    ++line_;
    const LogFault fault{fmt::format("a line of more than {} characters", kLongestLine),
                         "give a log with LF or CR LF as line ends"};
    have_header_ ? stop(fault) : refuse(fault);
  }

  EdgeLogResult finish() {
    if (!refused_ && line_ == 0) {
      refuse({"is empty", "give a log with the columns t_s and count"});
    } else if (!refused_ && !have_header_) {
      refuse({"has no header", "see to it that the header names the columns t_s and count"}, true);
    } else if (!refused_ && log_.rows.empty()) {
      refuse(log_.stopped
                 ? LogFault{log_.findings.back().what, log_.findings.back().to_do}
                 : LogFault{"has no rows after its header", "give a log with at least one row"},
             !log_.stopped);
    }
    if (refused_) {
      return std::unexpected(std::move(*refused_));
    }
    return std::move(log_);
  }

 private:
  bool first_line(std::string_view& text) {
    const LogFault fault = fault_of_kind(text);
    if (!fault.what.empty()) {
      return refuse(fault, true);
    }
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    if (text.starts_with(kMark)) {
      text.remove_prefix(kMark.size());
    }
    return true;
  }

  bool header(std::string_view text) {
    const auto columns = columns_of(text);
    if (!columns) {
      return refuse(columns.error());
    }
    columns_ = *columns;
    have_header_ = true;
    return true;
  }

  void check_line_end(bool carriage_return) {
    if (line_ == 1) {
      carriage_return_ = carriage_return;
    } else if (carriage_return != carriage_return_ && !mixed_) {
      mixed_ = true;
      report({fmt::format("the line ends change from {} to {} here",
                          carriage_return_ ? "CR LF" : "LF", carriage_return ? "CR LF" : "LF"),
              "see whether two logs were joined here"});
    }
  }

  /// Finds the two fields and gives the number of all.
  std::size_t split(std::string_view text, Fields& fields) const {
    std::size_t column = 0;
    for (;;) {
      const void* at =
          text.empty() ? nullptr : std::memchr(text.data(), columns_.separator, text.size());
      const std::size_t size =
          at == nullptr ? text.size()
                        : static_cast<std::size_t>(static_cast<const char*>(at) - text.data());
      if (column == columns_.time) {
        fields.time = trimmed(text.substr(0, size));
      } else if (column == columns_.count) {
        fields.count = trimmed(text.substr(0, size));
      }
      ++column;
      if (at == nullptr) {
        return column;
      }
      text.remove_prefix(size + 1);
    }
  }

  std::expected<LogRow, LogFault> parse(std::string_view text, Fields& fields) const {
    const std::size_t found = split(text, fields);
    if (found != columns_.all) {
      return std::unexpected(LogFault{fmt::format("the row has {} fields, the header {}: \"{}\"",
                                                  found, columns_.all, shown(text)),
                                      "repair the row or cut the log before it"});
    }
    const auto time = time_of(fields.time);
    if (!time) {
      return std::unexpected(time.error());
    }
    const auto count = count_of(fields.count);
    if (!count) {
      return std::unexpected(count.error());
    }
    return LogRow{*time, *count};
  }

  bool row(std::string_view text) {
    Fields fields;
    const auto next = parse(text, fields);
    if (!next) {
      return stop(next.error());
    }
    if (!log_.rows.empty()) {
      const LogRow& before = log_.rows.back();
      if (next->t_s < before.t_s) {
        return stop({fmt::format("time goes back from {:.9f} s to {:.9f} s", before.t_s, next->t_s),
                     "cut the log here, or read both parts apart"});
      }
      if (config_.rising_time && next->t_s == before.t_s) {
        report({fmt::format("the time stamp {:.9f} s repeats", next->t_s),
                "the row is left out; see whether the stamps have digits enough"});
        return true;
      }
      check_step(before, *next);
    }
    log_.decimals = std::max(log_.decimals, decimals_of(fields.time));
    time_size_ = fields.time.size();
    log_.rows.push_back(*next);
    return true;
  }

  void check_step(const LogRow& before, const LogRow& next) {
    const std::int64_t step = std::abs(next.count - before.count);
    const bool lost = config_.max_step > 0 && step > config_.max_step;
    // One count may be due at any time; every further one takes the axis 1/v.
    const bool too_fast = step > 1 && static_cast<double>(step - 1) >
                                          config_.max_speed_counts_s * (next.t_s - before.t_s);
    if (!lost && !too_fast) {
      return;
    }
    ++log_.jumps;
    if (log_.findings.size() >= config_.max_findings) {  // there may be millions: no text
      ++log_.finding_count;
      return;
    }
    report({fmt::format("the count jumps from {} to {} within {:.3g} s{}", before.count, next.count,
                        next.t_s - before.t_s,
                        lost ? fmt::format(": {} edges are lost", step - 1)
                             : std::string(", faster than the axis")),
            "see whether the recorder keeps up with the axis"});
  }

  /// A row without line end: whole, or cut off by the end of the file?
  bool last_row(std::string_view text) {
    Fields fields;
    const auto next = parse(text, fields);
    if (next && goes_on(*next, fields)) {
      return row(text);
    }
    report({fmt::format("the log ends within a row: \"{}\"", shown(text)),
            "the row is left out; see whether the log is whole"});
    return true;
  }

  [[nodiscard]] bool goes_on(const LogRow& next, const Fields& fields) const {
    const std::size_t rows = log_.rows.size();
    if (rows == 0) {
      return false;
    }
    const LogRow& before = log_.rows[rows - 1];
    const std::int64_t step = rows == 1 ? 0 : before.count - log_.rows[rows - 2].count;
    const std::int64_t off = std::abs(next.count - (before.count + step));
    const bool time_may_be_cut = columns_.time + 1 == columns_.all;
    return next.t_s >= before.t_s && off <= std::abs(step) / 2 + 2 &&
           (!time_may_be_cut || fields.time.size() >= time_size_);
  }

  bool refuse(const LogFault& fault, bool whole_file = false) {
    refused_ = Refusal{Kind::bad_input, log_.file, whole_file ? 0 : line_, fault.what, fault.to_do};
    return false;
  }
  void report(const LogFault& fault) {
    ++log_.finding_count;
    if (log_.findings.size() < config_.max_findings) {
      log_.findings.push_back({Kind::bad_input, log_.file, line_, fault.what, fault.to_do});
    }
  }
  /// The finding that ends the log is kept whatever max_findings says.
  bool stop(const LogFault& fault) {
    ++log_.finding_count;
    log_.findings.push_back({Kind::bad_input, log_.file, line_, fault.what, fault.to_do});
    log_.stopped = true;
    return false;
  }

  EdgeLogConfig config_;
  EdgeLog log_;
  std::optional<Refusal> refused_;
  LogColumns columns_;
  std::size_t line_ = 0;
  std::size_t time_size_ = 0;
  bool have_header_ = false;
  bool carriage_return_ = false;
  bool mixed_ = false;
};

EdgeLogReader::EdgeLogReader(std::string file, const EdgeLogConfig& config)
    : parser_(std::make_unique<Parser>(std::move(file), config)) {}
EdgeLogReader::~EdgeLogReader() = default;

bool EdgeLogReader::take(std::string_view block) {
  while (!block.empty()) {
    const void* at = std::memchr(block.data(), '\n', block.size());
    if (at == nullptr) {
      rest_ += block;
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
