// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/table/packed_file.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/offline/log/log_clock.hpp>
#include <steadyrest/thermal/offline/log/log_table.hpp>
#include <steadyrest/thermal/online/sensor_watch.hpp>

// From a table to a Log: the clock first, since all rows depend on it, then the speed, which must
// be complete, then each channel with its wild, stuck and absent readings removed. Doubtful but
// usable data becomes a note; data that would make a fit lie is refused with its line.
namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::Result;
using kernel::units::kNan;

constexpr double kMostSpeed_rpm = 200'000.0;
constexpr double kMostDisplacement_mm = 2.0;
constexpr double kColdest_c = -50.0;
constexpr double kHottest_c = 150.0;
constexpr double kLeastRange_mm = 0.5e-3;
constexpr double kAbsentShare = 0.5;  ///< a sensor silent for more than this is absent
constexpr double kWild_share = 0.01;  ///< up to this, single impossible readings are left out
constexpr double kLively = 0.1;       ///< share of rows in which a living sensor changes

class LogMaker {
 public:
  LogMaker(LogTable table, std::string file) : table_(std::move(table)) {
    log_.file = std::move(file);
  }

  Result<Log> make() {
    for (const table::Fault& passed : table_.notes) {
      note(passed.line, passed.what, passed.to_do);
    }
    if (!table_.passed_over.empty()) {
      note(table_.head_line,
           fmt::format("columns whose names end in no known unit: {}",
                       fmt::join(table_.passed_over, ", ")),
           "they are skipped");
    }
    for (const auto step : {&LogMaker::take_clock, &LogMaker::take_speed, &LogMaker::take_channels,
                            &LogMaker::check_what_is_left}) {
      if (auto done = (this->*step)(); !done) {
        return std::unexpected(std::move(done.error()));
      }
    }
    return std::move(log_);
  }

 private:
  using Done = Result<void>;

  void note(std::size_t line, const std::string& what, const std::string& done) {
    log_.notes.push_back(line == 0 ? fmt::format("{}: {}; {}", log_.file, what, done)
                                   : fmt::format("{}:{}: {}; {}", log_.file, line, what, done));
  }
  [[nodiscard]] std::unexpected<Refusal> refuse(std::size_t line, std::string what,
                                                std::string to_do) const {
    return kernel::outcome::refuse(log_.file, line, std::move(what), std::move(to_do));
  }
  [[nodiscard]] const LogColumn& only(Quantity quantity) const {
    return *std::ranges::find(table_.column, quantity, &LogColumn::quantity);
  }
  [[nodiscard]] std::size_t line_of_row(std::size_t kept) const { return table_.line[row_[kept]]; }

  Done take_clock() {
    auto clock = clock_of(table_);
    if (!clock) {
      table::Fault& fault = clock.error();
      return refuse(fault.line, std::move(fault.what), std::move(fault.to_do));
    }
    for (const table::Fault& passed : clock->notes) {
      note(passed.line, passed.what, passed.to_do);
    }
    row_ = std::move(clock->row);
    log_.time_s = std::move(clock->time_s);
    log_.origin_s = clock->origin_s;
    log_.gap = std::move(clock->gap);
    return {};
  }

  // The one column that may have no holes: nothing replaces unrecorded heat.
  Done take_speed() {
    const LogColumn& speed = only(Quantity::speed);
    for (std::size_t k = 0; k < row_.size(); ++k) {
      const double n = std::abs(speed.value[row_[k]]);
      const double rpm = kernel::units::rpm_from_rev_s(n);
      if (!(rpm <= kMostSpeed_rpm)) {
        return refuse(line_of_row(k),
                      std::isnan(n)
                          ? fmt::format("{} is empty", speed.name)
                          : fmt::format("{} = {:.6g} is implausible; at most {:.0f} is allowed",
                                        speed.name, rpm, kMostSpeed_rpm),
                      "give the spindle speed in every row, in rpm; 0 when stopped");
      }
      log_.speed_rev_s.push_back(n);
    }
    return {};
  }

  // Wild first: a wild run would look stuck, and a stuck one would hide from the step test.
  Done take_channels() {
    for (const LogColumn& column : table_.column) {
      if (column.quantity != Quantity::displacement && column.quantity != Quantity::temperature) {
        continue;
      }
      LogChannel channel{column.name, {}};
      for (const std::size_t row : row_) {
        channel.value.push_back(column.value[row]);
      }
      if (column.quantity == Quantity::displacement) {
        note_absent(channel);
      }
      auto fit = drop_wild(channel, column);
      if (!fit) {
        return fit;
      }
      drop_stuck(channel);
      if (column.quantity == Quantity::temperature) {
        drop_unbelieved(channel);
      }
      keep(std::move(channel), column.quantity);
    }
    return {};
  }

