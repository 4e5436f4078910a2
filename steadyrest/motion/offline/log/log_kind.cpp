// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/log/log_kind.hpp>

// A log of the wrong kind gives estimates that look sensible but are wrong. Rows of cycles are even
// in time and step by any count; rows of edges step by one count at any time. At constant speed
// edges are even in time too: then only the rounding tells them apart, since counts read at given
// times are rounded, while at edges they are exact.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr std::size_t kLeastRows = 20;
constexpr double kNear = 0.1;      // of a step: jitter, and the change of speed in a cycle
constexpr double kOnGrid = 0.01;   // of a step
constexpr double kMostRows = 0.9;  // that must comply
constexpr double kFewRows = 0.02;  // that may differ

/// Properties of the steps from row to row, as shares of all steps.
struct Steps {
  double median_s = 0.0;
  double even = 0.0;      ///< near the median
  double of_cycle = 0.0;  ///< near the control cycle
  double by_one = 0.0;    ///< of the count
  double standing = 0.0;  ///< near the median, the count as before
  double other = 0.0;     ///< near the median, the count by none or by several
  double on_grid = 0.0;   ///< rows at multiples of the median
};

// One pass after finding the median; shares, so that lost rows do not decide.
Steps steps_of(const EdgeLog& log, double cycle_hz) {
  std::vector<double> step;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    step.push_back(log.rows[i].t_s - log.rows[i - 1].t_s);
  }
  std::vector<double> sorted = step;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  // The median: lost rows and standstills do not move it.
  std::ranges::nth_element(sorted, middle);
  Steps out;
  out.median_s = *middle;
  const double share = 1.0 / static_cast<double>(step.size());
  for (std::size_t i = 0; i < step.size(); ++i) {
    const std::int64_t counts = std::abs(log.rows[i + 1].count - log.rows[i].count);
    const bool even = std::abs(step[i] - out.median_s) <= kNear * out.median_s;
    out.even += even ? share : 0.0;
    out.of_cycle += std::abs(step[i] * cycle_hz - 1.0) <= kNear ? share : 0.0;
    out.by_one += counts == 1 ? share : 0.0;
    out.standing += even && counts == 0 ? share : 0.0;
    out.other += even && counts != 1 ? share : 0.0;
    const double cycles = log.rows[i + 1].t_s / out.median_s;
    out.on_grid += std::abs(cycles - std::round(cycles)) <= kOnGrid ? share : 0.0;
  }
  return out;
}

/// Whether the counts were rounded at the rows' times. Between edges Δt is proportional to Δc,
/// except for changes of speed.
bool counts_are_rounded(const EdgeLog& log, double median_s) {
  constexpr double kRounded = 0.35;  // counts RMS; rounding gives 0.65, line errors of 5 % some 0.1
  double square = 0.0;
  double seen = 0.0;
  for (std::size_t i = 3; i < log.rows.size(); ++i) {
    std::array<double, 3> step_s{};
    std::array<double, 3> counts{};
    for (std::size_t k = 0; k < step_s.size(); ++k) {
      step_s[k] = log.rows[i - 2 + k].t_s - log.rows[i - 3 + k].t_s;
      counts[k] = static_cast<double>(log.rows[i - 2 + k].count - log.rows[i - 3 + k].count);
    }
    const bool even = std::ranges::all_of(
        step_s, [&](double s) { return std::abs(s - median_s) <= kNear * median_s; });
    if (!even || counts[0] * counts[1] <= 0.0 || counts[1] * counts[2] <= 0.0) {
      continue;  // lost rows, a turn, standstill
    }
    // The mean of both neighbours: a constant acceleration drops out.
    const double speed = 0.5 * (counts[0] / step_s[0] + counts[2] / step_s[2]);
    const double off = counts[1] - speed * step_s[1];
    square += off * off;
    seen += 1.0;
  }
  return seen > 0.0 && square > kRounded * kRounded * seen;
}

}  // namespace

// Refused only where the kind is certain; a doubtful log is trusted.
std::optional<Refusal> other_kind(const EdgeLog& log, LogInput input, double cycle_hz) {
  if (log.rows.size() < kLeastRows) {
    return std::nullopt;
  }
  const Steps steps = steps_of(log, cycle_hz);
  if (!(steps.median_s > 0.0)) {
    return std::nullopt;
  }
  if (input == LogInput::edges && steps.even > kMostRows && steps.other > kFewRows &&
      (steps.standing > kFewRows || steps.on_grid > kMostRows ||
       counts_are_rounded(log, steps.median_s))) {
    return bad_input(
        log.file,
        fmt::format("is not a log of edges: its rows are {:.6g} ms apart, and {:.0f} % "
                    "of them do not step by one count",
                    1e3 * steps.median_s, 100.0 * (1.0 - steps.by_one)),
        "one row per cycle is --input ticks; calibration needs one row per edge");
  }
  if (input == LogInput::ticks && steps.by_one > kMostRows && steps.of_cycle < 0.5) {
    return bad_input(log.file,
                     fmt::format("is not a log of cycles: {:.0f} % of its rows step by one count, "
                                 "and they are not {:.6g} ms apart but {:.6g} ms (median)",
                                 100.0 * steps.by_one, 1e3 / cycle_hz, 1e3 * steps.median_s),
                     "one row per edge is --input edges; for cycles give --cycle-hz as logged");
  }
  return std::nullopt;
}

}  // namespace steadyrest::motion::offline
