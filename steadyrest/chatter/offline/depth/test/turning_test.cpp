// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::units::kTurn;

Process turning() {
  Process p;
  p.cut.operation = Operation::turning;
  p.cut.tangential_n_mm2 = 2000.0;
  p.cut.radial_n_mm2 = 1000.0;
  Mode mode;
  mode.frequency_hz = 250.0;
  mode.damping_ratio = 0.012;
  mode.mass_kg = 2.26e8 / std::pow(kTurn * 250.0, 2);
  p.modes = {mode};
  return p;
}

/// One mode: on the border 1 + a·Kr·G(iω)·(1 − e^{−iωτ}) = 0, so a = −1/(2·Kr·Re G), and each such
/// ω gives the speeds of its lobes.
TEST(Turning, BorderInClosedForm) {
  const Process p = turning();
  const Mode& mode = p.modes[0];
  const double wn = kTurn * mode.frequency_hz;
  // Turning chatters above the natural frequency, where Re G < 0; it is most negative at 1 + ζ.
  for (const double ratio : {1.005, 1.0120, 1.02, 1.04, 1.08}) {
    const double w = ratio * wn;
    const std::complex<double> g =
        1000.0 / mode.mass_kg /
        std::complex<double>(wn * wn - w * w, 2.0 * mode.damping_ratio * wn * w);
    const double want = -1.0 / (2.0 * p.cut.radial_n_mm2 * g.real());
    for (const double waves : {0.0, 1.0, 3.0}) {
      const double phase = std::numbers::pi + 2.0 * std::atan(g.imag() / g.real());
      double angle = std::fmod(phase, kTurn) + kTurn;  // (0, 4π)
      angle = std::fmod(angle, kTurn) + kTurn * waves;
      // 1 + a·Kr·G·(1 − e^{−iωτ}) = 0 tells which of the two signs of the phase it is.
      const auto off = [&](double a) {
        return std::abs(1.0 + want * p.cut.radial_n_mm2 * g * (1.0 - std::polar(1.0, -a)));
      };
      const double other = kTurn * (2.0 * waves + 1.0) - angle;
      const double fits = off(angle) < off(other) ? angle : other;
      ASSERT_LT(off(fits), 1e-12);
      const double speed = w / fits;
      DelayCycle::Config config;
      config.speed_rev_s = speed;
      config.most_depth_mm = want;
      DelayCycle cycle = DelayCycle::make(p, config).value();
      cycle.set_depth(want);
      // At large depths a lower lobe may lead; this point is then already unstable.
      const double log_radius = stability(cycle, {}).log_radius;
      EXPECT_GT(log_radius, -1e-9) << ratio << " " << waves;
      const auto limit = limit_depth_mm(p, speed, {}, 2.0 * want).value();
      ASSERT_TRUE(limit.has_value());
      EXPECT_LT(*limit, want * (1.0 + 1e-8));
      if (log_radius < 1e-9) {
        EXPECT_NEAR(*limit, want, 1e-8 * want) << ratio << " " << waves;
      }
    }
  }
}

/// A mode at the angle α from x (into the work) towards y (the way the tool cuts; the work's
/// surface comes against it): the forces (−Kr, −Kt)·a·Δx excite it by Kr·cos α + Kt·sin α, and it
/// moves the tool along x by cos α. Tlusty's oriented response: b_lim = −1/(2·Re G_o), G_o = cos
/// α·(Kr·cos α + Kt·sin α)·G. Where the product is negative, chatter occurs below the natural
/// frequency.
TEST(Turning, AnObliqueModeHasTheOrientedResponse) {
  std::size_t on_the_border = 0;
  for (const double alpha_deg : {30.0, 80.0, 135.0, -60.0, -20.0, 210.0}) {
    Process p = turning();
    const double alpha = alpha_deg / 360.0 * kTurn;
    Mode& mode = p.modes[0];
    mode.shape = {std::cos(alpha), std::sin(alpha)};
    const double wn = kTurn * mode.frequency_hz;
    const double oriented_n_mm2 = mode.shape[0] * (p.cut.radial_n_mm2 * mode.shape[0] +
                                                   p.cut.tangential_n_mm2 * mode.shape[1]);
    for (const double off : {0.008, 0.012, 0.02, 0.05}) {
      const double w = wn * (oriented_n_mm2 > 0.0 ? 1.0 + off : 1.0 - off);
      const std::complex<double> g =
          oriented_n_mm2 * 1000.0 / mode.mass_kg /
          std::complex<double>(wn * wn - w * w, 2.0 * mode.damping_ratio * wn * w);
      const double want = -1.0 / (2.0 * g.real());
      ASSERT_GT(want, 0.0) << alpha_deg;
      // 1 + b·G_o·(1 − e^{−iε}) = 0 gives ε, and n = (ω/2π)/(k + ε/2π).
      const double phase = -std::arg(1.0 + 1.0 / (want * g));
      const double turns = phase / kTurn - std::floor(phase / kTurn);
      for (const double waves : {1.0, 3.0, 6.0}) {
        const double speed = w / kTurn / (waves + turns);
        const auto limit = limit_depth_mm(p, speed, {}, 2.0 * want).value();
        ASSERT_TRUE(limit.has_value()) << alpha_deg << " " << off << " " << waves;
        // A neighbouring lobe may lie lower there.
        EXPECT_LT(*limit, want * (1.0 + 1e-8)) << alpha_deg << " " << off << " " << waves;
        on_the_border += std::abs(*limit - want) < 1e-7 * want ? 1U : 0U;
      }
    }
  }
  EXPECT_GE(on_the_border, 36U);  // of 72
}

/// No speed is worse than −1/(2·Kr·min Re G) = 2ζ(1 + ζ)·k/Kr, and some are nearly as bad.
TEST(Turning, TheWorstSpeedHasTheAbsoluteLimit) {
  const Process p = turning();
  const double k = 2.26e8 / 1000.0;
  const double z = p.modes[0].damping_ratio;
  const double want = 2.0 * k * z * (1.0 + z) / p.cut.radial_n_mm2;
  double least = 1e9;
  for (double rpm = 3000.0; rpm < 4200.0; rpm += 20.0) {
    least = std::min(least, limit_depth_mm(p, rpm / 60.0, {}, 60.0).value().value_or(1e9));
  }
  EXPECT_GE(least, want * (1.0 - 1e-9));
  EXPECT_LE(least, want * 1.01);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