  /// A bridged temperature loses nothing. A displacement loses data for the fit.
  void note_absent(const LogChannel& channel) {
    const auto absent = [](double v) { return std::isnan(v); };
    if (const auto count = std::ranges::count_if(channel.value, absent); count > 0) {
      const auto first = std::ranges::find_if(channel.value, absent) - channel.value.begin();
      note(line_of_row(static_cast<std::size_t>(first)),
           fmt::format("{} has no reading in {} of {} rows, from here on", channel.name, count,
                       channel.value.size()),
           "it is fitted without them");
    }
  }

  /// Impossible values: single ones are left out, more mean a wrong unit.
  Done drop_wild(LogChannel& channel, const LogColumn& column) {
    const bool length = column.quantity == Quantity::displacement;
    const double least = length ? -kMostDisplacement_mm : kColdest_c;
    const double most = length ? kMostDisplacement_mm : kHottest_c;
    std::size_t wild = 0;
    std::size_t first = 0;
    for (std::size_t k = 0; k < channel.value.size(); ++k) {
      if (channel.value[k] < least || channel.value[k] > most) {
        first = wild == 0 ? k : first;
        ++wild;
      }
    }
    if (wild == 0) {
      return {};
    }
    // Back to the log's own unit, so that the refusal names what is in the file.
    const auto shown_as = [&](double inner) { return (inner - column.offset) / column.factor; };
    const std::string what =
        fmt::format("{} = {:.6g} is implausible", channel.name, shown_as(channel.value[first]));
    const std::string range =
        fmt::format("{:.6g} … {:.6g} is allowed", shown_as(least), shown_as(most));
    // A spike or two is a loose plug; one row in a hundred is a wrong unit.
    if (static_cast<double>(wild) > kWild_share * static_cast<double>(channel.value.size())) {
      return refuse(line_of_row(first), what + "; " + range,
                    "make the column's unit agree with its name: _um or _mm, _c, _k or _f");
    }
    note(line_of_row(first),
         wild == 1 ? what : fmt::format("{}, the first of {} such readings", what, wild),
         range + (wild == 1 ? ", so it is skipped" : ", so they are skipped"));
    for (double& value : channel.value) {
      value = value < least || value > most ? kNan : value;
    }
    return {};
  }

  /// The first reading confirmed by the next one; nothing vouches for those before it. Without this
  /// a wrong first reading would make the watch doubt all that follow.
  [[nodiscard]] std::size_t first_believed(const LogChannel& channel) const {
    using online::SensorWatch;
    std::size_t k = 0;
    for (std::size_t next = 1; next < channel.value.size(); ++next) {
      if (std::isnan(channel.value[next])) {
        continue;
      }
      const double reach_k =
          SensorWatch::kStep_k + SensorWatch::kRate_k_s * (log_.time_s[next] - log_.time_s[k]);
      if (std::abs(channel.value[next] - channel.value[k]) <= reach_k) {
        return k;
      }
      k = next;
    }
    return 0;
  }

  /// Drops what would not be believed on line either.
  void drop_unbelieved(LogChannel& channel) {
    using online::SensorWatch;
    SensorWatch watch;  // one sensor only: drop_stuck() handles stuck
    std::size_t wild = 0;
    std::size_t first = 0;
    double first_c = 0.0;
    const std::size_t begin = first_believed(channel);
    for (std::size_t k = 0; k < channel.value.size(); ++k) {
      kernel::signal::Temperatures seen{};
      seen[0] = channel.value[k];
      const bool before = k < begin && std::isfinite(seen[0]);
      if (k >= begin) {
        // The on-line rules, row by row: a passport fitted with readings that the machine will not
        // believe would forecast from inputs that it never gets.
        watch.update(k == begin ? 0.0 : log_.time_s[k] - log_.time_s[k - 1], 1, seen);
      }
      if (!before && watch.fault(0) != kernel::outcome::Reason::thermal_sensor_wild) {
        continue;
      }
      if (wild++ == 0) {
        first = k;
        first_c = channel.value[k];
      }
      channel.value[k] = kNan;
    }
    if (wild > 0) {
      note(line_of_row(first),
           fmt::format("{} is implausible in {} rows, starting here ({:.4g} °C): outside {:.0f} … "
                       "{:.0f} °C, or a step that no machine part could make",
                       channel.name, wild, first_c, SensorWatch::kColdest_c,
                       SensorWatch::kHottest_c),
           "these readings are skipped");
    }
  }

