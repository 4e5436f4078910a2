// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/signal/signal_columns.hpp>
#include <steadyrest/chatter/offline/signal/signal_layout.hpp>
#include <steadyrest/chatter/offline/signal/signal_parts.hpp>
#include <steadyrest/chatter/offline/signal/signal_times.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kUnknown_rev_s = std::numeric_limits<double>::quiet_NaN();

/// A column of the file as it fills.
struct Sensor {
  enum class Kind : std::uint8_t { empty, numbers, words };
  std::size_t column = 0;
  Kind kind = Kind::empty;  ///< by its first field that is not empty
  std::vector<double> value;
  std::size_t gaps = 0;
  std::size_t first_gap = 0;  ///< row
};

class SignalSink final : public table::Sink {
 public:
  explicit SignalSink(const table::Format& format) : format_(format) {}

  std::optional<SignalFault> head(const table::Head& head) override {
    auto columns = columns_of(head, format_);
    if (!columns) {
      return columns.error();
    }
    columns_ = std::move(*columns);
    for (const std::size_t column : columns_.signal) {
      // What is called a value must be one from the first row on.
      const bool value = head.name[column] == "value";
      sensors_.push_back({column, value ? Sensor::Kind::numbers : Sensor::Kind::empty, {}, 0, 0});
    }
    return std::nullopt;
  }

  std::optional<SignalFault> row(const table::Row& row) override {
    const auto t_s = columns_.clock->seconds(row);
    if (!t_s) {
      return t_s.error();
    }
    for (Sensor& sensor : sensors_) {
      if (auto fault = take_field(row, sensor)) {
        return fault;
      }
    }
    time_s_.push_back(*t_s);
    lines_.push_back(row.line());
    return columns_.speed ? take_speed(row) : std::nullopt;
  }

  OrFault<RecordedChannels> take(const SignalLayout& layout) {
    const std::string& clock = layout.time.empty() ? columns_.time : layout.time;
    auto times = even_times(time_s_, lines_, clock);
    if (!times && format_.rows_are_samples && time_s_.size() > 1 &&
        !unfit_rate(format_.sample_hz)) {
      times = EvenTimes{.start_s = 0.0,
                        .rate_hz = format_.sample_hz,
                        .samples = time_s_.size(),
                        .place = {},
                        .notes = {fmt::format("{} is not even: replaced by {:.6g} samples a second",
                                              clock, format_.sample_hz)}};
    }
    if (!times) {
      return std::unexpected(times.error());
    }
    std::vector<std::string> notes = layout.notes;
    notes.insert(notes.end(), columns_.notes.begin(), columns_.notes.end());
    notes.insert(notes.end(), times->notes.begin(), times->notes.end());
    RecordedChannels out;
    for (Sensor& sensor : sensors_) {
      const ColumnName& name = columns_.name[sensor.column];
      if (sensor.kind == Sensor::Kind::numbers) {
        out.push_back(channel_of(sensor, name, *times));
        out.back().channel = out.size();
      } else {
        notes.push_back(fmt::format("column {} {} and is not read", shown_name(name.written),
                                    sensor.kind == Sensor::Kind::words ? "has words" : "is empty"));
      }
    }
    if (out.empty()) {
      return std::unexpected(SignalFault{0, "no column beside time and speed has numbers",
                                         "give a recording with a sensor's readings"});
    }
    if (columns_.speed) {
      hold_speed(*times);
    }
    for (RecordedSignal& signal : out) {
      signal.speed_rev_s = speed_rev_s_;
      signal.notes.insert(signal.notes.begin(), notes.begin(), notes.end());
    }
    return out;
  }

