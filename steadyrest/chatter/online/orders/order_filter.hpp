// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::online {

/// Removes the forced vibration from a signal: whatever repeats with the spindle and the teeth.
///
/// Law, θ the spindle's angle, k the orders 0, 1 … spindle_harmonics and N, 2N … tooth_harmonics·N:
///   ŷ = Σ cₖ·cos kθ + sₖ·sin kθ,  e = y − ŷ,  cₖ += gₖ·e·cos kθ,  sₖ += gₖ·e·sin kθ.
/// This is the Kalman filter with two states per order that rotate by k·Ω·Ts each sample (Caliskan,
/// Kilic, Altintas 2018), seen from the rotating frame, where the states are constant; so it
/// follows any speed law. Its covariance is taken as diagonal, which it is over whole revolutions:
///   pₖ += qₖ,  gₖ = pₖ/(1 + Σp),  pₖ −= gₖ·pₖ/2,  qₖ = 2/(memoryₖ·fs/Ω)².
///
/// Orders midway between two multiples of N come from runout and also from period-doubling chatter.
/// They and runout's other orders forget slowly, and freeze while the caller sets `hold`. Orders
/// beyond 0.45·fs do nothing; with `folds` they are taken where the samples show them, which cos kθ
/// itself does. There they lie close to one another and forget as slowly as half orders do.
/// O(orders) per sample.
class OrderFilter {
 public:
  struct Config {
    double sample_rate_hz = 10e3;        ///< 1e3 … 50e3
    std::size_t teeth = 2;               ///< N, 1 … 64
    std::size_t tooth_harmonics = 24;    ///< 1 … 64
    std::size_t spindle_harmonics = 40;  ///< 0 … 64
    double tooth_memory_rev = 4.0;       ///< revolutions until 63 % is learnt, 1 … 1000
    double moving_memory_rev = 1.0;      ///< the same while the speed moves
    double runout_memory_rev = 16.0;     ///< of spindle orders other than tooth orders
    double half_memory_rev = 40.0;       ///< of orders midway between tooth orders
    bool folds = false;  ///< orders beyond half of the rate are heard too, folded about it
  };

  struct Output {
    double residual = 0.0;       ///< e, in the signal's unit
    double forced_energy = 0.0;  ///< Σ (c² + s²)/2 without order 0, unit²
    double tooth_energy = 0.0;   ///< the part of the tooth orders
    double mean = 0.0;           ///< order 0
    double estimate = 0.0;       ///< ŷ
  };

  [[nodiscard]] static kernel::outcome::Result<OrderFilter> make(const Config& config);

  /// `value` NaN: the sensor gave none; nothing is learnt and the residual is 0. `angle_rev` any
  /// real number, `speed_rev_s` > 0, all finite; `moving`: the speed is not constant.
  Output update(double value, double angle_rev, double speed_rev_s, bool moving,
                bool hold) noexcept;
  /// A new cut has begun: learns as at the start, from the present values. At constant speed
  /// runout's orders are learnt over some revolutions, or they would at once absorb the beginning
  /// of chatter near them.
  void open(bool moving) noexcept;
  void reset() noexcept;

  struct Order {
    double order = 0.0;
    double drift = 0.0;  ///< 2/memory²
    bool tooth = false;
    bool used = false;    ///< it is within the sensor's reach …
    bool folded = false;  ///< … though beyond half of the rate
    double c = 0.0, s = 0.0, p = 0.0;
    double cos = 1.0, sin = 0.0;
    double block_c = 0.0, block_s = 0.0;  ///< Σ e·cos kθ, Σ e·sin kθ of the block
  };
  [[nodiscard]] std::span<const Order> orders() const noexcept { return orders_; }
  void begin_block() noexcept;

 private:
  OrderFilter(const Config& config, std::vector<Order> orders);
  struct Learning {
    bool gap = false;
    bool hold = false;
  };
  /// From the residual in `out`, whose energies it adds up; `share`: 1/(1 + Σp).
  static void learn(std::span<Order> used, double share, const Learning& how, Output& out) noexcept;
  /// `turn`: of the order's angle in a sample.
  [[nodiscard]] bool is_heard(double turn) const noexcept;

  Config config_;
  std::vector<Order> orders_;  ///< rising
};

}  // namespace steadyrest::chatter::online
