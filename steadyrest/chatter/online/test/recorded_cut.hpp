// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <steadyrest/kernel/units/constants.hpp>

/// Vibration of a cut as recorders of real machines give it, written down order by order: a truth
/// that knows no detector. Nothing in it is regenerative but the one line that may be asked for.
namespace steadyrest::chatter::online::test {

struct RecordedCut {
  double rate_hz = 8000.0;
  double seconds = 16.0;
  double speed_rev_s = 50.0;  ///< true, out of the cut
  double told_ratio = 1.0;    ///< what the recording says of it, over the true one
  double droop = 0.0;         ///< of the speed under the full load
  double sway = 0.0;          ///< of the speed, slowly up and down
  std::size_t teeth = 4;
  double runout = 0.12;  ///< size of orders that are none of the teeth, over that of those
  std::size_t orders = 60;
  double decay_orders = 25.0;  ///< over which their size falls to 37 %
  double noise = 0.05;
  double entry_s = 1.0;
  double exit_s = 14.0;
  double enters_s = 0.05;  ///< how long that takes
  double leaves_s = 0.3;
  double uneven = 1.0;          ///< 0: all orders come and go alike; 1: each in its own way
  double breathing = 0.3;       ///< of each order's size, slowly
  std::vector<double> steps_s;  ///< there the engagement changes
  double mode_hz = 0.0;         ///< a structure that the entry of the tool strikes; 0: none
  double clip = 0.0;            ///< of the largest value; 0: none is clipped
  std::vector<double> gaps_s;   ///< there the sensor gives nothing
  double gap_s = 0.05;
  bool gap_missing = false;  ///< samples are missing, the clock goes on; else they are 0
  bool filtered = true;      ///< no order beyond half of the rate is heard
  // Chatter, where asked for.
  double chatter_hz = 0.0;
  double chatter_size = 0.0;  ///< over the tooth orders' RMS
  double chatter_s = 6.0;     ///< it begins …
  double chatter_ends_s = 10.0;
  double grows_1_s = 40.0;
};

struct Recorded {
  std::vector<double> value;
  std::vector<double> speed_rev_s;  ///< as told
  double forced_rms = 0.0;
  double stands_out_s = -1.0;  ///< chatter reaches 30 % of its size
};

class RecordedCutMaker {
 public:
  RecordedCutMaker(const RecordedCut& cut, std::uint64_t seed) : cut_(cut), dice_(seed) {
    using kernel::units::kTurn;
    for (std::size_t k = 1; k <= cut.orders; ++k) {
      Order order;
      order.order = static_cast<double>(k);
      const bool tooth = k % cut.teeth == 0;
      order.size =
          (tooth ? 1.0 : cut.runout) * std::exp(-order.order / cut.decay_orders) * draw(0.3, 1.0);
      order.power = 1.0 + cut.uneven * draw(-0.5, 1.0);
      order.phase = draw(0.0, kTurn);
      order.breath_hz = draw(0.05, 0.3);
      order.breath = draw(0.0, kTurn);
      for (std::size_t i = 0; i <= cut.steps_s.size(); ++i) {
        order.at_step.push_back(draw(0.4, 1.0));
        order.turn_step.push_back(cut.uneven * draw(-0.6, 0.6));
      }
      orders_.push_back(order);
    }
    for (const double at_s : cut.steps_s) {
      takes_s_.push_back(draw(0.02, 0.2));
      (void)at_s;
    }
  }

