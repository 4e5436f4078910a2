// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/supervisor/frame_check.hpp>

// Ordered by severity: a frame that is not finite may not be compared with anything, so that comes
// first; age comes last, since only a frame that makes sense can be merely old.
namespace steadyrest::supervisor {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Frame;

bool all_finite(std::initializer_list<double> values) noexcept {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

FrameCheck::FrameCheck(std::span<const kernel::machine::Axis> axes, double stale_after_s) noexcept
    : stale_after_s_(stale_after_s) {
  // A linear axis may read up to its own travel beyond its limits: machine files are often wrong by
  // an offset, while garbage from a broken link is off by powers of ten. Rotary axes turn without
  // limit.
  range_.fill({.min = -kernel::machine::kUnlimited, .max = kernel::machine::kUnlimited});
  for (std::size_t i = 0; i < std::min(axes.size(), range_.size()); ++i) {
    const auto& axis = axes[i];
    if (!axis.rotary) {
      const double travel_mm = axis.max_au - axis.min_au;
      range_[i] = {.min = axis.min_au - travel_mm, .max = axis.max_au + travel_mm};
    }
  }
}

bool FrameCheck::finite(const Frame& frame) const noexcept {
  const auto sample_finite = [](const auto& axis) {
    // Only what the rooms compute with. Each channel judges its own panel, the motion stage the
    // edges, the thermal room probes and temperatures: a fault there costs only that input.
    return all_finite({axis.command_mm, axis.actual_mm, axis.following_error_mm});
  };
  const auto axes = std::min<std::size_t>(frame.axis_count, frame.axis.size());
  return all_finite({frame.time_s, frame.age_s, frame.programmed_feed_mm_s, frame.path_speed_mm_s,
                     frame.spindle_programmed_rev_s, frame.spindle_command_rev_s,
                     frame.spindle_actual_rev_s, frame.path_position_mm}) &&
         std::ranges::all_of(frame.axis.begin(), frame.axis.begin() + axes, sample_finite);
}

bool FrameCheck::in_range(const Frame& frame) const noexcept {
  // Slightly negative ages come from rounding; a frame from further in the future has a wrong
  // clock.
  if (frame.axis_count > frame.axis.size() || frame.programmed_feed_mm_s < 0.0 ||
      frame.age_s < -stale_after_s_) {
    return false;
  }
  for (std::size_t i = 0; i < frame.axis_count; ++i) {
    for (const double position : {frame.axis[i].command_mm, frame.axis[i].actual_mm}) {
      if (position < range_[i].min || position > range_[i].max) {
        return false;
      }
    }
  }
  return true;
}

Reason FrameCheck::fault(const Frame& frame, Reason of_time) const noexcept {
  if (!finite(frame)) {
    return Reason::input_not_finite;
  }
  if (!in_range(frame)) {
    return Reason::input_out_of_range;
  }
  if (of_time != Reason::none) {
    return of_time;
  }
  return frame.age_s > stale_after_s_ ? Reason::input_stale : Reason::none;
}

}  // namespace steadyrest::supervisor
