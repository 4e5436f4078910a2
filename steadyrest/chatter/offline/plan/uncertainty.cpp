// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <boost/math/special_functions/erf.hpp>

#include <steadyrest/chatter/offline/plan/uncertainty.hpp>

// A Latin hypercube (McKay, Beckman and Conover 1979): each figure's distribution is divided into
// as many equally likely parts as there are samples, with one draw from each part. The share of
// stable cuts then scatters less than with independent draws.
namespace steadyrest::chatter::offline {
namespace {

constexpr double kLeastFrequencyFactor = 0.1;
constexpr double kMostDrawnDamping = 0.99;

/// splitmix64: the same numbers on every machine.
std::uint64_t draw(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

/// One figure: a normal value from each n-th part of the distribution, in random order.
std::vector<double> column(std::size_t n, std::uint64_t& state) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    // The 53 bits a double holds: even in [0, 1).
    const double within = static_cast<double>(draw(state) >> 11U) * 0x1.0p-53;
    const double share =
        std::clamp((static_cast<double>(i) + within) / static_cast<double>(n), 1e-12, 1.0 - 1e-12);
    out[i] = -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * share);
  }
  // Fisher–Yates. Without it all figures would be small together and large together.
  for (std::size_t i = n; i > 1; --i) {
    std::swap(out[i - 1], out[static_cast<std::size_t>(draw(state) % i)]);
  }
  return out;
}

}  // namespace

std::vector<Process> possible_cuts(const Process& process, const Uncertainty& of) {
  std::uint64_t state = of.seed;
  std::vector<Process> out(of.samples, process);
  for (std::size_t m = 0; m < process.modes.size(); ++m) {
    const std::vector<double> frequency = column(of.samples, state);
    const std::vector<double> damping = column(of.samples, state);
    for (std::size_t i = 0; i < of.samples; ++i) {
      Mode& mode = out[i].modes[m];
      // Mass and frequency represent a measured stiffness k = m·ω²: k stays, so m falls as f rises.
      const double factor = std::max(kLeastFrequencyFactor, 1.0 + of.frequency * frequency[i]);
      mode.frequency_hz *= factor;
      mode.mass_kg /= factor * factor;
      mode.damping_ratio =
          std::min(kMostDrawnDamping, mode.damping_ratio * std::exp(of.damping * damping[i]));
    }
  }
  const std::vector<double> tangential = column(of.samples, state);
  const std::vector<double> radial = column(of.samples, state);
  for (std::size_t i = 0; i < of.samples; ++i) {
    // Log-normal: a cutting coefficient stays positive however large σ is.
    out[i].cut.tangential_n_mm2 *= std::exp(of.coefficients * tangential[i]);
    out[i].cut.radial_n_mm2 *= std::exp(of.coefficients * radial[i]);
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