  Recorded run() {
    using kernel::units::kTurn;
    const auto count = static_cast<std::size_t>(cut_.seconds * cut_.rate_hz);
    Recorded out;
    std::normal_distribution<double> gauss;
    double angle = 0.0;
    double chatter_angle = 0.0;
    double chatter = 0.0;
    double forced = 0.0;
    double cutting = 0.0;
    double struck = 0.0;
    const double sway_hz = draw(0.1, 0.4);
    const double size = cut_.chatter_size * forced_size();
    for (std::size_t i = 0; i < count; ++i) {
      const double t = static_cast<double>(i) / cut_.rate_hz;
      const double engaged = std::clamp((t - cut_.entry_s) / cut_.enters_s, 0.0, 1.0) *
                             std::clamp((cut_.exit_s - t) / cut_.leaves_s, 0.0, 1.0);
      const double speed = cut_.speed_rev_s *
                           (1.0 - cut_.droop * engaged + cut_.sway * std::sin(kTurn * sway_hz * t));
      angle += kTurn * speed / cut_.rate_hz;
      if (i % kSlow == 0) {
        set_orders(t, engaged);
      }
      double value = engaged > 0.0 ? sum(angle, speed) : 0.0;
      if (engaged > 0.5) {
        forced += value * value;
        cutting += 1.0;
      }
      if (cut_.mode_hz > 0.0) {
        struck = engaged > 0.0 && struck == 0.0 ? t : struck;
        if (struck > 0.0) {
          value += 2.0 * std::exp(-0.03 * kTurn * cut_.mode_hz * (t - struck)) *
                   std::sin(kTurn * cut_.mode_hz * (t - struck));
        }
      }
      if (cut_.chatter_hz > 0.0 && t >= cut_.chatter_s && t < cut_.chatter_ends_s) {
        chatter += (1e-3 * size + cut_.grows_1_s * chatter * (1.0 - chatter / size)) / cut_.rate_hz;
        chatter_angle += kTurn * cut_.chatter_hz / cut_.rate_hz;
        value += chatter * engaged * std::cos(chatter_angle);
        if (out.stands_out_s < 0.0 && chatter > 0.3 * size) {
          out.stands_out_s = t;
        }
      }
      // A noise that belongs to the cut as well as the sensor's own.
      value += (cut_.noise + 0.05 * engaged) * gauss(dice_);
      out.value.push_back(value);
      out.speed_rev_s.push_back(cut_.speed_rev_s * cut_.told_ratio);
    }
    out.forced_rms = std::sqrt(forced / std::max(1.0, cutting));
    spoil(out);
    return out;
  }

 private:
  struct Order {
    double order = 0.0, size = 0.0, power = 1.0, phase = 0.0, breath_hz = 0.0, breath = 0.0;
    double c = 0.0, s = 0.0;
    std::vector<double> at_step, turn_step;
  };
  static constexpr std::size_t kSlow = 8;  ///< samples

  double draw(double a, double b) { return std::uniform_real_distribution<double>(a, b)(dice_); }

  [[nodiscard]] double forced_size() const {
    double sum = 0.0;
    for (const Order& o : orders_) {
      sum += 0.5 * o.size * o.size;
    }
    return std::sqrt(2.0 * sum);
  }

  /// Size and phase of each order now. They change slowly.
  void set_orders(double t, double engaged) {
    using kernel::units::kTurn;
    for (Order& o : orders_) {
      double level = o.at_step.front();
      double turn = o.turn_step.front();
      for (std::size_t i = 0; i < cut_.steps_s.size(); ++i) {
        const double share = std::clamp((t - cut_.steps_s[i]) / takes_s_[i], 0.0, 1.0);
        level += share * (o.at_step[i + 1] - o.at_step[i]);
        turn += share * (o.turn_step[i + 1] - o.turn_step[i]);
      }
      const double breath = 1.0 + cut_.breathing * std::sin(kTurn * o.breath_hz * t + o.breath);
      const double now = o.size * level * breath * std::pow(engaged, o.power);
      o.c = now * std::cos(o.phase + turn);
      o.s = now * std::sin(o.phase + turn);
    }
  }

  [[nodiscard]] double sum(double angle, double speed) const {
    const double cos_1 = std::cos(angle);
    const double sin_1 = std::sin(angle);
    double cos_k = 1.0;
    double sin_k = 0.0;
    double out = 0.0;
    for (const Order& o : orders_) {
      const double next = cos_k * cos_1 - sin_k * sin_1;
      sin_k = sin_k * cos_1 + cos_k * sin_1;
      cos_k = next;
      if (cut_.filtered && o.order * speed > 0.45 * cut_.rate_hz) {
        break;
      }
      out += o.c * cos_k - o.s * sin_k;
    }
    return out;
  }

  void spoil(Recorded& out) const {
    if (cut_.clip > 0.0) {
      double most = 0.0;
      for (const double v : out.value) {
        most = std::max(most, std::abs(v));
      }
      for (double& v : out.value) {
        v = std::clamp(v, -cut_.clip * most, cut_.clip * most);
      }
    }
    std::vector<bool> lost(out.value.size(), false);
    for (const double at_s : cut_.gaps_s) {
      const auto from = static_cast<std::size_t>(at_s * cut_.rate_hz);
      const auto to = static_cast<std::size_t>((at_s + cut_.gap_s) * cut_.rate_hz);
      for (std::size_t i = from; i < std::min(to, lost.size()); ++i) {
        lost[i] = true;
      }
    }
    for (std::size_t i = 0; i < lost.size(); ++i) {
      if (lost[i]) {
        out.value[i] = cut_.gap_missing ? std::numeric_limits<double>::quiet_NaN() : 0.0;
      }
    }
  }

