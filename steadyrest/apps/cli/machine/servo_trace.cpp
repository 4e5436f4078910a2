// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine/servo_capture.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::apps::cli {
namespace servo_trace_reader {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr const char* kTraceAgain =
    "trace the position setpoint and the actual position (or the following error) of each axis, or "
    "take the axis out with --axes";
constexpr std::size_t kMostSamples = 20'000'000;

std::optional<double> number_in(std::string_view text) {
  double out = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), out);
  return read.ec == std::errc() && std::isfinite(out) ? std::optional(out) : std::nullopt;
}

/// One element without content, and where it begins.
struct Element {
  std::size_t at = 0;
  std::map<std::string, std::string, std::less<>> values;

  [[nodiscard]] std::string_view value(std::string_view key) const {
    const auto found = values.find(key);
    return found == values.end() ? std::string_view() : std::string_view(found->second);
  }
};

/// The next element of that name; empty at the end.
std::optional<Element> next_element(std::string_view text, std::string_view name,
                                    std::size_t& from) {
  const std::string begin = fmt::format("<{} ", name);
  const std::size_t at = text.find(begin, from);
  const std::size_t end = text.find('>', at);
  if (at == std::string_view::npos || end == std::string_view::npos) {
    return std::nullopt;
  }
  from = end;
  Element out{at, {}};
  std::string_view rest = text.substr(at + begin.size(), end - at - begin.size());
  for (std::size_t equals = rest.find("=\""); equals != std::string_view::npos;
       equals = rest.find("=\"")) {
    const std::size_t close = rest.find('"', equals + 2);
    if (close == std::string_view::npos) {
      break;
    }
    const std::size_t blank = rest.find_last_of(" \t\r\n", equals) + 1;
    out.values.emplace(rest.substr(blank, equals - blank),
                       rest.substr(equals + 2, close - equals - 2));
    rest.remove_prefix(close + 1);
  }
  return out;
}

/// Fields of the records that one axis needs.
struct TracedAxis {
  std::string command;
  std::string actual;
  std::string following;
  double interval_s = 0.0;
};

/// By the number of the axis: `/Nck/!SD/nckServoDataFlwErr64 [u1, 7]` is axis 7.
std::map<int, TracedAxis> traced_axes(std::string_view text) {
  std::map<int, TracedAxis> out;
  std::size_t from = 0;
  while (const auto signal = next_element(text, "dataSignal", from)) {
    const std::string_view name = signal->value("name");
    const std::size_t comma = name.rfind(", ");
    const auto number =
        comma == std::string_view::npos ? std::nullopt : number_in(name.substr(comma + 2));
    const auto has = [&](std::string_view part) {
      return name.find(part) != std::string_view::npos;
    };
    if (!number || *number < 1.0 || *number > 99.0) {
      continue;
    }
    TracedAxis& axis = out[static_cast<int>(*number)];
    const std::string id(signal->value("id"));
    if (has("ServoDataCmdPos")) {
      axis.command = id;
      axis.interval_s = number_in(signal->value("interval")).value_or(0.0);
    } else if (has("ServoDataFlwErr")) {
      axis.following = id;
    } else if (has("ServoDataActPos") || (has("measPos") && axis.actual.empty())) {
      axis.actual = id;
    }
  }
  std::erase_if(out, [](const auto& one) {
    return one.second.command.empty() ||
           (one.second.actual.empty() && one.second.following.empty());
  });
  return out;
}

/// What was last written of an axis, put down once an interval.
class Held {
 public:
  Held(TracedAxis axis, double unit) : axis_(std::move(axis)), unit_(unit) {}

  /// All values of this time are known: fills the log up to it.
  [[nodiscard]] bool fill(double time_s) {
    if (!command_ || !second_) {
      return true;
    }
    begin_ = begin_ ? begin_ : time_s;
    const double until = (time_s - *begin_) / axis_.interval_s + 0.5;
    if (!(until < static_cast<double>(kMostSamples))) {
      return false;
    }
    while (static_cast<double>(log_.time_s.size()) <= until) {
      const bool now = static_cast<double>(log_.time_s.size()) + 1.0 > until;
      log_.time_s.push_back(*begin_ + static_cast<double>(log_.time_s.size()) * axis_.interval_s);
      const double command = unit_ * (now ? *command_ : *was_command_);
      const double second = unit_ * (now ? *second_ : *was_second_);
      log_.command.push_back(command);
      log_.actual.push_back(axis_.following.empty() ? second : command - second);
    }
    return true;
  }
  /// False where a value of the record is not a number.
  [[nodiscard]] bool take(const Element& record) {
    was_command_ = command_;
    was_second_ = second_;
    return read(record, axis_.command, command_) &&
           read(record, axis_.following.empty() ? axis_.actual : axis_.following, second_);
  }
  [[nodiscard]] contour::offline::ServoLog log() { return std::move(log_); }

 private:
  static bool read(const Element& record, const std::string& id, std::optional<double>& out) {
    const std::string_view text = record.value(id);
    const auto number = number_in(text);
    out = number ? number : out;
    return text.empty() || number.has_value();
  }

  TracedAxis axis_;
  double unit_;
  contour::offline::ServoLog log_;
  std::optional<double> begin_;
  std::optional<double> command_;
  std::optional<double> second_;
  std::optional<double> was_command_;
  std::optional<double> was_second_;
};

Result<RecordedServos> records_of(const std::string& file, std::string_view text,
                                  std::vector<Held> axes) {
  std::size_t from = 0;
  while (const auto record = next_element(text, "rec", from)) {
    const auto time_s = number_in(record->value("time"));
    bool good = time_s.has_value();
    for (Held& axis : axes) {
      good = good && axis.take(*record) && axis.fill(*time_s);
    }
    if (!good) {
      const auto line = 1 + std::ranges::count(text.substr(0, record->at), '\n');
      return refuse(file, static_cast<std::size_t>(line),
                    "the record has no time, or a value that is not a number",
                    "copy the file again, or trace again");
    }
  }
  RecordedServos out;
  for (Held& axis : axes) {
    out.logs.push_back(axis.log());
  }
  return out;
}

}  // namespace
}  // namespace servo_trace_reader

kernel::outcome::Result<RecordedServos> servo_trace(const std::string& file, std::string_view text,
                                                    const ServoSource& source) {
  using kernel::outcome::refuse;
  using servo_trace_reader::Held;
  using servo_trace_reader::kTraceAgain;
  using servo_trace_reader::records_of;
  using servo_trace_reader::traced_axes;
  const auto traced = traced_axes(text);
  std::vector<RecordedAxis> recorded;
  for (const auto& [number, axis] : traced) {
    if (axis.interval_s > 0.0) {
      recorded.push_back({number, {}});
    }
  }
  if (recorded.empty()) {
    return refuse(file,
                  "is XML, but not a trace of SINUMERIK with a position setpoint "
                  "(nckServoDataCmdPos…) and an actual position or following error of one axis",
                  kTraceAgain);
  }
  const auto numbers = numbers_of(file, source, recorded);
  if (!numbers) {
    return std::unexpected(numbers.error());
  }
  std::vector<Held> axes;
  for (std::size_t i = 0; i < numbers->size(); ++i) {
    const bool rotary = source.machine.axes[source.places[i]].rotary;
    axes.emplace_back(traced.at((*numbers)[i]), rotary ? std::numbers::pi / 180.0 : 1.0);
  }
  return records_of(file, text, std::move(axes));
}

}  // namespace steadyrest::apps::cli
