// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

// The frame of the estimator: checks, start and restart, handling of edges and ticks, and the clamp
// to the proved bounds. The effect of an edge on the hypotheses is in motion_estimator_observe.cpp,
// that of a tick in motion_estimator_mix.cpp.
namespace steadyrest::motion::online {
namespace {

using kernel::outcome::refuse;

// These constants were chosen once, on the scenes of bench/motion and the recorded logs together,
// with counts of any length; none depends on the motion.
constexpr Lanes kJerkDensity{7.05e6, 1.38e8, 6.4e10, 2.63e14};  ///< count²/s⁵
constexpr Lanes kDecay{0.0, 6.06, 0.0, 1908.0};                 ///< 1/s
constexpr double kDensityOfJerk =
    0.0087;                              ///< S/J² in s of the roughest model that a limit J leaves
constexpr double kDensityOfShock = 0.1;  ///< … of the last one, kept in case the limit is violated
constexpr double kLineSigma = 8.6e-3;    ///< counts, at the start
constexpr double kRestAtStart = 0.8;
constexpr double kGapCycles = 50.0;  ///< a longer gap in the record restarts the filter

bool in_range(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

kernel::outcome::Result<MotionEstimator> MotionEstimator::make(const Config& config) {
  if (!in_range(config.count_mm, 1e-9, 1e3)) {
    return refuse("the length of a count is outside 1e-9 … 1000 mm",
                  "give the length of one count after ×4 decoding in mm");
  }
  if (std::isnan(config.line_error_mm) || config.line_error_mm > config.count_mm) {
    return refuse("the line error is more than one count",
                  "give the bound on one line's position error in mm, below the count");
  }
  if (!in_range(config.lag_s, 0.0,
                static_cast<double>(LagSmoother::kMostTicks) * config.cycle_s * 1.001)) {
    return refuse("the lag is outside 0 … 32 cycles", "give a lag of no more than 32 cycles");
  }
  const auto bound = MotionBound::make({config.cycle_s, config.clock_s, config.max_speed_mm_s,
                                        config.max_acceleration_mm_s2, config.max_jerk_mm_s3});
  if (!bound) {
    return std::unexpected(bound.error());
  }
  return MotionEstimator(config, *bound);
}

MotionEstimator::MotionEstimator(const Config& config, const MotionBound& bound) noexcept
    : config_(config),
      tuning_(tuning(std::isfinite(config.max_jerk_mm_s3))),
      clock_(config.clock_s),
      bound_(bound),
      smoother_(static_cast<std::size_t>(std::lround(config.lag_s / config.cycle_s))),
      line_variance_(kLineSigma * kLineSigma) {
  const double jerk = config.max_jerk_mm_s3 / config.count_mm;
  for (std::size_t j = 0; j < kModels; ++j) {
    const double most = (j + 1 == kModels ? kDensityOfShock : kDensityOfJerk) * jerk * jerk;
    // A model rougher than the jerk limit would follow impossible motion; the last one stays wider
    // in case the limit is violated.
    const bool limited = kJerkDensity[j] > most;
    jerk_density_[j] = limited ? most : kJerkDensity[j];
    decay_1_s_[j] = limited ? std::min(kDecay[j], tuning_.decay_1_s) : kDecay[j];
    // x = J·t³/6 from rest to the next line: v = ∛(J/2)·∛9, a = ∛(6J²) after a whole cell.
    const double start_jerk = std::sqrt(jerk_density_[j] / tuning_.jerk_of_start);
    start_speed_[j] = std::cbrt(4.5 * start_jerk);
    start_acceleration_[j] = std::cbrt(6.0 * start_jerk * start_jerk);
  }
  ramp_ = JerkRamp({jerk, config.max_acceleration_mm_s2 / config.count_mm,
                    config.max_speed_mm_s / config.count_mm, clock_});
  if (config_.line_error_mm >= 0.0) {
    // A bound taken as 3σ.
    const double sigma = config_.line_error_mm / config_.count_mm / 3.0;
    line_variance_ = std::clamp(sigma * sigma, kLeastVariance, kMostVariance);
  }
}

/// Chosen by search: without limits on the recorded logs and the scenes together, with a limit of
/// the jerk on S-curves of random speed, jerk and phase and the scenes
/// (steadyrest/motion/README.md).
MotionEstimator::Tuning MotionEstimator::tuning(bool jerk_known) noexcept {
  Tuning t;
  t.start_speed = jerk_known ? 0.914 : 0.161;
  t.start_speed_spread = jerk_known ? 0.164 : 0.142;
  t.start_acceleration = jerk_known ? 1.21 : 0.75;
  t.start_acceleration_spread = jerk_known ? 0.01 : 0.19;
  t.start_at_edge = jerk_known ? 0.0448 : 5.4e-3;
  t.edge_at_rest = jerk_known ? 1e-6 : 7.2e-4;
  t.jerk_of_start = jerk_known ? 1.25e-3 : 0.0102;
  t.decay_1_s = jerk_known ? 0.0 : 10.0;
  t.switch_1_s = jerk_known ? 2.89 : 1.37;
  t.stop_1_s = jerk_known ? 32.2 : 19.0;
  t.start_1_s = jerk_known ? 0.0146 : 0.01;
  return t;
}

double MotionEstimator::line_sigma_mm() const noexcept {
  return std::sqrt(line_variance_) * config_.count_mm;
}

void MotionEstimator::start(double t_s, double x, double variance) noexcept {
  // Nothing is known: a hundred counts per cycle, and one more in the next.
  const double v = 100.0 / config_.cycle_s;
  const double a = 1.0 / (config_.cycle_s * config_.cycle_s);
  for (std::size_t j = 0; j < kModels; ++j) {
    bank_.set(j, {{x, 0.0, 0.0}, {variance, 0.0, 0.0, v * v, 0.0, a * a}});
  }
  bank_.t_s = t_s;
  weight_ = all((1.0 - kRestAtStart) / kModels);
  weight_rest_ = kRestAtStart;
  rest_ = {x, variance};
  least_share_ = all(1.0);
  edge_s_ = t_s;
  feed_back_s_ = 0.0;
  started_ = true;
}

void MotionEstimator::edge(const Edge& edge) noexcept {
  // An edge earlier than the last input would run the filters backwards.
  if (!std::isfinite(edge.t_s) || !std::isfinite(edge.position_mm) ||
      (started_ && edge.t_s < last_s_)) {
    ++rejected_;
    return;
  }
  restart_after_gap(edge.t_s);
  if (!started_) {
    origin_mm_ = edge.position_mm;
    start(edge.t_s, 0.0, 0.01);
  }
  sampled_ = false;
  last_s_ = edge.t_s;
  // The bound gets the edge before the filters group it: a proof uses every passage.
  bound_.edge(edge.t_s, edge.position_mm,
              config_.line_error_mm >= 0.0 ? config_.line_error_mm : 4.0 * line_sigma_mm());
  const double x = (edge.position_mm - origin_mm_) / config_.count_mm;
  Observation seen;
  // At a turn the group is closed first: the axis was never at an average over both directions.
  if (group_.turns(edge.direction) && group_.take(seen)) {
    observe(seen);
  }
  if (group_.add(edge.t_s, x, edge.direction, seen)) {
    const double sigma = static_cast<double>(edge.sigma_mm) / config_.count_mm;
    seen.variance = sigma >= 0.0 ? sigma * sigma : -1.0;
    observe(seen);
  }
}

/// A gap in the record: nothing before it is usable.
void MotionEstimator::restart_after_gap(double t_s) noexcept {
  if (started_ && t_s - last_s_ > kGapCycles * config_.cycle_s) {
    Observation dropped;
    group_.take(dropped);
    bound_.forget();
    ramp_.forget();
    smoother_.forget();
    started_ = false;
    sampled_ = true;
  }
}

/// No time stamps: a single step of the count tells that its line was passed since the last tick, a
/// larger one only where the axis is now.
void MotionEstimator::sampled(const Tick& tick) noexcept {
  const std::int64_t steps = tick.count - last_count_;
  if (steps == 0) {
    return;
  }
  const double low = (tick.low_mm - origin_mm_) / config_.count_mm;
  const double high = (tick.high_mm - origin_mm_) / config_.count_mm;
  const double line = steps > 0 ? low : high;
  // One step: the line was passed somewhere within the cycle, so its middle is the time and the
  // clock period is the whole cycle. More steps: the times of the lines are lost; the axis is
  // evenly distributed over its present cell (variance 1/12).
  const bool single = steps == 1 || steps == -1;
  const double clock = clock_;
  const double variance = line_variance_;
  clock_ = single ? tick.t_s - last_s_ : 0.0;
  line_variance_ = single ? 1e-4 : 1.0 / 12.0;
  observe({single ? 0.5 * (tick.t_s + last_s_) : tick.t_s, single ? line : 0.5 * (low + high), 0.0,
           1, static_cast<std::int8_t>(steps > 0 ? 1 : -1)});
  clock_ = clock;
  line_variance_ = variance;
}

Estimate MotionEstimator::tick(const Tick& tick) noexcept {
  if (!std::isfinite(tick.t_s) || !std::isfinite(tick.low_mm) || !(tick.high_mm > tick.low_mm) ||
      (started_ && tick.t_s < last_s_)) {
    ++rejected_;
    Estimate out;
    out.t_s = tick.t_s;
    return out;
  }
  restart_after_gap(tick.t_s);
  if (!started_) {
    origin_mm_ = tick.low_mm;
    start(tick.t_s, 0.5, 1.0 / 12.0);
    last_count_ = tick.count;
  }
  Observation seen;
  if (group_.take(seen)) {
    observe(seen);
  }
  // The group is emptied at each tick: the estimate includes every edge before it.
  group_.end_of_cycle();
  if (sampled_) {
    sampled(tick);
  }
  const Mixed mixed = look(tick);
  const MotionIntervals sure = bound_.tick(tick.t_s, tick.low_mm, tick.high_mm);
  if (smoother_.active()) {
    smoother_.looked(
        {tick.t_s, bank_, weight_, weight_rest_, rest_.x, sure, tick.low_mm, tick.high_mm});
  }
  // After the look: the output is the estimate before the exchange; the exchange prepares the next
  // cycle.
  mix();
  last_s_ = tick.t_s;
  last_count_ = tick.count;
  return smoother_.active() ? late(tick.t_s, sure) : finish(tick, tick.t_s, mixed, sure);
}

/// The estimate for some ticks ago. It stays within the bounds proved then and within those that
/// the present proof implies for then.
Estimate MotionEstimator::late(double now_s, const MotionIntervals& now) noexcept {
  const LagSmoother::Look& then = smoother_.then();
  const LagSmoother::State state = smoother_.smooth(jerk_density_, config_.cycle_s);
  MotionIntervals sure = then.sure;
  const double d = now_s - then.t_s;
  const double jerk = config_.max_jerk_mm_s3;
  // Backwards from now, by the same law as MotionBound's advance: a(then) is within J·d of a(now),
  // v(then) = v(now) − a·d ± J·d²/2. If rounding or a violated limit leaves no overlap, only the
  // older proof holds.
  if (d > 0.0 && std::isfinite(jerk)) {
    sure.acceleration.low = std::max(sure.acceleration.low, now.acceleration.low - jerk * d);
    sure.acceleration.high = std::min(sure.acceleration.high, now.acceleration.high + jerk * d);
    const double bend = 0.5 * jerk * d * d;
    sure.velocity.low =
        std::max(sure.velocity.low, now.velocity.low - d * now.acceleration.high - bend);
    sure.velocity.high =
        std::min(sure.velocity.high, now.velocity.high - d * now.acceleration.low + bend);
    if (sure.velocity.empty() || sure.acceleration.empty()) {
      sure = then.sure;
    }
  }
  return finish({then.t_s, 0, then.low_mm, then.high_mm}, now_s, {state.x, state.v, state.a}, sure);
}

/// Keeps the estimate within the proved interval; its bound is the distance to the farther end.
Estimate MotionEstimator::finish(const Tick& tick, double now_s, const Mixed& mixed,
                                 const MotionIntervals& sure) const noexcept {
  Estimate out;
  out.t_s = tick.t_s;
  out.position_mm = std::clamp(origin_mm_ + mixed.x * config_.count_mm, tick.low_mm, tick.high_mm);
  out.position_bound_mm = std::max(out.position_mm - tick.low_mm, tick.high_mm - out.position_mm);
  // The ramp's share is a probability: the estimate is the mean over both hypotheses.
  const JerkRamp::Motion ramp = ramp_.at(now_s, tick.t_s);
  const double v = mixed.v + ramp.share * (ramp.v - mixed.v);
  const double a = mixed.a + ramp.share * (ramp.a - mixed.a);
  out.velocity_mm_s = std::clamp(v * config_.count_mm, sure.velocity.low, sure.velocity.high);
  out.acceleration_mm_s2 =
      std::clamp(a * config_.count_mm, sure.acceleration.low, sure.acceleration.high);
  // Without either limit no motion is ruled out, and no bound can be given.
  if (std::isfinite(config_.max_jerk_mm_s3) || std::isfinite(config_.max_acceleration_mm_s2)) {
    out.velocity_bound_mm_s =
        std::max(sure.velocity.high - out.velocity_mm_s, out.velocity_mm_s - sure.velocity.low);
    out.acceleration_bound_mm_s2 = std::max(sure.acceleration.high - out.acceleration_mm_s2,
                                            out.acceleration_mm_s2 - sure.acceleration.low);
  }
  return out;
}

}  // namespace steadyrest::motion::online
