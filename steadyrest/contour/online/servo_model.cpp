// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <steadyrest/contour/online/servo_model.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// Law: τ·ẍ + ẋ = k·e + a·ċ. Multiplied by φ(t) = 4t(T − t)/T², which vanishes at both ends of a
// window, and integrated by parts, all derivatives move from the signals to φ: ∫φẋ = −∫φ′x, ∫φẍ =
// ∫φ″x − [φ′x]. One window gives one row y = k·E + a·V, without any differentiated encoder
// (modulating functions, Shinbrot 1957). The rows go into recursive least squares in information
// form.
namespace steadyrest::contour::online {
namespace {

using kernel::signal::Frame;

// k₀/3 … 3·k₀. A file further off needs correcting: test NeverLeavesItsBounds….
constexpr double kGainSpan = 3.0;
// Travel that makes a window worth a row: 0.3 counts of 1 µm are 1.5 % of it, about
// row_noise_ratio's figure for the law. Test NeedsFiftiethsOfAMillimetre….
constexpr double kMinTravelMm = 0.02;
// A missing sample, 2 periods, ends the window; up to 1.9 it is merely late. Test AMissingSample….
constexpr double kMaxGapRatio = 1.9;
// Of the drive's limit; the rest is for friction and cutting force, which the command does not
// show. Test LearnsBelowFourFifths….
constexpr double kSaturationShare = 0.8;

std::unexpected<kernel::outcome::Refusal> refuse_axis(std::string what) {
  return kernel::outcome::refuse(std::move(what), "correct the axis in the machine file");
}

bool is_finite(const Frame& frame, std::size_t axes) noexcept {
  bool fit = std::isfinite(frame.time_s);
  for (std::size_t i = 0; i < axes; ++i) {
    fit = fit && std::isfinite(frame.axis[i].command_mm) && std::isfinite(frame.axis[i].actual_mm);
  }
  return fit;
}

}  // namespace

kernel::outcome::Result<ServoModel> ServoModel::make(const Config& config) {
  if (config.axes < 1 || config.axes > kernel::signal::kMaxAxes) {
    return refuse_axis("the servo model has " + std::to_string(config.axes) +
                       " axes; allowed: 1 … 8");
  }
  for (std::size_t i = 0; i < config.axes; ++i) {
    const AxisModel& p = config.prior[i];
    if (!(p.gain_1_s >= 1.0 && p.gain_1_s <= 1000.0)) {
      return refuse_axis("the servo gain is " + std::to_string(p.gain_1_s) +
                         " 1/s; allowed: 1 … 1000");
    }
    if (!(p.feed_forward >= 0.0 && p.feed_forward <= 1.0)) {
      return refuse_axis("the feed-forward is " + std::to_string(p.feed_forward) +
                         "; allowed: 0 … 1");
    }
    if (!(p.velocity_lag_s >= 0.0 && p.velocity_lag_s <= 0.1)) {
      return refuse_axis("the velocity lag is " + std::to_string(p.velocity_lag_s) +
                         " s; allowed: 0 … 0.1");
    }
  }
  if (!(config.window_s >= 0.01 && config.window_s <= 0.5 && config.memory_s > config.window_s &&
        config.prior_gain_ratio > 0.0 && config.prior_feed_forward > 0.0 &&
        config.row_noise_ratio > 0.0)) {
    return refuse_axis(
        "a time or spread of the servo model is out of range; allowed: window 0.01 … 0.5 s, "
        "memory longer than the window, spreads above 0");
  }
  return ServoModel(config);
}

kernel::outcome::Result<ServoModel> ServoModel::make(std::span<const kernel::machine::Axis> axes,
                                                     double interpolator_period_s) {
  Config config;
  config.axes = std::min<std::size_t>(3, axes.size());
  for (std::size_t i = 0; i < config.axes; ++i) {
    const kernel::machine::Axis& axis = axes[i];
    config.prior[i] = {axis.servo_gain_1_s, axis.feed_forward, axis.velocity_lag_s};
    config.count_mm[i] = axis.encoder.count_au;
    config.drive_mm_s2[i] =
        std::isfinite(axis.drive_acceleration_au_s2) ? axis.drive_acceleration_au_s2 : 0.0;
  }
  config.window_s = std::max(config.window_s, 10.0 * interpolator_period_s);
  return make(config);
}

ServoModel::ServoModel(const Config& config) noexcept : config_(config) {
  for (std::size_t i = 0; i < config_.axes; ++i) {
    state_.axis[i].model = config_.prior[i];
  }
}

// Positions count from the window's start: large values cancel before they are summed.
void ServoModel::open_window(const Frame& frame) noexcept {
  state_.elapsed_s = 0.0;
  state_.samples = 0;
  for (std::size_t i = 0; i < config_.axes; ++i) {
    AxisState& axis = state_.axis[i];
    axis.c0 = axis.last_c = frame.axis[i].command_mm;
    axis.x0 = axis.last_x = frame.axis[i].actual_mm;
    axis.sum_x = axis.sum_tx = axis.sum_c = axis.sum_tc = axis.sum_te = axis.sum_tte = 0.0;
    axis.first_step_mm = axis.last_step_mm = 0.0;
    axis.reversed = false;
  }
}

bool ServoModel::update(const Frame& frame) noexcept {
  if (!is_finite(frame, config_.axes)) {
    state_.started = false;
    return false;
  }
  const double dt = frame.time_s - state_.time_s;
  // The integrals would take a gap for a straight line. The next step is judged by this one, since
  // the clock may have slowed down for good.
  const bool gap = state_.first_dt_s > 0.0 && dt > kMaxGapRatio * state_.first_dt_s;
  state_.time_s = frame.time_s;
  if (!state_.started || !(dt > 0.0) || gap) {
    state_.first_dt_s = state_.started && gap ? dt : state_.first_dt_s;
    state_.started = true;
    open_window(frame);
    return false;
  }
  if (state_.samples == 0) {
    state_.first_dt_s = dt;
  }
  const double t0 = state_.elapsed_s;
  const double t1 = t0 + dt;
  for (std::size_t i = 0; i < config_.axes; ++i) {
    AxisState& axis = state_.axis[i];
    const double c = frame.axis[i].command_mm;
    const double x = frame.axis[i].actual_mm;
    const double step = c - axis.last_c;
    axis.reversed = axis.reversed || step * axis.last_step_mm < 0.0;
    if (state_.samples == 0) {
      axis.first_step_mm = step;
    }
    // Simpson's rule on each interval, the mid value being the mean of both ends.
    const double h = 0.5 * dt;
    const double xa = axis.last_x - axis.x0;
    const double xb = x - axis.x0;
    const double ca = axis.last_c - axis.c0;
    const double cb = c - axis.c0;
    const double ea = axis.last_c - axis.last_x;
    const double eb = c - x;
    const double tm = 0.5 * (t0 + t1);
    const auto moment = [&](double a, double b) {
      return h / 3.0 * (t0 * a + 2.0 * tm * (a + b) + t1 * b);
    };
    axis.sum_x += h * (xa + xb);
    axis.sum_tx += moment(xa, xb);
    axis.sum_c += h * (ca + cb);
    axis.sum_tc += moment(ca, cb);
    axis.sum_te += moment(ea, eb);
    axis.sum_tte += h / 3.0 * (t0 * t0 * ea + 2.0 * tm * tm * (ea + eb) + t1 * t1 * eb);
    axis.last_c = c;
    axis.last_x = x;
    axis.last_step_mm = step;
  }
  ++state_.samples;
  state_.elapsed_s = t1;
  if (t1 < config_.window_s * (1.0 - 1e-9)) {
    return false;
  }
  const bool renewed = close_window();
  open_window(frame);
  return renewed;
}

bool ServoModel::close_window() noexcept {
  bool renewed = false;
  for (std::size_t i = 0; i < config_.axes; ++i) {
    renewed = learn(i) || renewed;
  }
  return renewed;
}

// These teach nothing: standstill, a reversal (friction, backlash), travel of a few counts, a drive
// near its limit (the law is linear, a saturated drive is not).
bool ServoModel::learn(std::size_t i) noexcept {
  AxisState& axis = state_.axis[i];
  const AxisModel& prior = config_.prior[i];
  const double window = state_.elapsed_s;
  const double travel = std::abs(axis.last_c - axis.c0);
  const double actual_travel = std::abs(axis.last_x - axis.x0);
  const double count = config_.count_mm[i];
  if (axis.reversed || std::min(travel, actual_travel) < std::max(kMinTravelMm, 10.0 * count)) {
    return false;
  }
  const double acceleration =
      std::abs(axis.last_step_mm - axis.first_step_mm) / state_.first_dt_s / window;
  if (config_.drive_mm_s2[i] > 0.0 && acceleration > kSaturationShare * config_.drive_mm_s2[i]) {
    return false;
  }

  const double f = 4.0 / (window * window);
  const double x_end = axis.last_x - axis.x0;
  // φ′ = f(T − 2t), φ″ = −2f, [φ′x] = −f·T·x(T) since x(0) = 0.
  const double speed_x = -f * (window * axis.sum_x - 2.0 * axis.sum_tx);
  const double acceleration_x = -2.0 * f * axis.sum_x + f * window * x_end;
  const double speed_c = -f * (window * axis.sum_c - 2.0 * axis.sum_tc);
  const double error = f * (window * axis.sum_te - axis.sum_tte);

  const double y = speed_x + prior.velocity_lag_s * acceleration_x;
  const double residual = y - axis.model.gain_1_s * error - axis.model.feed_forward * speed_c;
  // Huber's weight: a row more than twice as far off as recent rows counts by its size, not by its
  // square.
  const double size = std::abs(residual) / std::max(std::abs(y), 1e-9);
  const double expected = std::max(axis.residual_ratio, config_.row_noise_ratio);
  const double huber = std::min(1.0, 2.0 * expected / std::max(size, 1e-12));
  axis.residual_ratio += 0.1 * (std::min(size, 1.0) - axis.residual_ratio);

  const double sigma = config_.row_noise_ratio * std::abs(y) + 0.3 * count + 1e-9;
  const double weight = huber / (sigma * sigma);
  // Forgets towards the prior: the machine file's information replaces what fades, so that a
  // direction the motion does not excite (at constant speed, k against a) does not drift.
  const double keep = std::exp(-window / config_.memory_s);
  const double p1 = 1.0 / (config_.prior_gain_ratio * prior.gain_1_s);
  const double p2 = 1.0 / config_.prior_feed_forward;
  const double renew = axis.rows == 0 ? 1.0 : 1.0 - keep;
  axis.l11 = keep * axis.l11 + renew * p1 * p1 + weight * error * error;
  axis.l12 = keep * axis.l12 + weight * error * speed_c;
  axis.l22 = keep * axis.l22 + renew * p2 * p2 + weight * speed_c * speed_c;
  axis.r1 = keep * axis.r1 + renew * p1 * p1 * prior.gain_1_s + weight * error * y;
  axis.r2 = keep * axis.r2 + renew * p2 * p2 * prior.feed_forward + weight * speed_c * y;
  ++axis.rows;
  solve(i);
  return true;
}

/// Minimum of the quadratic form within the bounds: free, else on the edge that it violates. The
/// form is convex: where the free minimum lies outside the box, the bounded one lies on an edge,
/// and along an edge it takes one division. One pass over both edges suffices here, since
/// feed-forward is clamped again on the gain's edge.
void ServoModel::solve(std::size_t i) noexcept {
  AxisState& axis = state_.axis[i];
  const double low = config_.prior[i].gain_1_s / kGainSpan;
  const double high = config_.prior[i].gain_1_s * kGainSpan;
  const double determinant = axis.l11 * axis.l22 - axis.l12 * axis.l12;
  if (!(determinant > 0.0)) {
    return;
  }
  double gain = (axis.r1 * axis.l22 - axis.r2 * axis.l12) / determinant;
  double share = (axis.r2 * axis.l11 - axis.r1 * axis.l12) / determinant;
  if (share < 0.0 || share > 1.0) {
    share = std::clamp(share, 0.0, 1.0);
    gain = (axis.r1 - axis.l12 * share) / axis.l11;
  }
  if (gain < low || gain > high) {
    gain = std::clamp(gain, low, high);
    share = std::clamp((axis.r2 - axis.l12 * gain) / axis.l22, 0.0, 1.0);
  }
  if (std::isfinite(gain) && std::isfinite(share)) {
    axis.model.gain_1_s = gain;
    axis.model.feed_forward = share;
  }
}

}  // namespace steadyrest::contour::online
