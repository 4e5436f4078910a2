// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

namespace steadyrest::motion::online {
namespace {

// What follows was chosen once, on the scenes of bench/motion and the recorded logs together,
// counts of any length alike; nothing of it depends on the motion.
constexpr Lanes kJerkDensity{7.05e6, 1.38e8, 6.4e10, 2.63e14};  ///< count²/s⁵
constexpr Lanes kDecay{0.0, 6.06, 0.0, 1908.0};                 ///< 1/s
constexpr double kDensityOfJerk =
    0.0087;  ///< S/J² in s of the roughest model that a limit J leaves
constexpr double kDensityOfShock =
    0.1;                        ///< … of the last one, which is there in case the limit is broken
constexpr double kGate = 5.08;  ///< normalised innovation² beyond which a model is made wider
constexpr double kCap = 3.96;   ///< … and beyond which it loses no more weight
constexpr double kLearn = 0.0043;         ///< share of an innovation in σ_line²
constexpr double kLineSigma = 8.6e-3;     ///< counts, at the start
constexpr double kLeastVariance = 1e-10;  ///< counts²
constexpr double kMostVariance = 0.09;
constexpr double kInverseTwoPi = 0.15915494309189535;
constexpr double kRestAtStart = 0.8;
constexpr double kGapCycles = 50.0;  ///< a longer hole in the record restarts the filter

using kernel::outcome::Kind;
using kernel::outcome::Refusal;

bool in_range(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

kernel::outcome::Result<MotionEstimator> MotionEstimator::make(const Config& config) {
  if (!in_range(config.count_mm, 1e-9, 1e3)) {
    return std::unexpected(Refusal{Kind::bad_input, "", 0,
                                   "the length of a count is outside 1e-9 … 1000 mm",
                                   "give the length of one count after ×4 decoding in mm"});
  }
  if (std::isnan(config.line_error_mm) || config.line_error_mm > config.count_mm) {
    return std::unexpected(
        Refusal{Kind::bad_input, "", 0, "the line error is more than one count",
                "give the bound on one line's position error in mm, below the count"});
  }
  if (!in_range(config.lag_s, 0.0,
                static_cast<double>(LagSmoother::kMostTicks) * config.cycle_s * 1.001)) {
    return std::unexpected(Refusal{Kind::bad_input, "", 0, "the lag is outside 0 … 32 cycles",
                                   "give a lag of no more than 32 cycles"});
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
    // A model rougher than the limit of the jerk would follow what cannot be; the last one stays
    // wider in case the limit is broken.
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
  // Nothing is known: a hundred counts in a cycle, and one more in the next.
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
  // An edge earlier than what came before would run the filters backwards.
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
  bound_.edge(edge.t_s, edge.position_mm,
              config_.line_error_mm >= 0.0 ? config_.line_error_mm : 4.0 * line_sigma_mm());
  const double x = (edge.position_mm - origin_mm_) / config_.count_mm;
  Observation seen;
  // At a turn the group is closed first: an average over both directions is no place the axis was
  // at.
  if (group_.turns(edge.direction) && group_.take(seen)) {
    observe(seen);
  }
  if (group_.add(edge.t_s, x, edge.direction, seen)) {
    const double sigma = static_cast<double>(edge.sigma_mm) / config_.count_mm;
    seen.variance = sigma >= 0.0 ? sigma * sigma : -1.0;
    observe(seen);
  }
}

/// A hole in the record: nothing of before it is of use.
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

void MotionEstimator::observe(const Observation& seen) noexcept {
  if (seen.edges == 1 && !sampled_) {
    ramp_.edge(seen.t_s, seen.x, seen.direction, std::max(line_variance_, seen.variance),
               weight_rest_, seen.t_s - edge_s_);
  } else {
    ramp_.forget();
  }
  bank_.predict(seen.t_s, jerk_density_, decay_1_s_);
  const auto n = static_cast<double>(seen.edges);
  const double share = 1.0 / n;
  const Lanes before = bank_.position_variance();
  const double line_variance = std::max(line_variance_, seen.variance);
  Lanes z{};
  Lanes r{};
  Lanes nu2{};
  Lanes normalised{};
  Lanes likelihood{};
  Lanes unexplained{};
  for (std::size_t j = 0; j < kModels; ++j) {
    const double blur = bank_.v[j] * clock_;
    // The stamp is even within a clock period.
    const double clock_part = blur * blur * (1.0 / 12.0);
    // The mean of x over the group's edges lies off x at their mean time by a/2 times the variance
    // of the times.
    z[j] = seen.x - 0.5 * bank_.a[j] * seen.time_variance;
    r[j] = (line_variance + clock_part) * share + kLeastVariance;
    const double nu = z[j] - bank_.x[j];
    nu2[j] = nu * nu;
    const double total = before[j] + r[j];
    const double inverse = 1.0 / total;
    normalised[j] = nu2[j] * inverse;
    // Capped: one surprise must not rule a model out for good.
    likelihood[j] =
        exp_of_minus(0.5 * std::min(normalised[j], kCap)) * std::sqrt(inverse * kInverseTwoPi);
    // What of ν² is the lines' own: less the model's variance and the clock's, times n since a
    // group averages n lines.
    unexplained[j] = weight_[j] * ((std::min(nu2[j], 9.0 * total) - before[j]) * n - clock_part);
  }
  if (std::max(std::max(normalised[0], normalised[1]), std::max(normalised[2], normalised[3])) >
      kGate) {
    Lanes wider{};
    for (std::size_t j = 0; j < kModels; ++j) {
      wider[j] =
          normalised[j] > kGate ? std::max(1.0, (nu2[j] * (1.0 / kGate) - r[j]) / before[j]) : 1.0;
    }
    // A surprised model is made wide enough that the edge is at its gate, instead of being
    // believed.
    bank_.inflate(wider);
  }
  smoother_.observed(seen.t_s, z, r);
  bank_.update(z, r);
  const double rest = weight_rest_;
  for (std::size_t j = 0; j < kModels; ++j) {
    weight_[j] *= likelihood[j];
  }
  // Hardly ever does an axis at rest give an edge.
  weight_rest_ *= tuning_.edge_at_rest;
  if (rest > 1e-3) {
    start_moving(rest * tuning_.start_at_edge, seen.x, seen.direction);
  }
  normalise();
  line_variance_ = std::clamp(
      line_variance_ + kLearn * (1.0 - weight_rest_) * (sum(unexplained) - line_variance_),
      kLeastVariance, kMostVariance);

  rest_ = {seen.x, 0.01};
  edge_s_ = seen.t_s;
  feed_back_s_ = 0.0;
  least_share_ = all(1.0);
}

/// This edge may be the first of a motion that starts here: each model is mixed with its own idea
/// of a start.
void MotionEstimator::start_moving(double share, double x, std::int8_t direction) noexcept {
  const double sign = direction >= 0 ? 1.0 : -1.0;
  const double each = share / kModels;
  // From rest at constant jerk: v goes with w^⅔, a with w^⅓, w the way from where it stood.
  const double way_third = std::cbrt(std::clamp(std::abs(x - rest_.x), 0.1, 1.0));
  for (std::size_t j = 0; j < kModels; ++j) {
    const double vw = start_speed_[j] * way_third * way_third;
    const double aw = start_acceleration_[j] * way_third;
    const double total = weight_[j] + each;
    const double stays = weight_[j] / total;
    const double starts = each / total;
    const std::array<double, 3> mean{x, sign * tuning_.start_speed * vw,
                                     sign * tuning_.start_acceleration * aw};
    const double sv = tuning_.start_speed_spread * vw;
    const double sa = tuning_.start_acceleration_spread * aw;
    const std::array<double, 6> own{
        line_variance_ + kLeastVariance, 0.0, 0.0, sv * sv, 0.95 * sv * sa, sa * sa};
    const Moments old = bank_.moments(j);
    Moments both;
    std::array<double, 3> from_old{};
    std::array<double, 3> from_own{};
    for (std::size_t i = 0; i < 3; ++i) {
      both.mean[i] = stays * old.mean[i] + starts * mean[i];
      from_old[i] = old.mean[i] - both.mean[i];
      from_own[i] = mean[i] - both.mean[i];
    }
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t m = i; m < 3; ++m, ++k) {
        // Moments of a mixture: the means' distance adds to the covariance.
        both.covariance[k] = stays * (old.covariance[k] + from_old[i] * from_old[m]) +
                             starts * (own[k] + from_own[i] * from_own[m]);
      }
    }
    bank_.set(j, both);
    weight_[j] = total;
  }
}

void MotionEstimator::normalise() noexcept {
  const double all_of_it = weight_rest_ + sum(weight_);
  // Every hypothesis was ruled out: begin with all of them alike rather than divide by 0.
  if (!(all_of_it > 0.0) || !std::isfinite(all_of_it)) {
    weight_ = all(0.2);
    weight_rest_ = 0.2;
    return;
  }
  const double inverse = 1.0 / all_of_it;
  for (double& w : weight_) {
    w *= inverse;
  }
  weight_rest_ *= inverse;
}

/// No time stamps: a single step of the count says that its line was passed since the last tick, a
/// larger one where the axis is now.
void MotionEstimator::sampled(const Tick& tick) noexcept {
  const std::int64_t steps = tick.count - last_count_;
  if (steps == 0) {
    return;
  }
  const double low = (tick.low_mm - origin_mm_) / config_.count_mm;
  const double high = (tick.high_mm - origin_mm_) / config_.count_mm;
  const double line = steps > 0 ? low : high;
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
  mix();
  last_s_ = tick.t_s;
  last_count_ = tick.count;
  return smoother_.active() ? late(tick.t_s, sure) : finish(tick, tick.t_s, mixed, sure);
}

/// The estimate of some ticks ago. It keeps to what was proved then and to what the proof of now
/// allows for then.
Estimate MotionEstimator::late(double now_s, const MotionIntervals& now) noexcept {
  const LagSmoother::Look& then = smoother_.then();
  const LagSmoother::State state = smoother_.smooth(jerk_density_, config_.cycle_s);
  MotionIntervals sure = then.sure;
  const double d = now_s - then.t_s;
  const double jerk = config_.max_jerk_mm_s3;
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

/// The estimate is kept within what is proved, and its bound is the farther end.
Estimate MotionEstimator::finish(const Tick& tick, double now_s, const Mixed& mixed,
                                 const MotionIntervals& sure) const noexcept {
  Estimate out;
  out.t_s = tick.t_s;
  out.position_mm = std::clamp(origin_mm_ + mixed.x * config_.count_mm, tick.low_mm, tick.high_mm);
  out.position_bound_mm = std::max(out.position_mm - tick.low_mm, tick.high_mm - out.position_mm);
  const JerkRamp::Motion ramp = ramp_.at(now_s, tick.t_s);
  const double v = mixed.v + ramp.share * (ramp.v - mixed.v);
  const double a = mixed.a + ramp.share * (ramp.a - mixed.a);
  out.velocity_mm_s = std::clamp(v * config_.count_mm, sure.velocity.low, sure.velocity.high);
  out.acceleration_mm_s2 =
      std::clamp(a * config_.count_mm, sure.acceleration.low, sure.acceleration.high);
  if (std::isfinite(config_.max_jerk_mm_s3) || std::isfinite(config_.max_acceleration_mm_s2)) {
    out.velocity_bound_mm_s =
        std::max(sure.velocity.high - out.velocity_mm_s, out.velocity_mm_s - sure.velocity.low);
    out.acceleration_bound_mm_s2 = std::max(sure.acceleration.high - out.acceleration_mm_s2,
                                            out.acceleration_mm_s2 - sure.acceleration.low);
  }
  return out;
}

}  // namespace steadyrest::motion::online
