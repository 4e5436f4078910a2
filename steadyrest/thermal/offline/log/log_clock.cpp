// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/offline/log/log_clock.hpp>

// Time must rise. A duplicate row is harmless and dropped; a time that runs back or leaps is
// refused, since every exponential between two rows depends on it. A longer pause is a gap, and a
// gap needs rows on either side that agree with each other.
namespace steadyrest::thermal::offline {
namespace {

using table::Fault;
using MaybeFault = std::optional<Fault>;

constexpr double kMostTime_s = 1e11;  ///< 3000 years: a clock since 1970 is far below
constexpr double kMostStep_s = 600.0;
constexpr double kLeap = 10.0;        ///< a time that leaps this much farther is wrong
constexpr std::size_t kVouching = 3;  ///< rows beyond a gap that vouch for their times

class ClockMaker {
 public:
  explicit ClockMaker(const LogTable& table)
      : table_(table),
        column_(*std::ranges::find(table.column, Quantity::time, &LogColumn::quantity)) {}

  std::expected<LogClock, Fault> make() {
    for (const auto step : {&ClockMaker::take_rows, &ClockMaker::find_gaps}) {
      if (auto fault = (this->*step)()) {
        return std::unexpected(std::move(*fault));
      }
    }
    return std::move(out_);
  }

 private:
  /// The same numbers in all columns.
  [[nodiscard]] bool same(std::size_t a, std::size_t b) const {
    return std::ranges::all_of(table_.column, [&](const LogColumn& c) {
      return c.value[a] == c.value[b] || (std::isnan(c.value[a]) && std::isnan(c.value[b]));
    });
  }
  [[nodiscard]] std::size_t line_of(std::size_t kept) const { return table_.line[out_.row[kept]]; }

  /// A time with its column, as the log writes it; for stamps the seconds since its first row.
  [[nodiscard]] std::string shown(double time_s) const {
    return fmt::format("{} = {:.10g}{}", column_.name, (time_s - out_.origin_s) / column_.factor,
                       table_.stamped ? " s after the first row" : "");
  }

  // Rows are kept or refused one by one. Loggers that flush twice write the same row twice; a row
  // with the same time and other values is a contradiction that nobody can resolve.
  MaybeFault take_rows() {
    std::size_t twice = 0;
    std::size_t first_twice = 0;
    for (std::size_t i = 0; i < column_.value.size(); ++i) {
      const double t = column_.value[i];
      const std::size_t line = table_.line[i];
      if (std::isnan(t)) {
        return Fault{line, fmt::format("{} is empty", column_.name), "give each row a time"};
      }
      if (!(std::abs(t) <= kMostTime_s)) {
        return Fault{line, fmt::format("{} is not a time", shown(t)),
                     "correct the row's time, or leave out the row"};
      }
      if (out_.row.empty()) {
        // --from-min and --to-min count from here: for stamps from the first row, for a logger's
        // clock from its own 0.
        out_.origin_s = table_.stamped ? t : 0.0;
      }
      if (out_.row.empty() || t > out_.time_s.back()) {
        out_.row.push_back(i);
        out_.time_s.push_back(t);
      } else if (t == out_.time_s.back() && same(i, out_.row.back())) {
        ++twice;
        first_twice = first_twice == 0 ? line : first_twice;
      } else if (t == out_.time_s.back()) {
        return Fault{line, fmt::format("{} appears twice, with different values", shown(t)),
                     "give each row a different time, with enough digits"};
      } else {
        return runs_back(t, line);
      }
    }
    if (twice > 0) {
      out_.notes.push_back(
          {first_twice, fmt::format("{} rows appear twice", twice), "each was used once"});
    }
    return out_.row.size() >= kLeastRows
               ? std::nullopt
               : MaybeFault(
                     {0, fmt::format("holds {} rows; {} are needed", out_.row.size(), kLeastRows),
                      "log the whole test"});
  }

  /// If the row before had leapt ahead, that one is wrong.
  [[nodiscard]] Fault runs_back(double t, std::size_t line) const {
    const std::size_t rows = out_.row.size();
    const double before = out_.time_s.back();
    const double ahead_s = rows < 2 ? 0.0 : t - out_.time_s[rows - 2];
    // This row fits to the one before last, so the last one is the culprit.
    if (ahead_s > 0.0 && before - out_.time_s[rows - 2] > kLeap * ahead_s) {
      return {line_of(rows - 1), fmt::format("{} leaps ahead of its neighbours", shown(before)),
              "correct the row's time, or leave out the row"};
    }
    return {line,
            fmt::format("the clock runs backwards: {} after {:.10g}", shown(t),
                        (before - out_.origin_s) / column_.factor),
            "sort the rows, or cut the log where the clock was set"};
  }

  MaybeFault find_gaps() {
    std::vector<double> step;
    for (std::size_t i = 1; i < out_.time_s.size(); ++i) {
      step.push_back(out_.time_s[i] - out_.time_s[i - 1]);
    }
    // The median: gaps and doubled rows do not move it.
    std::vector<double> sorted = step;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    if (*middle > kMostStep_s) {
      return Fault{
          table_.head_line,
          fmt::format(
              "the rows are {:.1f} min apart in {} (median); at most {:.0f} min are allowed",
              *middle / 60.0, column_.name, kMostStep_s / 60.0),
          "make the clock's unit agree with its name: time_s, time_ms, time_min, time_h"};
    }
    // Ten steps, for logs with one row every few minutes, where a missed row is no gap.
    const double most = std::max(kGap_s, 10.0 * *middle);
    for (std::size_t i = 0; i < step.size(); ++i) {
      if (step[i] > most) {
        out_.gap.push_back(i + 1);
        out_.notes.push_back({line_of(i + 1),
                              fmt::format("{:.1f} min are missing before this row", step[i] / 60.0),
                              "nothing is known about this gap: a fit restarts its state at this "
                              "row, a forecast assumes the machine was stopped"});
      }
    }
    return check_ends();
  }

  /// No neighbour contradicts a wrong time in the first or the last rows: it makes a gap.
  [[nodiscard]] MaybeFault check_ends() const {
    if (out_.gap.empty()) {
      return std::nullopt;
    }
    const bool begin = out_.gap.front() < kVouching;
    if (!begin && out_.row.size() - out_.gap.back() >= kVouching) {
      return std::nullopt;
    }
    const std::size_t gap = begin ? out_.gap.front() : out_.gap.back();
    const std::size_t row = begin ? 0 : gap;
    return Fault{
        line_of(row),
        fmt::format("{} is {:.1f} min {} all other rows", shown(out_.time_s[row]),
                    (out_.time_s[gap] - out_.time_s[gap - 1]) / 60.0, begin ? "before" : "after"),
        "correct the row's time, or cut the log here"};
  }

  const LogTable& table_;
  const LogColumn& column_;
  LogClock out_;
};

}  // namespace

std::expected<LogClock, Fault> clock_of(const LogTable& table) {
  return ClockMaker(table).make();
}

}  // namespace steadyrest::thermal::offline
