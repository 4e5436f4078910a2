// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>

/// Random numbers for the hunts, the same on every machine, and what is drawn from them.
namespace steadyrest::chatter::online::test {

/// splitmix64
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  std::uint64_t below(std::uint64_t n) { return (next() >> 11U) % n; }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  double within(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11U) * 0x1.0p-53;
  }
  double unfit() {
    constexpr std::array kUnfit{std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(), -1.0, 1e300};
    return kUnfit[below(kUnfit.size())];
  }

 private:
  std::uint64_t state_;
};

/// A modulator and how fast both envelopes slew. In a calm machine only the modulation moves the
/// feed per tooth.
struct RandomSetup {
  Modulator::Config config;
  double slew_1_s = 2.0;
};

inline RandomSetup random_setup(Dice& dice, bool calm) {
  namespace tables = kernel::override::test;
  RandomSetup setup;
  auto& [c, slew_1_s] = setup;
  c.spindle_table = dice.one_in(4) ? tables::percent_word() : tables::spindle_840d();
  c.feed_table = dice.one_in(2) ? tables::feed_840d() : tables::feed_dmg();
  c.spindle_table.layer_may_exceed_panel = dice.one_in(3);
  c.feed_table.layer_may_exceed_panel = dice.one_in(3);
  for (auto* table : {&c.spindle_table, &c.feed_table}) {
    table->scan_period_s = dice.within(0.001, 0.03);
    table->dead_time_s = dice.one_in(2) ? 0.0 : dice.within(0.0, 0.1);
  }
  c.min_ratio = dice.within(0.3, 0.8);
  c.max_ratio = std::max(c.min_ratio + dice.within(0.21, 0.6), 0.7);
  c.max_rev_s = dice.one_in(2) ? kernel::machine::kUnlimited : dice.within(40.0, 80.0);
  c.min_rev_s = dice.one_in(2) ? 0.0 : dice.within(0.0, 30.0);
  slew_1_s = dice.within(0.2, 20.0);
  c.acceleration_rev_s2 = dice.within(1.0, 400.0);
  c.min_feed_per_tooth_ratio = dice.within(0.5, 1.0);
  c.max_feed_per_tooth_ratio = dice.within(1.0, 1.5);
  c.fade_s = dice.within(0.01, 1.0);
  c.hysteresis = dice.within(0.0, 0.5);
  c.always = dice.one_in(4);
  if (calm) {
    c.max_ratio = std::max(c.max_ratio, 1.0);
    c.max_rev_s = std::max(c.max_rev_s, 50.0);
  }
  return setup;
}

/// Changes one value of a modulation, now and then to an invalid one.
inline Modulation random_change(Modulation m, Dice& dice) {
  switch (dice.below(6)) {
    case 0:
      m.law = static_cast<Law>(dice.below(7));
      break;
    case 1:
      m.amplitude_ratio = dice.one_in(16) ? dice.unfit() : dice.within(0.0, 0.9);
      break;
    case 2:
      m.amplitude_rev_s = dice.one_in(16)  ? dice.unfit()
                          : dice.one_in(2) ? 0.0
                                           : dice.within(0.0, 30.0);
      break;
    case 3:
      m.period_s = dice.one_in(16) ? dice.unfit() : std::exp(dice.within(-3.9, 6.3));
      break;
    case 4:
      m.mean_ratio = dice.one_in(16) ? dice.unfit() : dice.within(0.1, 2.0);
      break;
    default:
      m.law = dice.one_in(8) ? static_cast<Law>(dice.below(256)) : m.law;
      m.seed = dice.next();
  }
  return m;
}

}  // namespace steadyrest::chatter::online::test
