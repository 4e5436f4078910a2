// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/chatter/online/orders/order_gate.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kApart = 0.2;    // turns, between a line and an order
constexpr double kNewBins = 0.2;  // within which a new line may be where it does not seem to be
constexpr double kShown = 0.1;    // of the line's energy
constexpr double kClippedFolds = 4.0;
constexpr double kApartSigmas = 3.0;
constexpr double kNewFoldBins = 0.5;
constexpr double kLearnable_hz = 1.0;
constexpr double kSameLine = 0.3;  // turns: a phase that jumps by more is another line's
constexpr double kSameBins = 1.5;
constexpr double kLately = 0.3;      // of a spectrum
constexpr double kSteadyBins = 0.2;  // a line that moves by more is two, one after the other
constexpr double kLongest_s = 0.5;
constexpr double kProved_s = 0.15;  // a line followed for so long is where its phase says

}  // namespace

void OrderGate::follow(const Line& line, double speed_rev_s) noexcept {
  const double seen_hz = seconds_ > 0.0 ? turns_ / seconds_ : line.frequency_hz;
  const double expected = line.frequency_hz * line.seconds;
  const double off = std::remainder(line.advance_turns - expected, 1.0);
  const bool same = line.seconds > 0.0 && std::abs(off) < kSameLine &&
                    std::abs(line.frequency_hz - seen_hz) < kSameBins * config_.bin_hz;
  if (!same) {
    turns_ = spindle_rev_ = seconds_ = 0.0;
    return;
  }
  const double now_hz = (expected + off) / line.seconds;
  lately_hz_ = seconds_ > 0.0 ? std::lerp(lately_hz_, now_hz, kLately) : now_hz;
  if (std::abs(lately_hz_ - seen_hz) > kSteadyBins * config_.bin_hz) {
    turns_ = spindle_rev_ = seconds_ = 0.0;  // it goes over into another line
  }
  const double keep =
      std::min(1.0, std::max(0.0, kLongest_s - line.seconds) / std::max(seconds_, 1e-9));
  turns_ = keep * turns_ + expected + off;
  spindle_rev_ = keep * spindle_rev_ + speed_rev_s * line.seconds;
  seconds_ = keep * seconds_ + line.seconds;
}

bool OrderGate::is_asked(double order, bool folded) const noexcept {
  const auto teeth = static_cast<double>(config_.teeth);
  return order >= 1.0 && (!folded || clipped_ || order <= static_cast<double>(config_.orders) ||
                          (std::fmod(order, teeth) == 0.0 &&
                           order <= teeth * static_cast<double>(config_.tooth_orders)));
}

void OrderGate::ask(const Near& near, double speed_rev_s, double speed_sd) noexcept {
  const double by_speed = kApartSigmas * near.order * speed_sd * speed_rev_s;
  // Of an order whose place is not known yet nothing can have been learnt.
  if (!is_asked(near.order, near.folded) ||
      (near.folded && by_speed < kLearnable_hz && !could_be(near.order))) {
    return;
  }
  // A line that has just gone over into another is for a while where neither is.
  const double seen_hz = std::abs(seen_hz_ - near.heard_hz);
  double off_hz = out_.frequency_hz - near.heard_hz;
  if (seconds_ < kProved_s && seen_hz < std::abs(off_hz)) {
    off_hz = seen_hz_ - near.heard_hz;
  }
  // Two folds nearer than a line is wide look like one between them.
  const double new_hz = (config_.folds ? kNewFoldBins : kNewBins) * config_.bin_hz;
  const double by_line = seconds_ > kProved_s ? std::min(new_hz, kApart / seconds_) : new_hz;
  const double share = std::abs(off_hz) / (by_line + by_speed);
  out_.orders += share < 1.0 ? 1 : 0;
  if (share < best_) {
    best_ = share;
    out_.order = near.order;
    out_.folded = near.folded;
    out_.off_hz = off_hz;
    out_.sd_hz = (by_line + by_speed) / kApartSigmas;
    out_.forced = share < 1.0;
    out_.by_speed = out_.forced && std::abs(off_hz) > by_line;
  }
}

/// Of the many folds those alone that have shown something: what an order changes by is of its
/// size.
bool OrderGate::could_be(double order) const noexcept {
  if (learning_ || clipped_) {
    return true;
  }
  const auto found = std::ranges::lower_bound(orders_, order, {}, &OrderFilter::Order::order);
  if (found == orders_.end() || found->order != order || !found->used) {
    return false;
  }
  return 0.5 * (found->c * found->c + found->s * found->s) > kShown * line_energy_;
}

const OrderGate::Output& OrderGate::look(const Line& line, const Shown& shown, double speed_rev_s,
                                         double speed_sd) noexcept {
  orders_ = shown.orders;
  learning_ = shown.learning;
  clipped_ = shown.clipped;
  line_energy_ = line.energy;
  follow(line, speed_rev_s);
  seen_hz_ = line.frequency_hz;
  out_ = {};
  out_.followed_s = seconds_;
  out_.frequency_hz = seconds_ > 0.0 ? turns_ / seconds_ : line.frequency_hz;
  const double speed = seconds_ > 0.0 ? spindle_rev_ / seconds_ : speed_rev_s;
  best_ = std::numeric_limits<double>::infinity();
  const double rate = config_.sample_rate_hz;
  const double most = std::max(static_cast<double>(config_.orders),
                               static_cast<double>(config_.teeth * config_.tooth_orders));
  const double folds = !config_.folds ? 0.0
                       : clipped_     ? kClippedFolds
                                      : std::floor(most * speed / rate + 0.5);
  for (double m = 0.0; m <= folds; m += 1.0) {
    for (const double side : {1.0, -1.0}) {
      if (m == 0.0 && side < 0.0) {
        continue;
      }
      const double order = std::round((m * rate + side * out_.frequency_hz) / speed);
      ask({.order = order, .heard_hz = side * (order * speed - m * rate), .folded = m > 0.0}, speed,
          speed_sd);
    }
  }
  return out_;
}

}  // namespace steadyrest::chatter::online
