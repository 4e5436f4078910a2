// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/signal/signal_parts.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/row_reader.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kUneven = 0.25;  // of a step

/// Snaps a rate that is nearly on a bound to the bound.
double rate_of(double rate_hz) {
  return std::clamp(rate_hz, kLeastRateHz, kMostRateHz);
}

class SignalSink final : public table::Sink {
 public:
  explicit SignalSink(const table::Format& format) : format_(format) {}

  std::optional<SignalFault> head(const table::Head& head) override {
    for (const std::string_view name : {"t_s", "value", "speed_rpm"}) {
      if (auto fault = head.twice(name)) {
        return fault;
      }
    }
    const auto missing = [](std::string_view name) {
      return SignalFault{0, fmt::format("the column {} is missing in the header", name),
                         "name the columns t_s, value and, if recorded, speed_rpm in the first "
                         "line, or with --columns"};
    };
    clock_ = table::Clock::of(head, format_);
    if (!clock_) {
      return missing("t_s");
    }
    const auto value = head.place("value");
    if (!value) {
      return missing("value");
    }
    value_ = *value;
    speed_ = head.place("speed_rpm");
    return std::nullopt;
  }

  std::optional<SignalFault> row(const table::Row& row) override {
    const auto t_s = clock_->seconds(row);
    if (!t_s) {
      return t_s.error();
    }
    const auto value = row.number(value_);
    if (!value) {
      return value.error();
    }
    time_s_.push_back(*t_s);
    lines_.push_back(row.line());
    out_.value.push_back(*value);
    if (speed_) {
      const auto speed_rpm = row.number(*speed_);
      if (!speed_rpm) {
        return speed_rpm.error();
      }
      out_.speed_rev_s.push_back(kernel::units::rev_s_from_rpm(std::abs(*speed_rpm)));
    }
    return std::nullopt;
  }

  OrFault<RecordedSignal> take() {
    if (time_s_.size() < 2) {
      return std::unexpected(SignalFault{0, fmt::format("holds {} samples", time_s_.size()),
                                         "give a CSV with columns t_s and value, or a WAV"});
    }
    std::vector<double> steps(time_s_.size() - 1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      steps[i] = time_s_[i + 1] - time_s_[i];
    }
    std::vector<double> sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    const double median_s = *middle;
    // A missing sample shifts the phase of every later order and looks like chatter: refused rather
    // than filled. A few gaps do not move the median step.
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (!(steps[i] > 0.0 && std::abs(steps[i] - median_s) <= kUneven * median_s)) {
        return std::unexpected(SignalFault{
            lines_[i + 1],
            fmt::format("t_s advances by {:.6g} s here and by {:.6g} s elsewhere", steps[i],
                        median_s),
            "give samples at an even rate with none missing, and t_s with enough digits"});
      }
    }
    out_.start_s = time_s_.front();
    // Over the whole record: a single step has only the digits of its stamps.
    out_.rate_hz = static_cast<double>(steps.size()) / (time_s_.back() - time_s_.front());
    if (auto fault = unfit_rate(out_.rate_hz)) {
      if (out_.rate_hz < kLeastRateHz) {
        fault->to_do += "; t_s is in seconds";
      }
      return std::unexpected(std::move(*fault));
    }
    out_.rate_hz = rate_of(out_.rate_hz);
    return std::move(out_);
  }

 private:
  const table::Format& format_;
  std::optional<table::Clock> clock_;
  std::size_t value_ = 0;
  std::optional<std::size_t> speed_;
  std::vector<double> time_s_;
  std::vector<std::size_t> lines_;
  RecordedSignal out_;
};

}  // namespace

OrFault<RecordedSignal> parse_csv_signal(std::string_view text, const table::Format& format) {
  SignalSink signal(format);
  table::RowReader rows(format, signal);
  if (auto fault = table::read_rows(text, rows)) {
    return std::unexpected(std::move(*fault));
  }
  return signal.take();
}

}  // namespace steadyrest::chatter::offline
