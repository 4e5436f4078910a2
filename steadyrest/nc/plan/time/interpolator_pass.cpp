// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/plan/time/interpolator.hpp>

namespace steadyrest::nc::plan {
namespace {

/// Fewer are not worth the look ahead.
constexpr double kFewestAlike = 16.0;

}  // namespace

/// Periods for which the event in hand goes on holding the motion.
std::size_t Interpolator::alike_at_event() const noexcept {
  if (!event_active_ || event_ >= window_.event_end) {
    return 0;
  }
  const PathEvent& event = window_.events[event_ & window_.event_mask];
  const double seconds = event.kind == PathEventKind::dwell         ? event.value
                         : event.kind == PathEventKind::tool_change ? tool_change_s_
                                                                    : 0.0;
  // One less than there are, against rounding.
  const double periods = std::floor((seconds - event_time_s_) / period_s_) - 2.0;
  return periods >= kFewestAlike ? static_cast<std::size_t>(periods) : 0;
}

/// Periods for which the lead keeps its speed, which has passed through the whole average.
std::size_t Interpolator::alike_in_motion() const noexcept {
  const double v = lead_.speed_mm_s;
  const bool constant = v > 0.0 && since_rise_ >= taps_ && since_fall_ >= taps_ &&
                        index_ == lead_.segment && lag_head_ == lag_tail_;
  const SegmentPlan& p = window_.plan(lead_.segment);
  if (!constant || target_mm_s(p, overrides_) != v) {
    return 0;
  }
  double periods = std::floor((p.length_mm - lead_.distance_mm) / (v * period_s_)) - 1.0;
  for (; periods >= kFewestAlike; periods = std::floor(0.5 * periods)) {
    // Limits ahead bind more the nearer they are: where the last period keeps the speed all do.
    Lead last = lead_;
    last.distance_mm += periods * v * period_s_;
    if (look_ahead_.bound(window_, last, v, 0.0).speed_mm_s >= v) {
      return static_cast<std::size_t>(periods);
    }
  }
  return 0;
}

std::size_t Interpolator::pass_alike() noexcept {
  if (phase_ == Phase::standstill) {
    const std::size_t periods = alike_at_event();
    event_time_s_ += static_cast<double>(periods) * period_s_;
    return periods;
  }
  const std::size_t periods = phase_ == Phase::run ? alike_in_motion() : 0;
  if (periods == 0) {
    return 0;
  }
  const double way_mm = static_cast<double>(periods) * lead_.speed_mm_s * period_s_;
  lead_.distance_mm += way_mm;
  since_rise_ += periods;
  since_fall_ += periods;
  for (double& position_mm : position_ring_) {
    position_mm += way_mm;
  }
  position_sum_ += static_cast<double>(taps_) * way_mm;
  path_position_mm_ += way_mm;
  distance_mm_ += way_mm;
  return periods;
}

}  // namespace steadyrest::nc::plan
