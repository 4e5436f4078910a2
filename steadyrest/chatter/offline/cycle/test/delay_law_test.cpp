// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/delay_law.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::units::kTurn;

/// x'' + z·x' + (1 + kw)·x = kw·x(t − τ), τ = (2π/Ω)·(1 + A·sin(2πt/T)), T = revolutions·2π/Ω.
DelayLaw::Config turning(double kw, double z, double omega, double a, double revolutions) {
  DelayLaw::Config config;
  config.damping_ratio = 0.5 * z;
  config.period_s = revolutions * kTurn / omega;
  const double period = config.period_s;
  config.terms.push_back(
      {kw, [=](double t) { return kTurn / omega * (1.0 + a * std::sin(kTurn * t / period)); }});
  return config;
}

/// Two resolutions of another program agree to 1e-10 (SOSD.jl, reference_values.csv).
TEST(DelayLaw, TurningWithTheDelayModulatedAsASine) {
  for (const double fineness : {1.0, 1.3}) {
    auto config = turning(0.2, 0.1, 0.3, 0.1, 10.0);
    config.fineness = fineness;
    const DelayLaw law = DelayLaw::make(config).value();
    EXPECT_NEAR(std::exp(law.multipliers().log_modulus[0]), 4.4761683830912320, 1e-8);
  }
}

/// A constant delay: μ = e^{λT} with λ² + z·λ + 1 + kw = kw·e^{−λτ}.
TEST(DelayLaw, ConstantDelaySolvesTheCharacteristicEquation) {
  const DelayLaw law = DelayLaw::make(turning(0.3, 0.05, 0.8, 0.0, 1.0)).value();
  const auto found = law.multipliers();
  const double tau = kTurn / 0.8;
  // The logarithm is known up to whole turns: one must fit.
  double least = 1.0;
  for (int k = -6; k <= 6; ++k) {
    // x = e^{λt} in ẍ + z·ẋ + (1 + kw)·x = kw·x(t − τ); μ belongs to T = τ.
    const std::complex<double> lambda =
        (std::log(found.value[0]) + std::complex<double>(0.0, kTurn * k)) / tau;
    least = std::min(
        least, std::abs(lambda * lambda + 0.05 * lambda + 1.3 - 0.3 * std::exp(-lambda * tau)));
  }
  EXPECT_LT(least, 1e-9);
}

/// Two cutters at unequal distances under a modulation slower than a revolution: the map of a
/// period does not depend on its resolution.
TEST(DelayLaw, TwoCuttersConverge) {
  DelayLaw::Config config;
  config.natural_rad_s = std::sqrt(14.5e6 / 11.0);
  config.damping_ratio = 0.0066;
  const double tau = 60.0 / 1000.0;
  const double omega = kTurn / tau;
  config.period_s = tau / 0.25;
  for (const double share : {0.6, 0.4}) {
    config.terms.push_back({237e3 / 11.0, [=](double t) {
                              return share * tau * (1.0 + 0.05 * std::cos(0.25 * omega * t));
                            }});
  }
  const double usual = DelayLaw::make(config)->multipliers().log_modulus[0];
  config.fineness = 1.4;
  EXPECT_NEAR(DelayLaw::make(config)->multipliers().log_modulus[0], usual, 1e-9);
}

TEST(DelayLaw, RefusesADelayThatReachesZero) {
  // A = 1 brings the delay to 0 once in each period.
  EXPECT_FALSE(DelayLaw::make(turning(0.2, 0.1, 0.3, 1.0, 10.0)).has_value());
  auto config = turning(0.2, 0.1, 0.3, 0.1, 10.0);
  config.natural_rad_s = 0.0;
  EXPECT_FALSE(DelayLaw::make(config).has_value());
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
