// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/trial/timing/judgement.hpp>

// Turns the timing into a finding that says what to change.
namespace steadyrest::trial::timing {
namespace {

using kernel::machine::Machine;
using passport::Finding;
using passport::Severity;

constexpr double kLongFall_s = 0.25;  ///< beyond it the fall is most of a forecast

/// A forecast reaches to the end of the fall to the lowest step.
double fall_s(const Machine& machine) {
  return (machine.contour.max_ratio - machine.contour.min_ratio) / machine.envelope.feed_fall_1_s;
}

// The fall to the lowest step sets the length of a forecast; it is named only where it is long.
std::string remedy(const LayerTiming& timing, const Machine& machine) {
  constexpr std::string_view kAlways = "lengthen interpolator_period_ms or use a faster computer";
  if (timing.decisions == 0 || fall_s(machine) <= kLongFall_s) {
    return std::string(kAlways);
  }
  return fmt::format(
      "raise feed_fall_percent_s or contour.min_percent to shorten the forecasts (the fall takes "
      "{:.2g} s), {}",
      fall_s(machine), kAlways);
}

}  // namespace

std::vector<Finding> judge(const LayerTiming& timing, const Machine& machine) {
  const double took_s = std::max(timing.work_s.p999, timing.decision_s.p999);
  // By the 99.9 % quantile of cycle or decision, whichever is worse: decisions are rare and would
  // vanish in the mean.
  if (took_s <= kMostShare * timing.cycle_s) {
    return {};
  }
  const bool overruns = took_s > timing.cycle_s;
  std::string what = fmt::format(
      "the layer takes {:.0f} µs of a control cycle of {:.0f} µs (p99.9 of {} {})", 1e6 * took_s,
      1e6 * timing.cycle_s, timing.decisions > 0 ? timing.decisions : timing.cycles,
      timing.decisions > 0 ? "decisions" : "cycles");
  what += overruns
              ? ": it would miss cycles"
              : fmt::format(
                    ", more than {:.0f} % of it: too little is left for the port and the system",
                    1e2 * kMostShare);
  return {{overruns ? Severity::error : Severity::warning, "cycle_time", std::move(what),
           remedy(timing, machine)}};
}

}  // namespace steadyrest::trial::timing
