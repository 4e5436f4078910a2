// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/chatter/online/modulator_range.hpp>

// In each cycle: the present limits, the swing that fits between them, the law's goal, what the
// drive can reach of it, then the two words. The feed word comes first, because the feed per tooth
// must stay in its band whichever of the two acts later: words take a scan and a dead time to act,
// and `coming_feed` and `coming_spindle` remember those on the way.
namespace steadyrest::chatter::online {
namespace {

using kernel::outcome::Reason;
using kernel::override::kRatioTolerance;
using kernel::signal::Frame;
using kernel::signal::InForce;
using kernel::signal::Motion;

/// The margin of the actual speed before the feed rises again: noise must not move steps.
constexpr double kRoomToRise = 0.998;
/// An actual speed below this share of the programmed one means that it is not shown or the spindle
/// is stopped.
constexpr double kStandstill_ratio = 1e-3;
/// Words sent to the control count for at least this many delays, at most twice as many.
constexpr double kDelaysKept = 1.5;

bool all_finite(std::initializer_list<double> values) noexcept {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// Largest and smallest value of the shape.
struct Extent {
  double high;
  double low;
};

Extent extent_of(Law law) noexcept {
  // A pulse of share s is +1 for s and −s/(1 − s) for the rest, mean 0: s = ¼ gives −⅓. A stop is
  // the pulse of share 0.1 upside down.
  switch (law) {
    case Law::constant:
      return {.high = 0.0, .low = 0.0};
    case Law::pulse:
      return {.high = 1.0, .low = -1.0 / 3.0};
    case Law::stop:
      return {.high = 1.0 / 9.0, .low = -1.0};
    case Law::square:
    case Law::triangle:
    case Law::sine:
    case Law::random:
      break;
  }
  return {.high = 1.0, .low = -1.0};
}

/// The actual speed as a ratio of the programmed one; the override's ratio where none is shown.
double speed_ratio(const Frame& frame) noexcept {
  const double programmed = std::abs(frame.spindle_programmed_rev_s);
  const double ratio = programmed > 0.0 ? std::abs(frame.spindle_actual_rev_s) / programmed : 0.0;
  return ratio > kStandstill_ratio ? ratio : frame.spindle.effective_ratio;
}

}  // namespace

bool Modulator::change(const Modulation& modulation) noexcept {
  if (!fit(modulation)) {
    return false;
  }
  const Modulation& now = state_.modulation;
  // The phase stays: restarting the law would jump.
  if (modulation.law != now.law || modulation.seed != now.seed) {
    law_ = SpeedLaw(modulation.law, modulation.seed);
  }
  state_.modulation = modulation;
  return true;
}

void Modulator::reset() noexcept {
  const Modulation modulation = state_.modulation;
  state_ = {};
  state_.modulation = modulation;
}

void Modulator::restore(const State& state) noexcept {
  // A restored state comes from outside: a value out of range would move the spindle on the first
  // cycle.
  const bool is_fit = fit(state.modulation) && std::isfinite(state.time_s) && state.phase >= 0.0 &&
                      state.phase < 1.0 && state.fade >= 0.0 && state.fade <= 1.0 &&
                      std::isfinite(state.fades_from) && std::isfinite(state.ratio) &&
                      state.coming_feed.fit() && state.coming_spindle.fit() &&
                      state.step < spindle_.steps() && (!feed_ || state.feed_step < feed_->steps());
  if (!is_fit) {
    reset();
    return;
  }
  state_ = state;
  law_ = SpeedLaw(state.modulation.law, state.modulation.seed);
}

Reason Modulator::fault_of(const Frame& frame) const noexcept {
  if (!all_finite({frame.time_s, frame.age_s, frame.spindle_programmed_rev_s,
                   frame.spindle_actual_rev_s, frame.programmed_feed_mm_s, frame.path_speed_mm_s,
                   frame.feed.panel_ratio, frame.feed.effective_ratio, frame.spindle.panel_ratio,
                   frame.spindle.effective_ratio})) {
    return Reason::input_not_finite;
  }
  if ((state_.started && frame.time_s < state_.time_s) || frame.programmed_feed_mm_s < 0.0 ||
      frame.feed.effective_ratio < 0.0 || frame.spindle.effective_ratio < 0.0) {
    return Reason::input_out_of_range;
  }
  return frame.age_s > config_.max_step_s ? Reason::input_stale : Reason::none;
}

bool Modulator::wanted(const Frame& frame) const noexcept {
  // A better constant speed must be reached before the tool enters, or the entry would chatter.
  const bool to_come = state_.modulation.law == Law::constant &&
                       (frame.motion == Motion::rapid || frame.motion == Motion::dwell ||
                        frame.motion == Motion::idle || frame.motion == Motion::spindle_wait);
  return (frame.motion == Motion::feed || to_come) && (config_.always || frame.speed_modulation);
}

Modulator::Limits Modulator::limits(const Frame& frame) const noexcept {
  const double speed_rev_s = std::abs(frame.spindle_programmed_rev_s);
  // The last term: above it the feed per tooth would fall below its band, since the feed cannot go
  // higher.
  double high = std::min({spindle_.ratio(highest_), config_.max_rev_s / speed_rev_s,
                          feed_top_ratio_ / config_.min_feed_per_tooth_ratio});
  if (!spindle_.layer_may_exceed_panel()) {
    high = std::min(high, frame.spindle.panel_ratio);
  }
  high = std::max(high, spindle_.ratio(lowest_));
  const double low = std::max(spindle_.ratio(lowest_), config_.min_rev_s / speed_rev_s);
  // Contradictory limits leave one point, the upper one: the panel and the spindle's maximum come
  // first.
  return {.low = std::min(low, high), .high = high};
}

/// The mean is moved before the amplitude is narrowed: a law clipped at a limit would dwell there,
/// and chatter grows in a dwell.
Modulator::Swing Modulator::swing(const Limits& limits, double speed_rev_s) const noexcept {
  const Modulation& m = state_.modulation;
  const Extent extent = extent_of(m.law);
  const double span = extent.high - extent.low;
  // The amplitude scales with the mean speed, since RVA is a ratio of the mean.
  const double asked =
      m.amplitude_rev_s > 0.0 ? m.amplitude_rev_s / speed_rev_s : m.amplitude_ratio * m.mean_ratio;
  const double amplitude = span > 0.0 ? std::min(asked, (limits.high - limits.low) / span) : 0.0;
  const double lowest = limits.low - amplitude * extent.low;
  const double mean =
      std::clamp(m.mean_ratio, lowest, std::max(lowest, limits.high - amplitude * extent.high));
  const bool narrowed = (span > 0.0 && amplitude < asked - kRatioTolerance) ||
                        std::abs(mean - m.mean_ratio) > kRatioTolerance;
  return {.mean = mean, .amplitude = amplitude, .narrowed = narrowed};
}

double Modulator::goal(const Swing& swing, double phase) const noexcept {
  const double from = state_.fades_from;
  return from + state_.fade * (swing.mean + swing.amplitude * law_.at(phase) - from);
}

/// From now until the feed could respond, including turning points of the law on the way.
double Modulator::lowest_goal_ahead(const Swing& swing) const noexcept {
  const double from = state_.phase;
  // In periods. Between the two ends the law may turn at a corner, or a sine at its minimum.
  const double turn = feed_delay_s_ / state_.modulation.period_s;
  double lowest = std::min(law_.at(from), law_.at(from + turn));
  const auto passes = [&](double phase) { return phase - from - std::floor(phase - from) <= turn; };
  for (std::size_t k = 0; k < law_.corner_count(); ++k) {
    const double corner = law_.corners()[k];
    lowest = passes(corner) ? std::min(lowest, law_.at(corner)) : lowest;
  }
  constexpr double kSineLowest = 0.75;
  if (law_.law() == Law::sine && passes(kSineLowest)) {
    lowest = -1.0;
  }
  const double ratio = swing.mean + swing.amplitude * lowest;
  // While fading in, the swing will be larger by the time the feed responds.
  const double fade = std::min(1.0, state_.fade + feed_delay_s_ / config_.fade_s);
  const double start = state_.fades_from;
  return start + (ratio < start ? fade : state_.fade) * (ratio - start);
}

/// The larger of the override's ratio and the path's actual ratio: one of them lags after a change,
/// and a control may ignore the override (M49).
double Modulator::feed_in_force(const Frame& frame) const noexcept {
  const double programmed = frame.programmed_feed_mm_s;
  const double runs = programmed > 0.0 ? std::abs(frame.path_speed_mm_s) / programmed : 0.0;
  return std::max(frame.feed.effective_ratio, runs);
}

/// Notes the words of the previous cycle, which act a scan and a dead time later.
void Modulator::note_words(const InForce& in_force) noexcept {
  state_.coming_spindle.note(state_.time_s, kDelaysKept * spindle_delay_s_,
                             in_force.spindle.word_ratio);
  if (feed_) {
    state_.coming_feed.note(state_.time_s, kDelaysKept * feed_delay_s_, in_force.feed.word_ratio);
  }
}

void Modulator::choose_step(double ratio, const Limits& limits, double floor) noexcept {
  const std::size_t last = std::clamp(
      spindle_.floor_step(limits.high + kRatioTolerance).value_or(lowest_), lowest_, highest_);
  const double low = std::max(limits.low, floor) - kRatioTolerance;
  const std::size_t first = std::clamp(spindle_.ceil_step(low).value_or(last), lowest_, last);
  const std::size_t nearest = std::clamp(spindle_.nearest_step(ratio).value_or(first), first, last);
  if (!state_.stepped) {
    state_.step = nearest;
    state_.stepped = true;
    return;
  }
  state_.step = std::clamp(state_.step, first, last);
  const double from = spindle_.ratio(state_.step);
  const double to = spindle_.ratio(nearest);
  const double room = config_.hysteresis * std::abs(to - from);
  // Hysteresis: noise around the middle between two steps must not move the word.
  if (std::abs(ratio - to) + room < std::abs(ratio - from)) {
    state_.step = nearest;
  }
}

void Modulator::ask_spindle(const Frame& frame, const Limits& limits, const Swing& swing, bool late,
                            Output& output) noexcept {
  const bool coupled = frame.motion == Motion::feed && !frame.feed_per_revolution;
  // The greatest feed that may act together with this speed: in force, requested now, or on the
  // way.
  const bool fed = output.feed.reason != Reason::none;
  const double asked = fed ? output.feed.ratio : feed_ ? frame.feed.panel_ratio : 0.0;
  const double feed = std::max({feed_in_force(frame), asked, state_.coming_feed.most()});
  const double floor = coupled ? feed / config_.max_feed_per_tooth_ratio : 0.0;
  choose_step(state_.ratio, limits, floor);
  const double chosen = spindle_.ratio(state_.step);
  const double nearest = spindle_.ratio(spindle_.nearest_step(state_.ratio).value_or(0));
  // The reason names the first binding limit; the page shows one.
  output.spindle.ratio = chosen;
  if (state_.fade < 1.0) {
    output.spindle.reason = Reason::chatter_fading;
  } else if (nearest < floor - kRatioTolerance && chosen > nearest) {
    output.spindle.reason = Reason::chatter_feed_late;
  } else if (swing.narrowed) {
    output.spindle.reason = Reason::chatter_swing_narrowed;
  } else if (late && !jumps(state_.modulation.law)) {
    output.spindle.reason = Reason::chatter_drive_limit;
  } else {
    output.spindle.reason = Reason::chatter_modulating;
  }
}

/// `ahead`: the lowest speed ratio from now until the feed could respond.
void Modulator::ask_feed(const Frame& frame, double ahead, Output& output) noexcept {
  const double actual = speed_ratio(frame);
  output.feed_per_tooth_ratio =
      actual > kStandstill_ratio ? frame.feed.effective_ratio / actual : 1.0;
  const bool coupled = frame.motion == Motion::feed && !frame.feed_per_revolution;
  if (!coupled || !feed_) {
    state_.fed = false;
    return;
  }
  const double coming =
      std::min({actual, state_.coming_spindle.least(),
                state_.stepped ? spindle_.ratio(state_.step) : spindle_.max_ratio()});
  const double slowest = std::max(std::min(ahead, coming), spindle_.ratio(lowest_));
  // Feed over speed is chip thickness over the programmed one: the feed may be at most the band's
  // upper end times the slowest speed that could act together with it.
  double cap = std::min(config_.max_feed_per_tooth_ratio * slowest, config_.max_feed_ratio);
  const double panel = frame.feed.panel_ratio;
  const double least = config_.min_feed_per_tooth_ratio * actual;
  // A fast spindle thins the chip until the edge rubs; where the machine file allows it, the feed
  // rises.
  if (feed_->layer_may_exceed_panel() && panel >= 1.0 - kRatioTolerance && panel < least) {
    const auto up = feed_->ceil_step(least - kRatioTolerance);
    if (up && feed_->ratio(*up) <= std::min(cap, feed_top_ratio_) + kRatioTolerance) {
      state_.fed = false;
      output.feed.ratio = feed_->ratio(*up);
      output.feed.reason = Reason::chatter_feed_raised;
      return;
    }
  }
  if (panel <= (state_.fed ? kRoomToRise : 1.0) * cap + kRatioTolerance) {
    state_.fed = false;
    return;
  }
  auto down = feed_->floor_step(cap + kRatioTolerance);
  const double lowest =
      std::max(config_.min_feed_ratio, config_.min_feed_per_tooth_ratio * slowest);
  if (!down || feed_->ratio(*down) < lowest - kRatioTolerance) {
    // The table is too coarse: the swing ends where this feed allows it. Requests already made are
    // still followed.
    cap = std::min(config_.max_feed_per_tooth_ratio * std::max(coming, spindle_.ratio(lowest_)),
                   config_.max_feed_ratio);
    down = feed_->floor_step(cap + kRatioTolerance);
    if (!down || panel <= cap + kRatioTolerance ||
        feed_->ratio(*down) < config_.min_feed_ratio - kRatioTolerance) {
      state_.fed = false;
      return;
    }
  }
  // Rising needs a little room above the step, falling does not: noise in the actual speed must not
  // make it toggle.
  const std::size_t settled =
      std::min(*down, feed_->floor_step(kRoomToRise * cap + kRatioTolerance).value_or(*down));
  state_.feed_step =
      state_.fed && *down > state_.feed_step ? std::max(state_.feed_step, settled) : *down;
  state_.fed = true;
  output.feed.ratio = feed_->ratio(state_.feed_step);
  output.feed.reason = Reason::chatter_feed_follows;
}

Modulator::Output Modulator::withdraw(Reason reason) noexcept {
  // At once, without fading: the envelope's slew returns the override.
  state_.fade = 0.0;
  state_.stepped = false;
  state_.fed = false;
  Output output;
  output.phase = state_.phase;
  output.spindle.reason = reason;
  output.feed.reason = reason;
  return output;
}

/// On its way out the goal shrinks to 100 % from where it is, also where the law had not quite come
/// in from what was held.
void Modulator::begin_to_leave(const Swing& swing) noexcept {
  const double way = swing.mean + swing.amplitude * law_.at(state_.phase) - 1.0;
  if (std::abs(state_.fades_from - 1.0) > kRatioTolerance && std::abs(way) > kRatioTolerance) {
    state_.fade = std::clamp((goal(swing, state_.phase) - 1.0) / way, 0.0, 1.0);
  }
  state_.fades_from = 1.0;
}

Modulator::Output Modulator::update(const Frame& frame, const InForce& in_force) noexcept {
  const Reason fault = fault_of(frame);
  const double passed_s = state_.started ? frame.time_s - state_.time_s : 0.0;
  if (std::isfinite(frame.time_s)) {
    state_.time_s = frame.time_s;
    state_.started = true;
    note_words(in_force);
  }
  if (fault != Reason::none) {
    return withdraw(fault);
  }
  if (kernel::signal::is_locked(frame.motion)) {
    return withdraw(Reason::withdrawn_thread);
  }
  const double speed_rev_s = std::abs(frame.spindle_programmed_rev_s);
  const bool active = wanted(frame) && speed_rev_s > 0.0;
  // A late frame must not make the law jump.
  const double dt_s = std::min(passed_s, config_.max_step_s);
  const double turn = dt_s / config_.fade_s;
  if (!active && speed_rev_s > 0.0) {
    begin_to_leave(swing(limits(frame), speed_rev_s));
  }
  if (!active && (speed_rev_s == 0.0 || state_.fade <= turn)) {
    return withdraw(frame.motion == Motion::feed ? Reason::none : Reason::not_cutting);
  }
  // While the law fades out the phase holds, and the goal shrinks to 100 % from where it was.
  state_.fade = std::clamp(state_.fade + (active ? turn : -turn), 0.0, 1.0);
  if (active) {
    state_.phase += dt_s / state_.modulation.period_s;
    state_.phase -= std::floor(state_.phase);
  }
  const Limits within = limits(frame);
  if (!state_.stepped) {
    // Not 100 %: after a thread, which holds the override, it would rise before it came back.
    state_.ratio = state_.fades_from = in_force.spindle.ratio;
  }
  const Swing fitted = swing(within, speed_rev_s);
  const double now = std::clamp(goal(fitted, state_.phase), within.low, within.high);
  const double reach = dt_s > 0.0 ? dt_s * config_.acceleration_rev_s2 / speed_rev_s : 0.0;
  const double moved = std::clamp(now, state_.ratio - reach, state_.ratio + reach);
  state_.ratio = std::clamp(moved, within.low, within.high);
  const bool late = std::abs(state_.ratio - now) > kRatioTolerance;

  Output output;
  output.active = active;
  output.phase = state_.phase;
  output.fade = state_.fade;
  output.goal_ratio = now;
  output.ratio = state_.ratio;
  output.mean_ratio = fitted.mean;
  output.amplitude_ratio = fitted.amplitude;
  const double later = std::clamp(lowest_goal_ahead(fitted), within.low, within.high);
  const double ahead = std::min({now, later, state_.ratio});
  const double step_ahead = spindle_.ratio(spindle_.nearest_step(ahead).value_or(0));
  // The feed first: its present request bounds the spindle's.
  ask_feed(frame, std::min(ahead, std::max(step_ahead, spindle_.ratio(lowest_))), output);
  ask_spindle(frame, within, fitted, late, output);
  return output;
}

}  // namespace steadyrest::chatter::online