  RecordedCut cut_;
  std::mt19937_64 dice_;
  std::vector<Order> orders_;
  std::vector<double> takes_s_;
};

inline Recorded record(const RecordedCut& cut, std::uint64_t seed) {
  return RecordedCutMaker(cut, seed).run();
}

/// What recordings of real machines have, one of each.
enum class Spoiled : std::uint8_t {
  plain,
  folded,    ///< a low rate without a filter before it
  leaving,   ///< the tool leaves slowly, each order in its own way
  drooping,  ///< up to 1 % under load
  clock,     ///< the recorder's or the spindle's, up to 0.5 % off
  runout,    ///< as large as the tooth orders
  clipped,
  gaps,
  corners,  ///< the engagement changes within the cut
  all,      ///< of them at once
};
inline constexpr std::array kSpoiled{
    Spoiled::plain,  Spoiled::folded,  Spoiled::leaving, Spoiled::drooping, Spoiled::clock,
    Spoiled::runout, Spoiled::clipped, Spoiled::gaps,    Spoiled::corners,  Spoiled::all};
inline constexpr std::array kSpoiledNames{"plain",  "folded",  "leaving", "drooping", "clock",
                                          "runout", "clipped", "gaps",    "corners",  "all"};

/// A random stable cut with that fault.
inline RecordedCut spoiled_cut(Spoiled how, std::mt19937_64& rng) {
  const auto draw = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(rng);
  };
  const auto is = [&](Spoiled one) { return how == one || how == Spoiled::all; };
  RecordedCut cut;
  cut.speed_rev_s = draw(25.0, 120.0);
  cut.teeth = static_cast<std::size_t>(draw(2.0, 7.0));
  cut.rate_hz = draw(5000.0, 26000.0);
  cut.runout = draw(0.05, 0.2);
  cut.orders = static_cast<std::size_t>(draw(40.0, 70.0));
  cut.decay_orders = draw(12.0, 35.0);
  cut.noise = draw(0.02, 0.1);
  cut.leaves_s = draw(0.02, 0.06);
  cut.enters_s = draw(0.02, 0.3);
  cut.uneven = draw(0.0, 0.3);
  cut.breathing = draw(0.05, 0.3);
  cut.mode_hz = draw(0.0, 1.0) < 0.5 ? 0.0 : draw(25.0, 400.0);
  if (how == Spoiled::folded || (how == Spoiled::all && draw(0.0, 1.0) < 0.5)) {
    cut.rate_hz = draw(1050.0, 3000.0);
    cut.filtered = false;
  }
  if (is(Spoiled::leaving)) {
    cut.leaves_s = draw(0.1, 1.0);
    cut.uneven = 1.0;
  }
  if (is(Spoiled::drooping)) {
    cut.droop = draw(0.0, 0.01);
    cut.sway = draw(0.0, 0.002);
  }
  if (is(Spoiled::clock)) {
    cut.told_ratio = 1.0 + draw(-0.005, 0.005);
  }
  if (is(Spoiled::runout)) {
    cut.runout = draw(0.3, 1.0);
  }
  if (is(Spoiled::clipped)) {
    cut.clip = draw(0.3, 0.9);
  }
  if (is(Spoiled::gaps)) {
    const double until = draw(3.0, 12.0);
    for (double at = draw(1.5, 3.0); at < until; at += draw(0.5, 4.0)) {
      cut.gaps_s.push_back(at);
    }
    cut.gap_s = draw(0.002, 0.2);
    cut.gap_missing = draw(0.0, 1.0) < 0.5;
  }
  if (is(Spoiled::corners)) {
    for (double at = draw(1.5, 3.0); at < 13.0; at += draw(0.6, 3.0)) {
      cut.steps_s.push_back(at);
    }
    cut.uneven = draw(0.3, 1.0);
  }
  return cut;
}

/// How far a frequency is from the nearest order up to the `most`th, or its fold about the rate,
/// Hz.
inline double from_order_hz(double frequency_hz, double speed_rev_s, double rate_hz, bool folds,
                            std::size_t most) {
  double least = 1e9;
  for (std::size_t k = 1; k <= most; ++k) {
    const double at = static_cast<double>(k) * speed_rev_s;
    const double heard = std::abs(at - rate_hz * std::round(at / rate_hz));
    if (folds || at < 0.5 * rate_hz) {
      least = std::min(least, std::abs(frequency_hz - heard));
    }
  }
  return least;
}

}  // namespace steadyrest::chatter::online::test
