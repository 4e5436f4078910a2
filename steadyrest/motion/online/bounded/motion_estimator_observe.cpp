// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

/// What happens at an edge: every hypothesis is compared with it.
namespace steadyrest::motion::online {
namespace {

// Chosen with the constants of motion_estimator.cpp.
constexpr double kGate = 5.08;     ///< normalised innovation² beyond which a model is widened
constexpr double kCap = 3.96;      ///< … and beyond which it loses no more weight
constexpr double kLearn = 0.0043;  ///< share of an innovation in σ_line²
constexpr double kInverseTwoPi = 0.15915494309189535;

/// The edge as each model sees it, and its distance from the model's prediction.
struct Comparison {
  Lanes z{};  ///< measured position
  Lanes r{};  ///< its variance
  Lanes nu2{};
  Lanes normalised{};
  Lanes likelihood{};
  Lanes unexplained{};  ///< of ν², times n: the lines' own part
};

/// `variance` of the models' positions, `least` of z.
Comparison compare(const ModelBank& bank, const Lanes& variance, const Observation& seen,
                   double line_variance, double clock, double least) noexcept {
  const auto n = static_cast<double>(seen.edges);
  const double share = 1.0 / n;
  Comparison out;
  for (std::size_t j = 0; j < kModels; ++j) {
    const double blur = bank.v[j] * clock;
    // The stamp is evenly distributed over a clock period.
    const double clock_part = blur * blur * (1.0 / 12.0);
    // The mean of x over the group's edges differs from x at their mean time by a/2 times the
    // variance of the times.
    out.z[j] = seen.x - 0.5 * bank.a[j] * seen.time_variance;
    out.r[j] = (line_variance + clock_part) * share + least;
    const double nu = out.z[j] - bank.x[j];
    out.nu2[j] = nu * nu;
    const double total = variance[j] + out.r[j];
    const double inverse = 1.0 / total;
    out.normalised[j] = out.nu2[j] * inverse;
    // Capped: one surprise must not rule a model out for good.
    out.likelihood[j] =
        exp_of_minus(0.5 * std::min(out.normalised[j], kCap)) * std::sqrt(inverse * kInverseTwoPi);
    // Minus the model's variance and the clock's, times n since a group averages n lines.
    out.unexplained[j] = (std::min(out.nu2[j], 9.0 * total) - variance[j]) * n - clock_part;
  }
  return out;
}

/// A surprised model is widened until the edge is at its gate, instead of being trusted.
void widen_surprised(const Comparison& seen, const Lanes& variance, ModelBank& bank) noexcept {
  const Lanes& surprise = seen.normalised;
  if (!(std::max(std::max(surprise[0], surprise[1]), std::max(surprise[2], surprise[3])) > kGate)) {
    return;
  }
  Lanes wider{};
  for (std::size_t j = 0; j < kModels; ++j) {
    wider[j] = surprise[j] > kGate
                   ? std::max(1.0, (seen.nu2[j] * (1.0 / kGate) - seen.r[j]) / variance[j])
                   : 1.0;
  }
  bank.inflate(wider);
}

}  // namespace

void MotionEstimator::observe(const Observation& seen) noexcept {
  const double line_variance = std::max(line_variance_, seen.variance);
  // A group of edges has no single line and no single time: the ramp needs both.
  if (seen.edges == 1 && !sampled_) {
    ramp_.edge(seen.t_s, seen.x, seen.direction, line_variance, weight_rest_, seen.t_s - edge_s_);
  } else {
    ramp_.forget();
  }
  // The order matters: surprise is measured before the update, the smoother stores what the update
  // uses, and weights change only after all models have been compared with the same edge.
  bank_.predict(seen.t_s, jerk_density_, decay_1_s_);
  const Lanes variance = bank_.position_variance();
  const Comparison at = compare(bank_, variance, seen, line_variance, clock_, kLeastVariance);
  widen_surprised(at, variance, bank_);
  smoother_.observed(seen.t_s, at.z, at.r);
  bank_.update(at.z, at.r);
  Lanes unexplained{};
  for (std::size_t j = 0; j < kModels; ++j) {
    unexplained[j] = weight_[j] * at.unexplained[j];
    weight_[j] *= at.likelihood[j];
  }
  const double rest = weight_rest_;
  // An axis at rest hardly ever produces an edge.
  weight_rest_ *= tuning_.edge_at_rest;
  // Below 0.1 % the mixing would change nothing but cost four factorisations.
  if (rest > 1e-3) {
    start_moving(rest * tuning_.start_at_edge, seen.x, seen.direction);
  }
  normalise();
  // σ_line² follows the models' unexplained part, weighted by their probability; nothing is learnt
  // from an axis that may be at rest.
  line_variance_ = std::clamp(
      line_variance_ + kLearn * (1.0 - weight_rest_) * (sum(unexplained) - line_variance_),
      kLeastVariance, kMostVariance);

  // If the axis stops now it stops at this line, ± 0.1 counts.
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
  // From rest at constant jerk: v goes with w^⅔, a with w^⅓, w the way from the point of rest.
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
        // Moments of a mixture: the distance of the means adds to the covariance.
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
  // Every hypothesis was ruled out: start with all of them equal rather than divide by 0.
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

}  // namespace steadyrest::motion::online