 private:
  std::optional<SignalFault> take_field(const table::Row& row, Sensor& sensor) const {
    const std::string_view field = row.field(sensor.column);
    const bool gap = is_gap(field);
    if (sensor.kind == Sensor::Kind::empty && !gap) {
      sensor.kind = is_number(field) ? Sensor::Kind::numbers : Sensor::Kind::words;
    }
    if (sensor.kind == Sensor::Kind::words) {
      return std::nullopt;
    }
    if (gap) {
      sensor.first_gap = sensor.gaps++ == 0 ? lines_.size() : sensor.first_gap;
      sensor.value.push_back(std::numeric_limits<double>::quiet_NaN());
      return std::nullopt;
    }
    const auto value = row.number(sensor.column);
    if (!value) {
      return value.error();
    }
    sensor.value.push_back(*value);
    return std::nullopt;
  }

  std::optional<SignalFault> take_speed(const table::Row& row) {
    if (is_gap(row.field(*columns_.speed))) {
      speed_rev_s_.push_back(kUnknown_rev_s);
      return std::nullopt;
    }
    const auto speed = row.number(*columns_.speed);
    if (!speed) {
      return speed.error();
    }
    speed_rev_s_.push_back(std::abs(*speed) * columns_.speed_rev_s);
    return std::nullopt;
  }

  /// A speed is read less often than a vibration: it holds for up to a second.
  void hold_speed(const EvenTimes& times) {
    spread(times, speed_rev_s_);
    const auto longest = static_cast<std::size_t>(times.rate_hz);
    const auto known =
        std::ranges::find_if(speed_rev_s_, [](double s) { return std::isfinite(s); });
    std::size_t since = 0;
    double last = known != speed_rev_s_.end() &&
                          static_cast<std::size_t>(known - speed_rev_s_.begin()) <= longest
                      ? *known
                      : kUnknown_rev_s;
    for (double& speed : speed_rev_s_) {
      since = std::isfinite(speed) ? 0 : since + 1;
      last = std::isfinite(speed) ? speed : since > longest ? kUnknown_rev_s : last;
      speed = last;
    }
  }

  RecordedSignal channel_of(Sensor& sensor, const ColumnName& name, const EvenTimes& times) const {
    RecordedSignal out;
    out.name = name.name;
    out.unit = name.unit;
    out.written = name.written;
    out.rate_hz = times.rate_hz;
    out.start_s = times.start_s;
    if (sensor.gaps > 0) {
      out.notes.push_back(fmt::format(
          "{}: {} not {}, the first in line {} ({:.6g} s); nothing is heard there",
          shown_name(name.written),
          fmt::format("{} {}", sensor.gaps, sensor.gaps == 1 ? "sample is" : "samples are"),
          sensor.gaps == 1 ? "a number" : "numbers", lines_[sensor.first_gap],
          time_s_[sensor.first_gap]));
    }
    spread(times, sensor.value);
    out.value = std::move(sensor.value);
    return out;
  }

  const table::Format& format_;
  SignalColumns columns_;
  std::vector<Sensor> sensors_;
  std::vector<double> time_s_;
  std::vector<std::size_t> lines_;
  std::vector<double> speed_rev_s_;
};

/// The lines from the head on; those before it keep their numbers.
std::optional<SignalFault> read_lines(std::string_view text, const SignalLayout& layout,
                                      table::RowReader& rows) {
  for (std::size_t line = 1; line <= layout.head_line && !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const bool named = line == layout.head_line && layout.columns.empty();
    if (auto fault = rows.line(named ? std::string_view(layout.head) : std::string_view())) {
      return fault;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return table::read_rows(text, rows);
}

}  // namespace

OrFault<RecordedChannels> parse_csv_signals(std::string_view text, const table::Format& format) {
  auto layout = layout_of(text, format);
  if (!layout) {
    return std::unexpected(std::move(layout.error()));
  }
  table::Format used = format;
  if (!layout->columns.empty()) {
    used.columns = layout->columns;
  }
  SignalSink signal(used);
  table::RowReader rows(used, signal);
  if (auto fault = read_lines(text, *layout, rows)) {
    return std::unexpected(std::move(*fault));
  }
  for (const SignalFault& note : rows.notes()) {
    layout->notes.push_back(fmt::format("line {} {}; {}", note.line, note.what, note.to_do));
  }
  return signal.take(*layout);
}

}  // namespace steadyrest::chatter::offline
