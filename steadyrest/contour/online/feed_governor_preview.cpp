// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <steadyrest/contour/online/feed_governor.hpp>

// What a step would give, for display. Everything here is const and works on a copy of the forecast
// (8 kB), so the governor's own state never changes.
namespace steadyrest::contour::online {
namespace {

/// Settling times until nothing is left of the step before: 2 of 4/k each leave e⁻⁸ of its lag.
constexpr double kSettled = 2.0;

}  // namespace

/// The step is in force from now on. The error is judged once the change has settled, and within
/// the first half of what the path is known for, so that the other half is judged.
RatioPlan FeedGovernor::held_plan(double ratio, double known_s) const noexcept {
  const Forecast::Timing& timing = forecast_.timing();
  const double longest_s = static_cast<double>(Forecast::kMaxSteps) * timing.step_s;
  RatioPlan plan;
  plan.start = plan.target = plan.floor = ratio;
  plan.judged_from_s = std::min(timing.dead_s + timing.scan_s + kSettled * timing.settle_s,
                                0.5 * std::min(longest_s, known_s));
  plan.hold_s = plan.judged_from_s + config_.objective_s;
  return plan;
}

std::optional<double> FeedGovernor::preview(const kernel::signal::Frame& frame, double ratio,
                                            Look look) const noexcept {
  if (!previews()) {
    return std::nullopt;
  }
  Forecast forecast = forecast_;
  fill_pending(frame, forecast);
  Outset from = outset(frame);
  RatioPlan plan;
  if (look == Look::held) {
    const Cell& here = ahead_.cell(from.command_cell);
    const double speed_mm_s =
        std::max({1.0, from.speed_mm_s, std::min(here.cap_mm_s, ratio * here.feed_mm_s)});
    const bool ends = ahead_.complete();  // at the path's end the axes stop, and settle there
    plan = held_plan(ratio, ends ? std::numeric_limits<double>::infinity()
                                 : (ahead_.known_to_mm() - from.position_mm) / speed_mm_s);
    from.panel_ratio = std::numeric_limits<double>::infinity();
  } else {
    plan.start = state_.in_force_ratio;
    plan.target = ratio;
    plan.floor = candidate_.front();
    plan.hold_s = state_.hold_s;
  }
  const Forecast::Result found =
      forecast.run(ahead_, from, plan, reserve_.limit_mm(), false, nullptr, nullptr);
  return found.judged ? std::optional(found.error_mm) : std::nullopt;
}

}  // namespace steadyrest::contour::online
