// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/plan/path/axes_at.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>

namespace steadyrest::nc::plan {

using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Motion;

namespace {

// One update takes in the overrides (take). At standstill it works off the events that are due; in
// motion it advances the lead by one period (run), then the average behind it (average) and finds
// its place on the path (locate). The lead may be segments ahead of the setpoint; the limits in
// between bind through lag_.

constexpr double kSpindleTolerance_ratio = 0.05;  ///< "at speed": within 5 % of the command
constexpr std::size_t kLagCapacity = 1024;

double ratio_or_hold(double ratio, double most) noexcept {
  return std::isfinite(ratio) ? std::clamp(ratio, 0.0, most) : 0.0;
}

}  // namespace

Result<Interpolator> Interpolator::make(const Machine& machine, const PathWindow& path) {
  const double period = machine.control.interpolator_period_s;
  if (!(period > 0.0) || !std::isfinite(period)) {
    return refuse(
        machine.file,
        "control.interpolator_period must be above 0, it is " + std::to_string(period) + " s",
        "give the control's cycle time");
  }
  if (machine.control.look_ahead_blocks == 0) {
    return refuse(machine.file, "control.look_ahead_blocks must be at least 1", "give 1 or more");
  }
  // Rounded up: a longer averaging time only lowers the jerk. The 1e-9 keeps rounding of a whole
  // quotient from costing a period.
  const PathLimits limits(machine.axes, machine.control);
  const double taps = std::max(1.0, std::ceil(limits.jerk_time_s() / period - 1e-9));
  if (!(taps <= 10000.0)) {
    return refuse(machine.file,
                  "the jerk limits ask for an averaging time of " + std::to_string(taps) +
                      " periods; the most is 10000",
                  "raise max_jerk or lower max_acceleration");
  }
  return Interpolator(machine, path, static_cast<std::size_t>(taps),
                      std::min<std::size_t>(machine.control.look_ahead_blocks, 1U << 16U));
}

Interpolator::Interpolator(const Machine& machine, const PathWindow& path, std::size_t taps,
                           std::size_t look_ahead)
    : window_(path),
      period_s_(machine.control.interpolator_period_s),
      jerk_time_s_(taps > 1 ? static_cast<double>(taps) * period_s_ : 0.0),
      tool_change_s_(machine.control.tool_change_s),
      max_spindle_rev_s_(machine.spindle.max_rev_s),
      max_feed_ratio_(machine.feed_override.max_ratio),
      max_rapid_ratio_(machine.rapid_override.max_ratio),
      look_ahead_(look_ahead, period_s_, jerk_time_s_),
      since_rise_(taps),
      since_fall_(taps),
      taps_(taps),
      position_ring_(taps),
      speed_ring_(taps),
      lag_(taps > 1 ? kLagCapacity : 1) {
  if (window_.end > 0) {
    position_ = axes_at(window_.segment(0), 0.0).position;
  }
}

bool Interpolator::stops_after(std::size_t i) const noexcept {
  return window_.plan(i).exit_speed_limit_mm_s <= 0.0 || i + 1 >= window_.end;
}

void Interpolator::take(const Overrides& overrides) noexcept {
  const double feed = ratio_or_hold(overrides.feed_ratio, max_feed_ratio_);
  const double rapid = ratio_or_hold(overrides.rapid_ratio, max_rapid_ratio_);
  const double spindle =
      std::isfinite(overrides.spindle_actual_rev_s) ? overrides.spindle_actual_rev_s : 0.0;
  const bool changed = feed != overrides_.feed_ratio || rapid != overrides_.rapid_ratio;
  overrides_ = {feed, rapid, spindle, overrides.spindle_ratio};
  // An override raises or lowers the targets ahead: exit speeds planned for the old ones may be out
  // of reach.
  if (phase_ == Phase::run && (changed || look_ahead_.outdated(spindle))) {
    look_ahead_.plan_all(window_, lead_.segment, overrides_);
  }
}

void Interpolator::extend(std::size_t end, std::size_t event_end, bool complete) noexcept {
  if (window_.end == 0 && end > 0) {
    position_ = axes_at(window_.segment(0), 0.0).position;
  }
  window_.end = end;
  window_.event_end = event_end;
  window_.complete = complete;
}

bool Interpolator::wants_more() const noexcept {
  return !window_.complete && lead_.segment + look_ahead_.blocks() >= window_.end;
}

double Interpolator::lag_cap_mm_s() const noexcept {
  return lag_head_ == lag_tail_ ? std::numeric_limits<double>::infinity()
                                : lag_[lag_head_ % kLagCapacity].cap_mm_s;
}

/// Keeps the limits that the lead has passed and the setpoint has not: ascending indices, rising
/// caps.
void Interpolator::push_lag(std::size_t index) noexcept {
  const SegmentPlan& p = window_.plan(index);
  const double cap = std::min(p.exit_speed_limit_mm_s, target_mm_s(p, overrides_));
  // A later, lower cap makes earlier, higher ones meaningless: the queue stays rising and its head
  // is the minimum.
  while (lag_tail_ != lag_head_ && lag_[(lag_tail_ - 1) % kLagCapacity].cap_mm_s >= cap) {
    --lag_tail_;
  }
  if (lag_tail_ - lag_head_ ==
      kLagCapacity) {  // full: the last entry covers both, on the safe side
    lag_[(lag_tail_ - 1) % kLagCapacity].index = index;
    return;
  }
  lag_[lag_tail_ % kLagCapacity] = {index, cap};
  ++lag_tail_;
}

double Interpolator::next_speed() noexcept {
  const double v = lead_.speed_mm_s;
  const SegmentPlan& p = window_.plan(lead_.segment);
  const double step = p.acceleration_mm_s2 * period_s_;
  double want = std::min(target_mm_s(p, overrides_), lag_cap_mm_s());
  // Only acceleration counts here; where the path ends sooner, `hard` below brakes harder.
  want = std::clamp(want, v - step, v + step);
  if (taps_ > 1) {
    // N periods of constant speed separate rising from falling, or the average sees 2A in one
    // window.
    if ((want > v && since_fall_ < taps_) || (want < v && since_rise_ < taps_)) {
      want = v;
    }
    if (want > v) {
      want =
          std::max(v, look_ahead_.bound(window_, lead_, want, jerk_time_s_ + period_s_).speed_mm_s);
    }
  }
  const LookAhead::Bound hard = look_ahead_.bound(window_, lead_, want, 0.0);
  // Never brakes harder than the segments allow, even if an override drops too late for the planned
  // exit speed.
  const double next = std::max({hard.speed_mm_s, v - hard.braking_mm_s2 * period_s_, 0.0});
  since_rise_ = next > v ? 0 : since_rise_ + 1;
  since_fall_ = next < v ? 0 : since_fall_ + 1;
  return next;
}

void Interpolator::run() noexcept {
  const double next = next_speed();
  // Trapezoid: the acceleration is constant within a period.
  double move = 0.5 * (lead_.speed_mm_s + next) * period_s_;
  lead_.speed_mm_s = next;
  for (;;) {
    const double left = window_.plan(lead_.segment).length_mm - lead_.distance_mm;
    if (move < left - kEndTolerance_mm) {
      lead_.distance_mm += move;
      return;
    }
    if (stops_after(lead_.segment)) {
      lead_.distance_mm = window_.plan(lead_.segment).length_mm;
      lead_.speed_mm_s = 0.0;
      since_fall_ = 0;
      phase_ = Phase::flush;
      flush_ = taps_ - 1;
      return;
    }
    if (taps_ > 1) {
      push_lag(lead_.segment);
    }
    move = std::max(0.0, move - left);
    ++lead_.segment;
    lead_.distance_mm = 0.0;
    look_ahead_.plan_more(window_, lead_.segment, overrides_);
  }
}

/// The moving average. The sums are recomputed once per turn of the ring, so that rounding does not
/// build up.
void Interpolator::average() noexcept {
  const double s = window_.segment(lead_.segment).position_mm + lead_.distance_mm;
  if (taps_ == 1) {
    path_position_mm_ = s;
    speed_mm_s_ = lead_.speed_mm_s;
    return;
  }
  position_sum_ += s - position_ring_[ring_at_];
  speed_sum_ += lead_.speed_mm_s - speed_ring_[ring_at_];
  position_ring_[ring_at_] = s;
  speed_ring_[ring_at_] = lead_.speed_mm_s;
  if (++ring_at_ == taps_) {
    ring_at_ = 0;
    position_sum_ = 0.0;
    speed_sum_ = 0.0;
    for (std::size_t i = 0; i < taps_; ++i) {
      position_sum_ += position_ring_[i];
      speed_sum_ += speed_ring_[i];
    }
  }
  const auto n = static_cast<double>(taps_);
  // Rounding of the running sum must not move the setpoint back or past the lead.
  path_position_mm_ = std::clamp(position_sum_ / n, path_position_mm_, s);
  speed_mm_s_ = std::max(0.0, speed_sum_ / n);
}

void Interpolator::locate() noexcept {
  if (taps_ == 1) {
    index_ = lead_.segment;
    distance_mm_ = lead_.distance_mm;
    return;
  }
  while (index_ < lead_.segment && path_position_mm_ >= window_.segment(index_ + 1).position_mm) {
    ++index_;
  }
  while (lag_head_ != lag_tail_ && lag_[lag_head_ % kLagCapacity].index < index_) {
    ++lag_head_;
  }
  distance_mm_ = path_position_mm_ - window_.segment(index_).position_mm;
}

/// The averaged position has reached the lead's stop.
void Interpolator::settle() noexcept {
  index_ = lead_.segment;
  distance_mm_ = window_.plan(lead_.segment).length_mm;
  path_position_mm_ = window_.segment(lead_.segment).position_mm + distance_mm_;
  speed_mm_s_ = 0.0;
  lag_head_ = lag_tail_;
  // As if the machine had been at rest here for N periods: the next start is not averaged with the
  // last stop.
  std::fill(position_ring_.begin(), position_ring_.end(), path_position_mm_);
  std::fill(speed_ring_.begin(), speed_ring_.end(), 0.0);
  position_sum_ = path_position_mm_ * static_cast<double>(taps_);
  speed_sum_ = 0.0;
  since_rise_ = taps_;
  since_fall_ = taps_;
  phase_ = Phase::standstill;
}

/// Advances one event; true when it is over.
bool Interpolator::event_passed(const PathEvent& event) noexcept {
  const auto timed = [this](double seconds) {
    // To the nearest period.
    if (event_time_s_ >= seconds - 0.5 * period_s_) {
      return true;
    }
    event_time_s_ += period_s_;
    return false;
  };
  switch (event.kind) {
    case PathEventKind::dwell:
      return timed(event.value);
    case PathEventKind::tool_change:
      return timed(tool_change_s_);
    case PathEventKind::spindle:
      spindle_rev_s_ = event.value;
      return true;
    case PathEventKind::spindle_wait: {
      const double ratio = std::isfinite(overrides_.spindle_ratio) ? overrides_.spindle_ratio : 1.0;
      // Limited to what the drive reaches: an override above the spindle's largest speed would wait
      // forever.
      const double wanted = std::copysign(
          std::min(std::abs(spindle_rev_s_) * ratio, max_spindle_rev_s_), spindle_rev_s_);
      return spindle_rev_s_ == 0.0 || std::abs(overrides_.spindle_actual_rev_s - wanted) <=
                                          kSpindleTolerance_ratio * std::abs(wanted);
    }
    case PathEventKind::coolant:
      coolant_ = event.value != 0.0;
      return true;
    case PathEventKind::end:
      coolant_ = false;
      return true;
    case PathEventKind::stop:
      break;
  }
  return true;
}

/// At standstill before segment `lead_.segment`: true while an event holds the motion.
bool Interpolator::at_event() noexcept {
  while (event_ < window_.event_end) {
    const PathEvent& event = window_.events[event_ & window_.event_mask];
    if (event.segment > lead_.segment) {
      break;
    }
    event_active_ = true;
    line_ = event.line;
    if (!event_passed(event)) {
      return true;
    }
    event_time_s_ = 0.0;
    ++event_;
  }
  event_active_ = false;
  return false;
}

Setpoint Interpolator::update(const Overrides& overrides, bool placed) noexcept {
  take(overrides);
  starved_ = false;
  if (phase_ == Phase::standstill) {
    const bool arrived =
        lead_.segment < window_.end && lead_.distance_mm >= window_.plan(lead_.segment).length_mm;
    const bool goes_on =
        lead_.segment + 1 < window_.end || window_.complete || event_ < window_.event_end;
    if (arrived && !goes_on) {
      starved_ = true;
      return setpoint(true);
    }
    if (arrived) {
      ++lead_.segment;
      lead_.distance_mm = 0.0;
    }
    if (!at_event()) {
      if (lead_.segment < window_.end) {
        index_ = lead_.segment;
        look_ahead_.plan_all(window_, lead_.segment, overrides_);
        phase_ = Phase::run;
      } else if (window_.complete) {
        phase_ = Phase::finished;
      } else {
        starved_ = true;
      }
    }
  }
  if (phase_ == Phase::run) {
    run();
    average();
    locate();
  } else if (phase_ == Phase::flush) {
    // The lead has arrived; the average follows over the N − 1 periods left in its window.
    --flush_;
    average();
    locate();
  }
  if (phase_ == Phase::flush && flush_ == 0) {
    settle();
  }
  return setpoint(placed || phase_ != Phase::run);
}

Setpoint Interpolator::setpoint(bool placed) noexcept {
  Setpoint out;
  out.spindle_rev_s = spindle_rev_s_;
  out.coolant = coolant_;
  out.finished = phase_ == Phase::finished;
  out.path_position_mm = path_position_mm_;
  out.path_index = index_;
  if (event_active_ && event_ < window_.event_end) {
    switch (window_.events[event_ & window_.event_mask].kind) {
      case PathEventKind::dwell:
        out.motion = Motion::dwell;
        break;
      case PathEventKind::tool_change:
        out.motion = Motion::tool_change;
        break;
      default:
        out.motion = Motion::spindle_wait;
    }
  } else if (index_ < window_.end && !out.finished) {
    const auto& s = window_.segment(index_);
    if (placed) {
      const PathPoint point = axes_at(s, distance_mm_);
      position_ = point.position;
      for (std::size_t i = 0; i < out.velocity.size(); ++i) {
        out.velocity[i] = point.direction[i] * speed_mm_s_;
      }
    }
    out.motion = s.motion;
    out.speed_modulation = s.speed_modulation;
    out.path_speed_mm_s = speed_mm_s_;
    const SegmentPlan& p = window_.plan(index_);
    if (p.spindle_rev_s != 0.0) {
      spindle_rev_s_ = p.spindle_rev_s;
      out.spindle_rev_s = spindle_rev_s_;
    }
    out.feed_per_revolution = p.per_revolution;
    out.programmed_feed_mm_s =
        p.per_revolution ? p.feed_mm_s * std::abs(overrides_.spindle_actual_rev_s) : p.feed_mm_s;
    line_ = s.line;
  }
  out.line = line_;
  out.position = position_;
  return out;
}

}  // namespace steadyrest::nc::plan
