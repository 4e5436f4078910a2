// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// The governor's cycle: first what is in force and what the frame shows (is_fit, contour error,
// servo model, what the model leaves unexplained), then the path ahead, then, once per decision
// period, which step (feed_governor_decide.cpp). The estimates run in every mode and motion, so
// that a decision never starts without them.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::outcome::Reason;
using kernel::signal::Frame;
using kernel::signal::Motion;
using kernel::signal::Point;

// Effect on the rib pocket of halving and doubling them: README, "What the constants do".
constexpr double kDrift = 0.003;      // of k and a together, beyond which the forecast adopts it
constexpr double kOtherModel = 0.02;  // … and what was unexplained before no longer counts

bool is_fit(const Frame& frame) noexcept {
  bool fit = std::isfinite(frame.time_s) && std::isfinite(frame.age_s) &&
             std::isfinite(frame.path_speed_mm_s) && std::isfinite(frame.programmed_feed_mm_s) &&
             std::isfinite(frame.path_position_mm) && std::isfinite(frame.feed.effective_ratio) &&
             std::isfinite(frame.feed.panel_ratio) && std::isfinite(frame.rapid.effective_ratio);
  for (std::size_t i = 0; i < 3; ++i) {
    fit = fit && std::isfinite(frame.axis[i].command_mm) && std::isfinite(frame.axis[i].actual_mm);
  }
  return fit;
}

}  // namespace

void FeedGovernor::reset() noexcept {
  contour_.reset();
  original_.reset();
  servo_.pause();
  curve_.reset();
  ahead_.reset();
  precompensator_.reset();
  reserve_.forget();
  state_ = {};
  history_.fill(1.0);
}

FeedGovernor::State FeedGovernor::state() const {
  State state;
  static_cast<Course&>(state) = state_;
  state.contour = contour_.state();
  state.original = original_.state();
  state.servo = servo_.state();
  state.curve = curve_.state();
  state.ahead = ahead_.state();
  state.precompensator = precompensator_.state();
  state.reserve = reserve_.state();
  state.model = model_;
  state.cycle_s = cycle_s_;
  state.history = history_;
  state.history_at = history_at_;
  return state;
}

void FeedGovernor::restore(const State& state) noexcept {
  state_ = static_cast<const Course&>(state);
  contour_.restore(state.contour);
  original_.restore(state.original);
  servo_.restore(state.servo);
  curve_.restore(state.curve);
  ahead_.restore(state.ahead);
  reserve_.restore(state.reserve);
  model_ = state.model;
  cycle_s_ = state.cycle_s;
  for (std::size_t i = 0; i < model_.size(); ++i) {
    cycle_step_[i] = AxisStep::of(model_[i], cycle_s_);
  }
  forecast_.set_model(model_);
  precompensator_.set_model(model_);
  precompensator_.restore(state.precompensator);
  forecast_.set_tool_point(precompensator_.point(), precompensator_.max_offset_mm());
  forecast_.set_offset_acceleration(precompensator_.acceleration_mm_s2());
  history_ = state.history;
  history_at_ = state.history_at % kHistory;
}

// The model's exact steps cost 64 Runge–Kutta steps per axis, so they are renewed only when the
// model has moved by 0.3 % or the cycle by 1 %.
void FeedGovernor::refresh_model(double dt) noexcept {
  bool renew = cycle_s_ == 0.0 || std::abs(dt - cycle_s_) > 0.01 * cycle_s_;
  bool is_other = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const AxisModel& now = servo_.axis(i);
    const double drift = std::abs(now.gain_1_s / model_[i].gain_1_s - 1.0) +
                         std::abs(now.feed_forward - model_[i].feed_forward);
    renew = renew || drift > kDrift;
    is_other = is_other || drift > kOtherModel;
  }
  if (!renew) {
    return;
  }
  cycle_s_ = dt > 0.0 ? dt : config_.cycle_s;
  for (std::size_t i = 0; i < 3; ++i) {
    model_[i] = servo_.axis(i);
    cycle_step_[i] = AxisStep::of(model_[i], cycle_s_);
  }
  forecast_.set_model(model_);
  precompensator_.set_model(model_);
  forecast_.set_tool_point(precompensator_.point(), precompensator_.max_offset_mm());
  forecast_.set_offset_acceleration(precompensator_.acceleration_mm_s2());
  if (is_other) {
    reserve_.forget();
  }
}

