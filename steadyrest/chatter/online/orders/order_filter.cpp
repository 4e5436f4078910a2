// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <steadyrest/chatter/online/orders/detector_refusal.hpp>
#include <steadyrest/chatter/online/orders/order_filter.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// A Kalman filter whose states are cosine and sine of each order. Between samples they turn with
// the spindle, so a modulated speed needs no resampling. Each order keeps one scalar variance
// instead of a matrix: orders are nearly orthogonal over a revolution, and the cost stays linear in
// their number.
namespace steadyrest::chatter::online {
namespace {

using kernel::units::kTurn;

constexpr double kUnknown = 10.0;     // p at the start, as in the source
constexpr double kSlowStart = 0.01;   // the same for runout, as if 100 samples had been seen
constexpr double kHighest = 0.45;     // of the sample rate; 0.5 is the Nyquist limit
constexpr double kLowestFold = 0.01;  // the same: a fold below is a drift of the sensor

bool is_memory(double revolutions) {
  return revolutions >= 0.1 && revolutions <= 1000.0;
}

}  // namespace

kernel::outcome::Result<OrderFilter> OrderFilter::make(const Config& config) {
  if (!(config.sample_rate_hz >= 1e3 && config.sample_rate_hz <= 50e3)) {
    return refuse_detector("sample rate " + std::to_string(config.sample_rate_hz) +
                           " Hz is not within 1000…50000 Hz");
  }
  if (config.teeth < 1 || config.teeth > 64) {
    return refuse_detector(std::to_string(config.teeth) + " teeth are not within 1…64");
  }
  if (config.tooth_harmonics < 1 || config.tooth_harmonics > 64 || config.spindle_harmonics > 64) {
    return refuse_detector("number of harmonics is not within 1…64");
  }
  if (!is_memory(config.tooth_memory_rev) || !is_memory(config.moving_memory_rev) ||
      !is_memory(config.runout_memory_rev) || !is_memory(config.half_memory_rev)) {
    return refuse_detector("a memory is not within 0.1…1000 revolutions");
  }
  std::vector<Order> orders;
  const std::size_t last_tooth = config.teeth * config.tooth_harmonics;
  for (std::size_t k = 0; k <= std::max(last_tooth, config.spindle_harmonics); ++k) {
    const bool tooth = k % config.teeth == 0;
    const bool half = 2 * k % config.teeth == 0;
    if (tooth ? k > last_tooth : k > config.spindle_harmonics) {
      continue;
    }
    // p settles where p²/2 = q·share², share the part of a turn in one sample; with q = 2/memory²
    // that is p = 2·share/memory. An amplitude follows at p/2 per sample: `memory` revolutions.
    const double memory = tooth  ? config.tooth_memory_rev
                          : half ? config.half_memory_rev
                                 : config.runout_memory_rev;
    Order order;
    order.order = static_cast<double>(k);
    order.drift = 2.0 / (memory * memory);
    order.tooth = tooth;
    order.p = kUnknown;
    orders.push_back(order);
  }
  return OrderFilter(config, std::move(orders));
}

OrderFilter::OrderFilter(const Config& config, std::vector<Order> orders)
    : config_(config), orders_(std::move(orders)) {}

OrderFilter::Output OrderFilter::update(double value, double angle_rev, double speed_rev_s,
                                        bool moving, bool hold) noexcept {
  const double angle = kTurn * (angle_rev - std::floor(angle_rev));
  const double turn_share = speed_rev_s / config_.sample_rate_hz;
  const double cos_step = std::cos(angle);
  const double sin_step = std::sin(angle);
  const double unrest = turn_share * turn_share;
  // q goes with 1/memory²: a memory shorter by the factor `quick` has quick² times the drift.
  const double quick = config_.tooth_memory_rev / config_.moving_memory_rev;
  const double tooth_unrest = moving ? unrest * quick * quick : unrest;
  const double folded_drift = 2.0 / (config_.half_memory_rev * config_.half_memory_rev);
  double cos_k = 1.0;
  double sin_k = 0.0;
  double at = 0.0;
  double sum_p = 1.0;
  double estimate = 0.0;
  std::size_t used = 0;
  for (; used < orders_.size(); ++used) {
    Order& o = orders_[used];
    o.used = is_heard(o.order * turn_share);
    if (!o.used) {
      if (config_.folds) {
        continue;
      }
      for (std::size_t i = used + 1; i < orders_.size() && orders_[i].used; ++i) {
        orders_[i].used = false;
      }
      break;
    }
    // cos kθ and sin kθ by rotation: one sine and cosine per sample instead of one per order.
    while (at < o.order) {  // at most one extra turn for each omitted order
      const double next = cos_k * cos_step - sin_k * sin_step;
      sin_k = sin_k * cos_step + cos_k * sin_step;
      cos_k = next;
      at += 1.0;
    }
    o.cos = cos_k;
    o.sin = sin_k;
    o.folded = o.order * turn_share >= kHighest;
    o.p += o.folded ? folded_drift * unrest : o.drift * (o.tooth ? tooth_unrest : unrest);
    sum_p += o.p;
    estimate += o.c * cos_k + o.s * sin_k;
  }
  Output out;
  out.estimate = estimate;
  const bool gap = std::isnan(value);
  out.residual = gap ? 0.0 : value - estimate;
  learn(std::span(orders_).first(used), 1.0 / sum_p, {.gap = gap, .hold = hold}, out);
  out.mean = orders_.front().c;
  return out;
}

void OrderFilter::learn(std::span<Order> used, double share, const Learning& how,
                        Output& out) noexcept {
  for (Order& o : used) {
    if (!o.used) {
      continue;
    }
    const double gain = o.p * share;
    const double along = out.residual * o.cos;
    const double across = out.residual * o.sin;
    o.block_c += along;
    o.block_s += across;
    if (!how.gap && (!how.hold || (o.tooth && !o.folded))) {
      o.c += gain * along;
      o.s += gain * across;
    }
    // Half: over a revolution cos² and sin² average to ½.
    o.p -= how.gap ? 0.0 : 0.5 * gain * o.p;
    const double energy = 0.5 * (o.c * o.c + o.s * o.s);
    out.forced_energy += o.order == 0.0 ? 0.0 : energy;
    out.tooth_energy += o.order == 0.0 || !o.tooth ? 0.0 : energy;
  }
}

bool OrderFilter::is_heard(double turn) const noexcept {
  if (turn < kHighest) {
    return true;
  }
  const double folded = std::abs(turn - std::round(turn));
  return config_.folds && folded > kLowestFold && folded < kHighest;
}

void OrderFilter::begin_block() noexcept {
  for (Order& o : orders_) {
    o.block_c = o.block_s = 0.0;
  }
}

void OrderFilter::open(bool moving) noexcept {
  for (Order& o : orders_) {
    // Runout is learnt over revolutions: quick learning would mistake chatter near a spindle order
    // for it.
    o.p = o.tooth || moving ? kUnknown : kSlowStart;
  }
}

void OrderFilter::reset() noexcept {
  for (Order& o : orders_) {
    o.c = o.s = 0.0;
    o.p = kUnknown;
  }
}

}  // namespace steadyrest::chatter::online