  // Here, unlike on line, stuck is judged over the whole log, since the sensor's later behaviour is
  // known. Runs of the same value are divided into those that are too long and live ones.
  void drop_stuck(LogChannel& channel) {
    std::vector<std::pair<std::size_t, std::size_t>> stuck;
    std::size_t changes = 0;
    std::size_t lived = 0;
    for (std::size_t from = 0; from < channel.value.size();) {
      std::size_t to = from + 1;
      while (to < channel.value.size() && channel.value[to] == channel.value[from]) {
        ++to;
      }
      if (log_.time_s[to - 1] - log_.time_s[from] >= kStuck_s) {
        stuck.emplace_back(from, to);
      } else {
        ++changes;
        lived += to - from;
      }
      from = to;
    }
    // A coarse sensor in a steady room also repeats itself for hours. Only one that otherwise
    // changes often, or never does, is stuck.
    const bool living = static_cast<double>(changes) > kLively * static_cast<double>(lived);
    const bool dead = lived == 0;
    if (stuck.empty() || (!living && !dead)) {
      return;
    }
    double hours = 0.0;
    for (const auto& [from, to] : stuck) {
      hours += (log_.time_s[to - 1] - log_.time_s[from]) / 3600.0;
      // The first reading of a run was live when it was taken; only its repetitions are not.
      std::fill(channel.value.begin() + static_cast<std::ptrdiff_t>(from) + (from == 0 ? 0 : 1),
                channel.value.begin() + static_cast<std::ptrdiff_t>(to), kNan);
    }
    note(line_of_row(stuck.front().first),
         fmt::format("{} is stuck: the same to the last digit for {:.1f} h", channel.name, hours),
         dead ? "it is skipped" : "these hours of it are skipped");
  }

  void bridge(LogChannel& channel) {
    std::size_t known = channel.value.size();  // none yet
    for (std::size_t k = 0; k < channel.value.size(); ++k) {
      if (std::isnan(channel.value[k])) {
        continue;
      }
      // A straight line over minutes errs little; over hours it would invent a room. Longer holes
      // hold the last value, as on line.
      const bool hole = known < k && known + 1 < k;
      if (hole && log_.time_s[k] - log_.time_s[known] <= kBridge_s) {
        for (std::size_t j = known + 1; j < k; ++j) {
          const double share =
              (log_.time_s[j] - log_.time_s[known]) / (log_.time_s[k] - log_.time_s[known]);
          channel.value[j] =
              channel.value[known] + share * (channel.value[k] - channel.value[known]);
        }
      }
      known = k;
    }
  }

  // A displacement with holes is simply not read there; a temperature is an input and must be known
  // in every row.
  void keep(LogChannel channel, Quantity quantity) {
    const auto silent =
        std::ranges::count_if(channel.value, [](double v) { return std::isnan(v); });
    // More than half missing: the rest would be bridged or held for longer than it was measured.
    const double share = static_cast<double>(silent) / static_cast<double>(channel.value.size());
    if (share > kAbsentShare) {
      note(table_.head_line,
           fmt::format("{} has no value in {:.0f} % of the rows", channel.name, 100.0 * share),
           "the sensor is skipped");
      return;
    }
    if (quantity == Quantity::temperature) {
      bridge(channel);
    }
    const bool holes = std::ranges::any_of(channel.value, [](double v) { return std::isnan(v); });
    if (quantity == Quantity::temperature && holes) {
      note(table_.head_line,
           fmt::format("{} has gaps longer than {:.0f} min", channel.name, kBridge_s / 60.0),
           "its last value is held there");
    }
    if (quantity == Quantity::displacement) {
      check_range(channel);
    }
    (quantity == Quantity::displacement ? log_.displacement : log_.temperature)
        .push_back(std::move(channel));
  }

  // Half a micrometre in all is less than any spindle moves: mm in a column named µm look like
  // this.
  void check_range(const LogChannel& channel) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const double v : channel.value) {
      // Comparisons with NaN are false, so holes drop out.
      least = v < least ? v : least;
      most = v > most ? v : most;
    }
    if (most - least < kLeastRange_mm) {
      note(table_.head_line,
           fmt::format("{} moves by {:.3g} µm in all: does its unit agree with its name?",
                       channel.name, kernel::units::um_from_mm(most - least)),
           "the unit in the name is used");
    }
  }

  Done check_what_is_left() {
    if (log_.displacement.empty()) {
      return refuse(table_.head_line, "no usable displacement is left",
                    "check that the probes are connected and their columns have readings");
    }
    return {};
  }

  LogTable table_;
  std::vector<std::size_t> row_;  ///< of the table, for each row of the log
  Log log_;
};

}  // namespace

Result<Log> parse_log(std::string_view text, const std::string& file, const table::Format& format) {
  auto table = parse_log_table(text, file, format);
  if (!table) {
    return std::unexpected(std::move(table.error()));
  }
  return LogMaker(std::move(*table), file).make();
}

Result<Log> read_log(const std::string& path, const table::Format& format) {
  const auto text = table::read_packed(path);
  if (!text) {
    return std::unexpected(text.error());
  }
  return parse_log(*text, path, format);
}

}  // namespace steadyrest::thermal::offline