// The model runs in parallel with the axes on the same commands: e − modelled is what it does not
// explain (friction, a wrong τ). Returns that of each axis; nothing where the cycle is irregular.
std::optional<Point> FeedGovernor::run_model(const Frame& frame, double dt) noexcept {
  const bool is_regular = dt > 0.0 && std::abs(dt - cycle_s_) < 0.01 * cycle_s_;
  Point residual{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = frame.axis[i].command_mm;
    const double e = c - frame.axis[i].actual_mm;
    double& modelled = state_.modelled.error_mm[i];
    double& velocity = state_.modelled.velocity_mm_s[i];
    if (!is_regular) {
      modelled = e;
      velocity = state_.velocity_mm_s[i] = 0.0;
      state_.command_mm_s[i] = 0.0;
    } else {
      const double mean = (c - state_.command_mm[i]) / dt;
      const double change = mean - state_.command_mm_s[i];
      const AxisStep& step = cycle_step_[i];
      const double before = modelled;
      modelled =
          step.ee * before + step.ew * velocity + step.e_mean * mean + step.e_change * change;
      velocity =
          step.we * before + step.ww * velocity + step.w_mean * mean + step.w_change * change;
      const AxisModel& model = model_[i];
      if (model.velocity_lag_s > 0.0) {
        const double share = 1.0 - std::exp(-dt / model.velocity_lag_s);
        state_.velocity_mm_s[i] +=
            share * (model.gain_1_s * e + model.feed_forward * mean - state_.velocity_mm_s[i]);
      }
      state_.command_mm_s[i] = mean;
    }
    state_.command_mm[i] = c;
    residual[i] = e - modelled;
  }
  return is_regular ? std::optional(residual) : std::nullopt;
}

/// The servo model and the play of the backlash, held against what the frame shows.
void FeedGovernor::observe(const Frame& frame, const ContourError::Output& error,
                           double dt) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const double motor = frame.axis[i].actual_mm;
    const double table = state_.observed ? state_.table_mm[i] : motor;
    state_.table_mm[i] =
        std::clamp(table, motor - half_backlash_mm_[i], motor + half_backlash_mm_[i]);
  }
  state_.observed = true;
  const auto residual = run_model(frame, dt);
  if (!residual || !error.valid || frame.motion != Motion::feed ||
      geometry::norm_squared(error.tangent) == 0.0 ||
      (error.from_path && frame.path[error.foot_index].by_text)) {
    return;
  }
  // Of the cross-path parts the errors' lengths are compared: an axis that rests a count beside its
  // command, square to a large error, takes nothing off the limit.
  const Point seen = geometry::subtract(state_.table_mm, error.foot_mm);
  const Point modelled = geometry::add_scaled(seen, *residual, 1.0);
  reserve_.update({.seen_mm = geometry::norm(tangential_error_mm(seen, error.tangent)),
                   .modelled_mm = geometry::norm(tangential_error_mm(modelled, error.tangent)),
                   .step_s = dt,
                   .cancelled = state_.offsets_act && precompensator_.enabled()});
}

// The words as the control was told them, one per cycle: for dead time and scan they are still
// under way.
void FeedGovernor::remember(const kernel::signal::InForce& in_force) noexcept {
  state_.offsets_act = in_force.active;
  state_.in_force_ratio = in_force.feed.ratio;
  history_[history_at_] = in_force.feed.word_ratio;
  history_at_ = (history_at_ + 1) % kHistory;
}

/// The ratios already under way: at each time the largest of those that may act then.
void FeedGovernor::fill_pending(const Frame& frame, Forecast& into) const noexcept {
  const Forecast::Timing& timing = into.timing();
  const Shadow& shadow = state_.shadow;
  auto& pending = into.pending();
  std::size_t n = 0;
  for (; n < Forecast::kMaxSteps; ++n) {
    const double t = timing.step_s * static_cast<double>(n + 1);
    // What acts at t was told between dead + scan − t and dead − t before now. The largest of
    // those: the faster one is worse for the contour.
    const double oldest = timing.dead_s + timing.scan_s - t;
    if (oldest <= 0.0) {
      break;
    }
    const double newest = std::max(0.0, timing.dead_s - t);
    const auto last = std::min(kHistory - 1, static_cast<std::size_t>(oldest / cycle_s_) + 1);
    const auto first = std::min(last, static_cast<std::size_t>(newest / cycle_s_));
    double most = 0.0;
    for (std::size_t back = first; back <= last; ++back) {
      most = std::max(most, shadow.on ? shadow.told(back)
                                      : history_[(history_at_ + kHistory - 1 - back) % kHistory]);
    }
    pending[n] =
        n == 0 ? std::max(most, shadow.on ? acting_ratio() : frame.feed.effective_ratio) : most;
  }
  into.set_pending_count(n);
}

FeedGovernor::Output FeedGovernor::withdraw(Reason reason, Output output) noexcept {
  output.request.ratio = 1.0;
  output.request.reason = reason;
  output.predicted_error_mm = 0.0;
  output.predicted_at_mm = 0.0;
  output.decided = false;
  output.forecasts = output.forecast_steps = 0;
  state_.engaged = false;
  state_.next_decision_s = course_s();  // the first decision comes at once
  state_.next_objective_s = course_s();
  state_.objective = {};
  return output;
}

