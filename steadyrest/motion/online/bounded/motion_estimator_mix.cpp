// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/bounded/cell_sight.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

/// What happens at a tick: the look at the cell, and the exchange between the hypotheses.
namespace steadyrest::motion::online {
namespace {

/// Share of its hand-over that a model gives to another: halved with each model in between. Model i
/// differs from i ± 1 by a factor of some 20 … 4000 in density: a motion that changes its nature
/// mostly moves to the next one.
constexpr std::array<Lanes, kModels> kNear{{{0.0, 0.5, 0.25, 0.125},
                                            {0.5, 0.0, 0.5, 0.25},
                                            {0.25, 0.5, 0.0, 0.5},
                                            {0.125, 0.25, 0.5, 0.0}}};
constexpr Lanes kNeighbours{0.875, 1.25, 1.25, 0.875};  ///< their sums
constexpr double kSlowCycle = 0.002;                    ///< s
constexpr double kLeastWeight = 1e-12;
constexpr double kRestSpeedVariance = 0.01;          ///< (count/s)²
constexpr double kRestAccelerationVariance = 100.0;  ///< (count/s²)²

}  // namespace

/// The cell at the tick sharpens the output. It is fed back into the filters only at instants whose
/// distance from the last edge doubles each time: the same cell at every tick is not new
/// information, and treating it as new pushes the position away from both borders.
MotionEstimator::Mixed MotionEstimator::look(const Tick& tick) noexcept {
  bank_.predict(tick.t_s, jerk_density_, decay_1_s_);
  const double sigma = std::sqrt(line_variance_);
  const double low = (tick.low_mm - origin_mm_) / config_.count_mm - sigma;
  const double high = (tick.high_mm - origin_mm_) / config_.count_mm + sigma;
  const CellSight cell = see_cell(bank_, low, high);
  bool feed = false;
  if (feed_back_s_ == 0.0) {
    feed_back_s_ = edge_s_ + 2.0 * std::max(config_.cycle_s, tick.t_s - edge_s_);
  } else if (tick.t_s >= feed_back_s_) {
    feed = true;
    feed_back_s_ = edge_s_ + 2.0 * (tick.t_s - edge_s_);
  }
  Lanes y{};
  if (cell.any) {
    for (std::size_t j = 0; j < kModels; ++j) {
      // The same cell seen again may only cost a model what its share has dropped below its lowest
      // since the last edge; otherwise each tick at rest would count as new evidence.
      weight_[j] *= std::min(1.0, cell.share[j] / least_share_[j]);
      least_share_[j] = std::min(least_share_[j], cell.share[j]);
      y[j] = (cell.z[j] - bank_.x[j]) / (cell.variance[j] + cell.r[j]);
    }
    normalise();
  }
  Lanes x{};
  Lanes v{};
  Lanes a{};
  for (std::size_t j = 0; j < kModels; ++j) {  // the means as in update()
    const double xa = bank_.u13[j] * bank_.d3[j];
    const double xv = bank_.u12[j] * bank_.d2[j] + xa * bank_.u23[j];
    x[j] = weight_[j] * (bank_.x[j] + cell.variance[j] * y[j]);
    v[j] = weight_[j] * (bank_.v[j] + xv * y[j]);
    a[j] = weight_[j] * (bank_.a[j] + xa * y[j]);
  }
  if (feed) {
    if (cell.any) {
      bank_.update(cell.z, cell.r);
    }
    least_share_ = all(1.0);
  }
  return {weight_rest_ * rest_.x + sum(x), sum(v), sum(a)};
}

/// Model j becomes the mixture of all with the given parts, whose sum is 1. IMM moment matching
/// (Blom and Bar-Shalom 1988): the mixture's mean, and its covariance from the parts' own plus the
/// spread of their means. P is expanded from UD, mixed, and factored again.
void MotionEstimator::take_over(std::size_t j, const Lanes& part, double part_rest) noexcept {
  const Lanes p = part;  // a copy cannot overlap with the bank
  Lanes x{};
  Lanes v{};
  Lanes a{};
  for (std::size_t i = 0; i < kModels; ++i) {
    x[i] = p[i] * bank_.x[i];
    v[i] = p[i] * bank_.v[i];
    a[i] = p[i] * bank_.a[i];
  }
  Moments mixed;
  mixed.mean = {sum(x) + part_rest * rest_.x, sum(v), sum(a)};
  const auto [mx, mv, ma] = mixed.mean;
  std::array<Lanes, 6> c{};
  for (std::size_t i = 0; i < kModels; ++i) {
    const double dx = bank_.x[i] - mx;
    const double dv = bank_.v[i] - mv;
    const double da = bank_.a[i] - ma;
    const double xa = bank_.u13[i] * bank_.d3[i];
    const double va = bank_.u23[i] * bank_.d3[i];
    const double xv = bank_.u12[i] * bank_.d2[i];
    c[0][i] = p[i] * (bank_.d1[i] + bank_.u12[i] * xv + bank_.u13[i] * xa + dx * dx);
    c[1][i] = p[i] * (xv + bank_.u13[i] * va + dx * dv);
    c[2][i] = p[i] * (xa + dx * da);
    c[3][i] = p[i] * (bank_.d2[i] + bank_.u23[i] * va + dv * dv);
    c[4][i] = p[i] * (va + dv * da);
    c[5][i] = p[i] * (bank_.d3[i] + da * da);
  }
  const double dx = rest_.x - mx;
  mixed.covariance = {sum(c[0]) + part_rest * (rest_.variance + dx * dx),
                      sum(c[1]) - part_rest * dx * mv,
                      sum(c[2]) - part_rest * dx * ma,
                      sum(c[3]) + part_rest * (kRestSpeedVariance + mv * mv),
                      sum(c[4]) + part_rest * mv * ma,
                      sum(c[5]) + part_rest * (kRestAccelerationVariance + ma * ma)};
  bank_.set(j, mixed);
}

/// What each model passes to standstill in this tick, and what it keeps.
MotionEstimator::Exchange MotionEstimator::exchange() const noexcept {
  const double cycle = config_.cycle_s;
  Exchange out;
  out.hand_over = tuning_.switch_1_s * cycle;
  out.starts = tuning_.start_1_s * cycle;
  for (std::size_t i = 0; i < kModels; ++i) {
    // A model stops where speed 0 is within its spread: rate × exp(−v²/2σ²). The exponent is capped
    // at 4: beyond v² = 8σ² one per cent remains, so that no motion is entirely barred from
    // stopping.
    const double variance = bank_.d2[i] + bank_.u23[i] * bank_.u23[i] * bank_.d3[i];
    const double v2 = 0.5 * bank_.v[i] * bank_.v[i];
    const double e = tuning_.stop_1_s * cycle * exp_of_minus(std::min(4.0, v2 / (variance + 1e-6)));
    out.stops[i] = v2 > 4.0 * variance ? 0.01 * e : e;
    out.stays[i] = 1.0 - out.stops[i] - out.hand_over * kNeighbours[i];
  }
  return out;
}

/// In a fast cycle one model per tick takes over four ticks' worth from the others: the cost of a
/// tick stays even. The models are mixed in place, one after another. A later one sees the earlier
/// ones already mixed; since a tick hands over less than a few per cent, that differs only in
/// second order.
void MotionEstimator::hand_over(const Exchange& gives) noexcept {
  const bool fast = config_.cycle_s < kSlowCycle;
  const std::size_t models = fast ? 1 : kModels;
  const double ticks = fast ? static_cast<double>(kModels) : 1.0;
  for (std::size_t k = 0; k < models; ++k) {
    const std::size_t j = turn_;
    turn_ = (turn_ + 1) % kModels;
    Lanes part{};
    for (std::size_t i = 0; i < kModels; ++i) {
      part[i] = weight_[i] * kNear[j][i] * gives.hand_over * ticks;
    }
    part[j] = weight_[j] * gives.stays[j];
    const double part_rest = weight_rest_ * (gives.starts / kModels) * ticks;
    const double whole = sum(part) + part_rest;
    if (whole > 1e-300) {
      const double inverse = 1.0 / whole;
      for (double& p : part) {
        p *= inverse;
      }
      take_over(j, part, part_rest * inverse);
    }
  }
}

/// Standstill becomes the mixture of itself and the stopped models; returns its new weight.
double MotionEstimator::come_to_rest(const Exchange& gives) noexcept {
  const double rest_stays = weight_rest_ * (1.0 - gives.starts);
  Lanes stopped{};
  Lanes x{};
  for (std::size_t i = 0; i < kModels; ++i) {
    stopped[i] = weight_[i] * gives.stops[i];
    x[i] = stopped[i] * bank_.x[i];
  }
  const double next_rest = rest_stays + sum(stopped);
  if (next_rest > 0.0) {
    const double inverse = 1.0 / next_rest;
    const double mean = (rest_stays * rest_.x + sum(x)) * inverse;
    const Lanes spread = bank_.position_variance();
    Lanes variance{};
    for (std::size_t i = 0; i < kModels; ++i) {
      const double d = bank_.x[i] - mean;
      variance[i] = stopped[i] * (spread[i] + d * d);
    }
    const double d = rest_.x - mean;
    rest_ = {mean, std::max((rest_stays * (rest_.variance + d * d) + sum(variance)) * inverse,
                            kLeastVariance)};
  }
  return next_rest;
}

void MotionEstimator::mix() noexcept {
  const Exchange gives = exchange();
  Lanes next{};
  for (std::size_t i = 0; i < kModels; ++i) {
    double from_others = 0.0;
    for (std::size_t k = 0; k < kModels; ++k) {
      // The weights first, from the state before the exchange: hand_over and come_to_rest read them
      // too.
      from_others += kNear[k][i] * weight_[k];
    }
    next[i] = weight_rest_ * (gives.starts / kModels) + gives.hand_over * from_others +
              weight_[i] * gives.stays[i];
  }
  hand_over(gives);
  const double next_rest = come_to_rest(gives);
  // Everything given is received: the sum of the weights stays 1.
  for (std::size_t i = 0; i < kModels; ++i) {
    weight_[i] = std::max(next[i], kLeastWeight);
  }
  weight_rest_ = std::max(next_rest, kLeastWeight);
}

}  // namespace steadyrest::motion::online
