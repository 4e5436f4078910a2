// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/online/speed_law.hpp>
#include <steadyrest/kernel/machine/chatter.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Shapes S(u) over one period with mean 0, so that a law keeps the mean speed and the cutting time.
// integral() is exact: the solver inverts angle = ∫speed, and a numerical sum would blunt the
// corners.
namespace steadyrest::chatter::online {
namespace {

using kernel::machine::kSpeedLawNames;

using kernel::units::kTurn;
constexpr double kPulseShare = 0.25;
constexpr double kStopShare = 0.1;
constexpr double kKnots = static_cast<double>(SpeedLaw::kRandomKnots);

/// splitmix64: the same numbers on every machine.
double draw(std::uint64_t& state) noexcept {
  state += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  z ^= z >> 31U;
  return static_cast<double>(z >> 11U) * 0x1.0p-53;
}

/// +1 for the share, less for the rest so that the mean is 0.
double pulse(double u, double share) noexcept {
  return u < share ? 1.0 : -share / (1.0 - share);
}

// u up to the share s, then s − (u − s)·s/(1 − s) = s·(1 − u)/(1 − s), back at 0 for u = 1.
double pulse_integral(double u, double share) noexcept {
  return u < share ? u : share * (1.0 - u) / (1.0 - share);
}

}  // namespace

const char* name(Law law) noexcept {
  return kSpeedLawNames[static_cast<std::size_t>(law)].data();
}

std::optional<Law> law_of(std::string_view word) noexcept {
  for (std::size_t i = 0; i < kSpeedLawNames.size(); ++i) {
    if (word == kSpeedLawNames[i]) {
      return static_cast<Law>(i);
    }
  }
  return std::nullopt;
}

SpeedLaw::SpeedLaw(Law law, std::uint64_t seed) noexcept : law_(law) {
  switch (law) {
    case Law::constant:
    case Law::sine:
      break;
    case Law::square:
      corner(0.0);
      corner(0.5);
      break;
    case Law::pulse:
      corner(0.0);
      corner(kPulseShare);
      break;
    case Law::stop:
      corner(0.0);
      corner(kStopShare);
      break;
    case Law::triangle:
      corner(0.25);
      corner(0.75);
      break;
    case Law::random: {
      double mean = 0.0;
      for (std::size_t k = 0; k < kRandomKnots; ++k) {
        corner(static_cast<double>(k) / kKnots);
        knot_[k] = 2.0 * draw(seed) - 1.0;
        mean += knot_[k] / kKnots;
      }
      double largest = 0.0;
      for (std::size_t k = 0; k < kRandomKnots; ++k) {
        // Mean 0 first, then scaled to ±1, so that the amplitude is the largest swing.
        knot_[k] -= mean;
        largest = std::max(largest, std::abs(knot_[k]));
      }
      for (std::size_t k = 0; k < kRandomKnots; ++k) {
        knot_[k] /= largest;
      }
      // Periodic without a jump at the end of the period.
      knot_[kRandomKnots] = knot_[0];
      for (std::size_t k = 0; k < kRandomKnots; ++k) {
        knot_integral_[k + 1] = knot_integral_[k] + 0.5 * (knot_[k] + knot_[k + 1]) / kKnots;
      }
      break;
    }
  }
}

double SpeedLaw::at(double phase) const noexcept {
  const double u = phase - std::floor(phase);
  switch (law_) {
    case Law::constant:
      return 0.0;
    case Law::sine:
      return std::sin(kTurn * u);
    case Law::square:
      return u < 0.5 ? 1.0 : -1.0;
    case Law::pulse:
      return pulse(u, kPulseShare);
    case Law::stop:
      return -pulse(u, kStopShare);
    case Law::triangle:
      return u < 0.25 ? 4.0 * u : (u < 0.75 ? 2.0 - 4.0 * u : 4.0 * u - 4.0);
    case Law::random: {
      // Just below 1 the product may round up to the number of knots.
      const auto k = std::min(static_cast<std::size_t>(u * kKnots), kRandomKnots - 1);
      const double share = u * kKnots - static_cast<double>(k);
      return knot_[k] + share * (knot_[k + 1] - knot_[k]);
    }
  }
  return 0.0;
}

double SpeedLaw::integral(double phase) const noexcept {
  const double u = std::clamp(phase, 0.0, 1.0);
  switch (law_) {
    case Law::constant:
      return 0.0;
    case Law::sine:
      return (1.0 - std::cos(kTurn * u)) / kTurn;
    case Law::square:
      return u < 0.5 ? u : 1.0 - u;
    case Law::pulse:
      return pulse_integral(u, kPulseShare);
    case Law::stop:
      return -pulse_integral(u, kStopShare);
    case Law::triangle:
      // Antiderivative of the triangle with value 0 at both ends.
      return u < 0.25   ? 2.0 * u * u
             : u < 0.75 ? 0.25 - 2.0 * (u - 0.5) * (u - 0.5)
                        : 2.0 * (1.0 - u) * (1.0 - u);
    case Law::random: {
      const auto k = std::min(static_cast<std::size_t>(u * kKnots), kRandomKnots - 1);
      const double share = u * kKnots - static_cast<double>(k);
      return knot_integral_[k] +
             (knot_[k] + 0.5 * share * (knot_[k + 1] - knot_[k])) * share / kKnots;
    }
  }
  return 0.0;
}

}  // namespace steadyrest::chatter::online
