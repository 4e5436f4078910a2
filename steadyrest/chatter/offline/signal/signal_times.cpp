// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/signal/signal_times.hpp>

// A missing sample shifts the phase of every later order and looks like chatter. So the rows behind
// it keep their places in time, and what is missing is not a number.
namespace steadyrest::chatter::offline {
namespace {

constexpr double kUneven = 0.25;  // of a step
constexpr double kLongestGap_s = 1.0;

/// Most steps are single ones: a few gaps do not move the median.
double median_of(std::vector<double> steps) {
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

bool single(double step, double median_s) {
  return step > 0.0 && std::abs(step - median_s) <= kUneven * median_s;
}

double mean_single(const std::vector<double>& steps, double median_s) {
  double sum_s = 0.0;
  std::size_t count = 0;
  for (const double step : steps) {
    if (single(step, median_s)) {
      sum_s += step;
      ++count;
    }
  }
  return count > 0 ? sum_s / static_cast<double>(count) : median_s;
}

/// Steps of the clock in a step of the rows; none if that is not a whole number or too long.
std::optional<std::size_t> clock_steps(double step, double median_s, double mean_s) {
  if (single(step, median_s)) {
    return 1;
  }
  const double whole = std::round(step / mean_s);
  // Of times nearer together than any rate allows a gap has more steps than can be counted.
  constexpr double kMostSteps = 2.0 * kLongestGap_s * kMostRateHz;
  const bool gap = step > 0.0 && whole >= 2.0 && whole <= kMostSteps &&
                   step - mean_s <= kLongestGap_s &&
                   std::abs(step - whole * mean_s) <= kUneven * mean_s;
  return gap ? std::optional(static_cast<std::size_t>(whole)) : std::nullopt;
}

/// Where samples are missing.
struct Missing {
  std::size_t samples = 0;
  std::size_t places = 0;
  std::size_t first_row = 0;  ///< behind the first

  void add(std::size_t count, std::size_t row) {
    first_row = places == 0 ? row : first_row;
    samples += count;
    ++places;
  }
};

SignalFault uneven(std::size_t line, std::string_view name, double step, double median_s) {
  return {line,
          fmt::format("{} advances by {:.6g} s here and by {:.6g} s elsewhere; allowed: even "
                      "steps, and gaps of whole steps up to {:g} s",
                      name, step, median_s, kLongestGap_s),
          "give samples at an even rate, and times with enough digits; cut the recording at a "
          "long gap"};
}

std::optional<SignalFault> set_rate(double span_s, std::string_view name, EvenTimes& out) {
  // Over the whole record: a single step has only the digits of its stamps.
  out.rate_hz = static_cast<double>(out.samples - 1) / span_s;
  if (auto fault = unfit_rate(out.rate_hz)) {
    if (out.rate_hz < kLeastRateHz) {
      fault->to_do += fmt::format("; check the unit of {}", name);
    }
    return fault;
  }
  out.rate_hz = std::clamp(out.rate_hz, kLeastRateHz, kMostRateHz);
  return std::nullopt;
}

}  // namespace

OrFault<EvenTimes> even_times(const std::vector<double>& time_s,
                              const std::vector<std::size_t>& lines, std::string_view name) {
  if (time_s.size() < 2) {
    return std::unexpected(SignalFault{0, fmt::format("holds {} samples", time_s.size()),
                                       "give a recording of a few tenths of a second"});
  }
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i] = time_s[i + 1] - time_s[i];
  }
  const double median_s = median_of(steps);
  const double mean_s = mean_single(steps, median_s);
  EvenTimes out;
  Missing missing;
  std::vector<std::size_t> place = {0};
  place.reserve(time_s.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto count = clock_steps(steps[i], median_s, mean_s);
    if (!count) {
      return std::unexpected(uneven(lines[i + 1], name, steps[i], median_s));
    }
    if (*count > 1) {
      missing.add(*count - 1, i + 1);
    }
    place.push_back(place.back() + *count);
    if (missing.samples > time_s.size()) {
      return std::unexpected(
          SignalFault{lines[i + 1], "more samples are missing up to here than are in the file",
                      "record without losses; half of the samples at most may be missing"});
    }
  }
  out.start_s = time_s.front();
  out.samples = place.back() + 1;
  if (auto fault = set_rate(time_s.back() - time_s.front(), name, out)) {
    return std::unexpected(std::move(*fault));
  }
  if (missing.places > 0) {
    out.place = std::move(place);
    out.notes.push_back(fmt::format(
        "{} {} missing in {} {}, the first before line {} ({:.6g} s); nothing is heard there",
        missing.samples, missing.samples == 1 ? "sample is" : "samples are", missing.places,
        missing.places == 1 ? "place" : "places", lines[missing.first_row],
        time_s[missing.first_row]));
  }
  return out;
}

void spread(const EvenTimes& times, std::vector<double>& values) {
  if (times.place.empty()) {
    return;
  }
  std::vector<double> out(times.samples, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < values.size(); ++i) {
    out[times.place[i]] = values[i];
  }
  values = std::move(out);
}

}  // namespace steadyrest::chatter::offline
