// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include <steadyrest/sim/base/portable.hpp>

namespace steadyrest::sim {

/// Standard normal numbers from a seed: the same bytes with every compiler and library.
///
/// std::mt19937_64 (the C++ standard fixes its sequence) and the Box–Muller transform on our own ln
/// and sin; std::normal_distribution is not used because each library implements it differently.
/// Two numbers per two words; bounded time.
class NormalNoise {
 public:
  explicit NormalNoise(std::uint64_t seed) : engine_(seed) {}

  double next() noexcept {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * portable::log(uniform()));
    const double turns = uniform();
    spare_ = radius * portable::sin_turn(turns);
    has_spare_ = true;
    return radius * portable::sin_turn(turns + 0.25);
  }

 private:
  /// Centres of 2⁵³ equal cells: never 0, never 1.
  double uniform() noexcept { return (static_cast<double>(engine_() >> 11U) + 0.5) * 0x1.0p-53; }

  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// Noise with a correlation time (Ornstein–Uhlenbeck, exactly discretised):
/// n' = ρ·n + σ·√(1 − ρ²)·w, ρ = exp(−T/T_c), w standard normal. Stationary from the first sample,
/// RMS σ, autocorrelation exp(−|Δt|/T_c).
class ColouredNoise {
 public:
  ColouredNoise(double rms, double period_s, double correlation_s) noexcept
      : rms_(rms),
        share_(portable::exp(-period_s / correlation_s)),
        fresh_(rms * std::sqrt(1.0 - share_ * share_)) {}

  double update(double standard_normal) noexcept {
    value_ = started_ ? share_ * value_ + fresh_ * standard_normal : rms_ * standard_normal;
    started_ = true;
    return value_;
  }

 private:
  double rms_;
  double share_;
  double fresh_;
  double value_ = 0.0;
  bool started_ = false;
};

}  // namespace steadyrest::sim
