// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/chatter/offline/signal/signal_columns.hpp>

namespace steadyrest::chatter::offline {
namespace {

class PartFinder {
 public:
  PartFinder(const table::Head& head, const table::Format& format) : head_(head), format_(format) {
    for (std::size_t i = 0; i < head.name.size(); ++i) {
      out_.name.push_back(column_name(head.written[i], head.name[i]));
    }
  }

  OrFault<SignalColumns> find() {
    for (const std::string_view name : {"t_s", "value", "speed_rpm"}) {
      if (auto fault = head_.twice(name)) {
        return std::unexpected(std::move(*fault));
      }
    }
    if (auto fault = find_clock()) {
      return std::unexpected(std::move(*fault));
    }
    if (auto fault = find_speed()) {
      return std::unexpected(std::move(*fault));
    }
    if (auto fault = find_signals()) {
      return std::unexpected(std::move(*fault));
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::string written_names() const {
    std::vector<std::string> names;
    names.reserve(out_.name.size());
    for (const ColumnName& column : out_.name) {
      names.push_back("\"" + shown_name(column.written) + "\"");
    }
    return fmt::format("{}", fmt::join(names, ", "));
  }

  /// A name that table::Clock does not know is put into the form that it does.
  std::optional<SignalFault> find_clock() {
    table::Head known = head_;
    for (std::size_t i = 0; i < out_.name.size() && !table::time_column(known) && !head_.epoch;
         ++i) {
      const auto time = names_a_time(out_.name[i]);
      if (!time || head_.stamped == i || head_.clocked == i) {
        continue;
      }
      known.name[i] = fmt::format("t_{}", time->unit);
      if (!time->stated) {
        out_.notes.push_back(
            fmt::format("{} has no unit: taken as seconds", shown_name(head_.written[i])));
      }
    }
    out_.clock = table::Clock::of(known, format_);
    if (!out_.clock) {
      return SignalFault{0,
                         fmt::format("the column t_s is missing in the header: {} {} no time",
                                     written_names(), out_.name.size() == 1 ? "is" : "are"),
                         "name a column t_s, Time (s) or the like, in the first line or with "
                         "--columns, or give --rate-hz, the samples per second"};
    }
    if (const auto column = out_.clock->column()) {
      out_.time = shown_name(head_.written[*column]);
    }
    return std::nullopt;
  }

  std::optional<SignalFault> find_speed() {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < out_.name.size(); ++i) {
      if (is_time(i)) {
        continue;
      }
      const auto speed = names_a_speed(out_.name[i]);
      if (speed && head_.name[i] == "speed_rpm") {
        found = {i};
        break;
      }
      if (speed) {
        found.push_back(i);
      }
    }
    if (found.empty()) {
      return std::nullopt;
    }
    if (found.size() > 1) {
      return SignalFault{
          0,
          fmt::format(R"("{}" and "{}" may both be the spindle's speed)",
                      shown_name(head_.written[found[0]]), shown_name(head_.written[found[1]])),
          "name one speed_rpm, in the header or with --columns, where - skips a column"};
    }
    out_.speed = found.front();
    const auto speed = names_a_speed(out_.name[*out_.speed]);
    out_.speed_rev_s = speed->rev_s;
    if (!speed->stated) {
      out_.notes.push_back(
          fmt::format("{} has no unit: taken as rev/min", shown_name(head_.written[*out_.speed])));
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_time(std::size_t i) const {
    return out_.clock->column() == i || head_.stamped == i || head_.clocked == i ||
           head_.epoch == i || names_a_time(out_.name[i]).has_value();
  }

  std::optional<SignalFault> find_signals() {
    const auto value = head_.place("value");
    std::vector<std::string> unread;
    std::vector<std::size_t> slow;
    for (std::size_t i = 0; i < out_.name.size(); ++i) {
      if (is_time(i) || out_.speed == i || head_.written[i].empty() || numbers_rows(out_.name[i])) {
        continue;
      }
      if (value && *value != i) {
        unread.push_back(shown_name(head_.written[i]));
      } else if (is_slow_quantity(out_.name[i])) {
        slow.push_back(i);
      } else {
        out_.signal.push_back(i);
      }
    }
    if (!unread.empty()) {
      out_.notes.push_back(fmt::format("value alone is judged, not {}", fmt::join(unread, ", ")));
    }
    // The only column is judged, whatever it is: a drive's load may have been recorded on purpose.
    if (out_.signal.empty()) {
      std::swap(out_.signal, slow);
    }
    for (const std::size_t i : slow) {
      out_.notes.push_back(
          fmt::format("{} is not vibration: not judged", shown_name(head_.written[i])));
    }
    if (out_.signal.empty()) {
      return SignalFault{0, fmt::format("the column value is missing in {}", written_names()),
                         "record a sensor beside time and speed: a microphone, an accelerometer, "
                         "a force or a power"};
    }
    return std::nullopt;
  }

  const table::Head& head_;
  const table::Format& format_;
  SignalColumns out_;
};

}  // namespace

OrFault<SignalColumns> columns_of(const table::Head& head, const table::Format& format) {
  return PartFinder(head, format).find();
}

}  // namespace steadyrest::chatter::offline