/// The frame must not be acted on. A layer that acts goes back by the slew, and so does its shadow.
FeedGovernor::Output FeedGovernor::pause(Reason reason, const Frame& frame, double dt) noexcept {
  servo_.pause();
  precompensator_.reset();
  state_.last = withdraw(reason, {});
  if (state_.shadow.on) {
    tell_shadow(frame, is_step(dt) ? dt : 0.0);
    state_.last.advised_ratio = state_.shadow.ratio;
  }
  return state_.last;
}

/// The error that is shown: against the path that the part should have. No figure is better than
/// one against a path that the text has shifted on purpose.
void FeedGovernor::measure(const Frame& frame, const ContourError::Output& own,
                           Output& output) noexcept {
  const ContourError::Output error =
      frame.original.empty() ? own : original_.update(original_input(frame));
  output.error_valid = error.valid && error.in_cut && !frame.original_unknown;
  output.error_mm = output.error_valid ? error.error_mm : 0.0;
}

/// For how long the speed has not followed the override.
void FeedGovernor::watch_effect(const Frame& frame, double dt) noexcept {
  const double wished = frame.feed.effective_ratio * frame.programmed_feed_mm_s;
  const bool follows = frame.path_speed_mm_s > 0.95 * wished ||
                       std::abs(frame.path_speed_mm_s - state_.speed_mm_s) > 0.01 * wished;
  state_.idle_effect_s =
      frame.motion == Motion::feed && !follows ? state_.idle_effect_s + std::max(0.0, dt) : 0.0;
  state_.speed_mm_s = frame.path_speed_mm_s;
}

/// What is asked for, by a decision or because none may be made.
void FeedGovernor::request(const Frame& frame, bool by_text, Output& output) noexcept {
  if (kernel::signal::is_locked(frame.motion)) {
    output = withdraw(Reason::withdrawn_thread, output);
  } else if (frame.motion != Motion::feed &&
             (frame.motion == Motion::idle || !cutting_within_reach(frame))) {
    output = withdraw(Reason::not_cutting, output);
  } else if (by_text) {
    output = withdraw(
        frame.original_unknown ? Reason::contour_original_unknown : Reason::contour_in_text,
        output);
  } else if (!state_.engaged || course_s() >= state_.next_decision_s - 1e-9) {
    state_.engaged = true;
    decide(frame, output);
    state_.next_decision_s =
        std::max(state_.next_decision_s, course_s() - decision_s_) + decision_s_;
  }
}

FeedGovernor::Output FeedGovernor::update(const Frame& frame,
                                          const kernel::signal::InForce& in_force,
                                          Reason unfit) noexcept {
  if (!config_.contour.enabled) {
    return {};
  }
  remember(in_force);
  if (!is_fit(frame)) {
    state_.started = false;
    return pause(Reason::input_not_finite, frame, cycle_s_);
  }
  const double dt = state_.started ? frame.time_s - state_.time_s : 0.0;
  state_.started = true;
  state_.time_s = frame.time_s;
  if (!(dt >= 0.0 && dt < 1.0)) {
    // The clock jumped: whatever it timed is void.
    state_.next_decision_s = state_.next_objective_s = course_s();
    state_.fallen_s = course_s() - config_.pause_s;
    state_.idle_effect_s = 0.0;
  }
  if (unfit == Reason::none && frame.age_s > config_.envelope.stale_after_s) {
    unfit = Reason::input_stale;
  }
  if (unfit != Reason::none) {
    return pause(unfit, frame, dt);
  }

  Output output = state_.last;
  output.decided = false;
  output.forecasts = output.forecast_steps = 0;
  const ContourError::Output error = contour_.update(frame);
  measure(frame, error, output);
  output.nominal_error_mm = nominal_error_mm(frame);
  if (kernel::signal::is_locked(frame.motion)) {
    servo_.pause();
  } else {
    servo_.update(frame);
  }
  refresh_model(is_step(dt) ? dt : cycle_s_);
  observe(frame, error, dt);
  output.path_known = state_.last.path_known = look(frame, error);
  const bool by_text = frame.original_unknown || is_by_text(frame);
  cancel(frame, dt, by_text, output);
  watch_effect(frame, dt);
  follow_shadow(frame, in_force, dt);
  output.pace = state_.shadow.on && dt > 0.0 ? state_.shadow.step_s / dt : 1.0;
  request(frame, by_text, output);
  output.advised_ratio = state_.shadow.on ? state_.shadow.ratio : output.request.ratio;
  return state_.last = output;
}

}  // namespace steadyrest::contour::online
