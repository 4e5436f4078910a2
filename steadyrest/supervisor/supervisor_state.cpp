// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

// What is on the machine: taken back, resumed after a restart, or given up.
namespace steadyrest::supervisor {

using kernel::override::Channel;
using kernel::units::kNan;

/// Nothing of the layer is on the machine, and the state of its words is unknown. Every start on
/// the machine goes through here: mode act begins so, and so does the layer after a gap longer than
/// the watchdog's. Words must settle again before a mask goes on.
void Supervisor::begin_at_panel() noexcept {
  for (auto* channel : {&feed_, &spindle_}) {
    if (*channel) {
      (*channel)->reset();
    }
  }
  offset_.reset();
  path_offset_.reset();
  handed_back_ = true;
}

// No stamp moves any slew while the source stalls, so the layer cannot go to neutral by itself: it
// falls silent, and the machine's watchdog hands back.
void Supervisor::watch_source(double stamp_s) noexcept {
  state_.stalled_s = stamp_s == state_.stamp_s ? state_.stalled_s + cycle_s_ : 0.0;
  state_.stamp_s = stamp_s;
  state_.interrupted = state_.interrupted || source_stalled();
}

/// Every frame shows the operator's setting, even where nothing is written.
void Supervisor::see_panel(const kernel::signal::Frame& frame) noexcept {
  if (feed_) {
    feed_->see_panel(frame.feed);
  }
  if (spindle_) {
    spindle_->see_panel(frame.spindle);
  }
}

/// The stamps tell that the machine still holds everything, and agree with the silent cycles: a
/// clock that stopped, or gave the last delivery a wrong stamp, would make any silence look short.
bool Supervisor::stamps_say_short(const FrameClock::Tick& tick) const noexcept {
  constexpr double kSlackCycles = 1.0 + FrameClock::kSlackSteps;
  const double gap_s = tick.time_s - state_.delivered_s;
  return !state_.clock_set && gap_s <= watchdog_s_ &&
         gap_s >= state_.silent_s - kSlackCycles * cycle_s_;
}

/// By the silent cycles; a restored process adds, by the stamps, how long it was away.
bool Supervisor::is_dropped(const FrameClock::Tick& tick) const noexcept {
  if (std::isnan(state_.silence_began_s)) {
    return state_.silent_s > watchdog_s_;
  }
  return !stamps_say_short(tick) &&
         (state_.clock_set || tick.time_s - state_.silence_began_s > watchdog_s_);
}

// An interruption ends with the first good stamp. Up to the watchdog's time the machine still holds
// what was written, and the layer continues from there; beyond it, it begins at the panel. How long
// it was is told by the silent cycles. Where the stamps do not agree (a clock that was set, stood
// or jumped), the machine may hold everything still, or not: the layer stays silent until the
// watchdog has dropped it for certain.
void Supervisor::resume(const FrameClock::Tick& tick) noexcept {
  // A confirmed jump means that the last delivery's stamp was right, doubt or not: the gap counts
  // from there, else a long cycle would pass for an interruption.
  if (tick.jumped) {  // a stamp that was in doubt was right
    state_.delivered_s = state_.delivered_stamped_s;
  }
  state_.clock_set = state_.interrupted && (state_.clock_set || tick.set);
  if (!state_.interrupted || !tick.good || source_stalled()) {
    return;
  }
  const bool dropped = is_dropped(tick);
  if (!dropped && !stamps_say_short(tick)) {
    return;
  }
  state_.interrupted = false;
  state_.silence_began_s = kNan;
  if (dropped) {
    begin_at_panel();
  }
}

/// Read from envelopes and words, so that whatever was taken back or given up is excluded.
kernel::signal::InForce Supervisor::in_force() const noexcept {
  using kernel::machine::Mode;
  return {.feed = feed_ ? feed_->in_force() : kernel::signal::RatioInForce{},
          .spindle = spindle_ ? spindle_->in_force() : kernel::signal::RatioInForce{},
          .offset_mm = offset_.state().offset_mm,
          .path_offset_mm = path_offset_.state().offset_mm,
          .active = state_.mode_in_force != Mode::observe && !state_.interrupted,
          .written = state_.mode_in_force == Mode::act && !state_.interrupted};
}

Supervisor::Written Supervisor::written() const noexcept {
  return {.feed = feed_ ? feed_->state() : Channel::State{},
          .spindle = spindle_ ? spindle_->state() : Channel::State{},
          .offset = offset_.state(),
          .path_offset = path_offset_.state(),
          .delivered_s = state_.delivered_s,
          .delivered_stamped_s = state_.delivered_stamped_s,
          .silent_s = state_.silent_s};
}

// Excludes the channels: when taken back they keep what the undelivered cycle saw of the panel (the
// operator did turn it), when restored they do not. The offsets are what the machine has, beyond a
// limit that a new machine file has lowered too: they return from there by the slew.
void Supervisor::put_back(const Written& written) noexcept {
  offset_.restore(written.offset);
  path_offset_.restore(written.path_offset);
  state_.delivered_s = written.delivered_s;
  state_.delivered_stamped_s = written.delivered_stamped_s;
  state_.silent_s = written.silent_s;
  handed_back_ = false;
}

// The port refused the command, so the machine still has the previous one. Interrupted, since the
// watchdog now runs there.
void Supervisor::not_delivered() noexcept {
  if (feed_) {
    feed_->take_back(before_.feed);
  }
  if (spindle_) {
    spindle_->take_back(before_.spindle);
  }
  put_back(before_);
  state_.interrupted = true;
}

void Supervisor::was_dropped() noexcept {
  state_.interrupted = true;
  state_.silent_s = std::numeric_limits<double>::infinity();
}

Supervisor::State Supervisor::state() const noexcept {
  State state = state_;
  const Written now = written();
  state.feed = now.feed;
  state.spindle = now.spindle;
  state.offset = now.offset;
  state.path_offset = now.path_offset;
  state.clock = clock_.state();
  if (thermal_) {
    state.thermal = thermal_->state();
  }
  return state;
}

// A restored process does not know how long it was away: it stays interrupted until a good stamp
// tells. The rooms' estimates need an unbroken record and start over; the machine's heat outlives
// the process, so the thermal room carries on.
void Supervisor::restore(const State& state) noexcept {
  state_ = state;
  state_.interrupted = true;
  state_.clock_set = false;
  state_.stamp_s = kNan;
  state_.stalled_s = 0.0;
  // A state comes from a file: a NaN here would keep the tool in the cut, or the layer silent, for
  // good.
  state_.idle_s = std::isfinite(state.idle_s) ? std::max(0.0, state.idle_s) : 0.0;
  state_.between_s = std::isfinite(state.between_s) ? std::max(0.0, state.between_s) : 0.0;
  state_.silent_s =
      state.silent_s >= 0.0 ? state.silent_s : std::numeric_limits<double>::infinity();
  clock_.restore(state.clock);
  if (feed_) {
    feed_->restore(state.feed);
  }
  if (spindle_) {
    spindle_->restore(state.spindle);
  }
  put_back({.feed = state.feed,
            .spindle = state.spindle,
            .offset = state.offset,
            .path_offset = state.path_offset,
            .delivered_s = state.delivered_s,
            .delivered_stamped_s = state.delivered_stamped_s,
            .silent_s = state_.silent_s});
  state_.silence_began_s = clock_.time_s() - state_.silent_s;
  // Offsets that cannot have been in force: what the machine has is unknown until its watchdog has
  // dropped it for certain.
  const bool heat_known = offset_.restore(state.offset);
  const bool path_known = path_offset_.restore(state.path_offset);
  if (!heat_known || !path_known) {
    state_.silence_began_s = clock_.time_s();
    state_.silent_s = std::numeric_limits<double>::infinity();
  }
  motion_.reset();
  if (contour_) {
    contour_->reset();
    estimates_.contour.reset();
  }
  if (chatter_) {
    chatter_->reset();
    estimates_.chatter.reset();
  }
  if (listener_) {
    listener_->reset();
    estimates_.heard.reset();
  }
  if (thermal_) {
    thermal_->restore(state.thermal);
    estimates_.thermal.reset();
  }
}

// Unlike after a restart nothing was interrupted: the next cycle is the one after the last. The
// channels have the same tables, so their words mean the same.
void Supervisor::take_over(Supervisor& before, const Kept& kept) noexcept {
  state_ = before.state_;
  clock_ = before.clock_;
  before_ = before.before_;
  handed_back_ = before.handed_back_;
  last_frame_ = before.last_frame_;
  if (feed_ && before.feed_) {
    feed_->restore(before.feed_->state());
  }
  if (spindle_ && before.spindle_) {
    spindle_->restore(before.spindle_->state());
  }
  offset_.restore(before.offset_.state());
  path_offset_.restore(before.path_offset_.state());
  if (kept.motion) {
    std::swap(motion_, before.motion_);
  }
  if (kept.contour) {
    std::swap(contour_, before.contour_);
  }
  if (kept.chatter) {
    std::swap(chatter_, before.chatter_);
  } else if (kept.modulation && chatter_ && before.chatter_) {
    // In range, since it was in force.
    [[maybe_unused]] const bool taken = chatter_->change(before.chatter_->state().modulation);
  }
  // What was heard, and the speed that helped against it, outlive other settings of the room: the
  // speed before would chatter again.
  if (listener_ && before.listener_) {
    listener_->take_over(*before.listener_);
    if (listener_->acts() && !kept.chatter && chatter_ && before.chatter_) {
      chatter_->restore(before.chatter_->state());
    }
  } else if (!listener_ && kept.chatter) {
    std::swap(listener_, before.listener_);
  }
  if (kept.thermal) {
    std::swap(thermal_, before.thermal_);
  } else if (thermal_ && before.thermal_) {
    thermal_->restore(before.thermal_->state());
  }
}

}  // namespace steadyrest::supervisor
