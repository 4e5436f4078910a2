// SPDX-License-Identifier: Apache-2.0
// Axes of an integrator that shares nothing with the fit's exact steps.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_proposal.hpp>

namespace steadyrest::contour::offline {
namespace {

struct LaggingAxis {
  double gain_1_s = 20.0;
  double feed_forward = 0.0;
  double lag_s = 0.015;
  double delay_s = 0.0;
  double mode_weight = 0.0;  ///< of 40 Hz, damping 5 %
};

/// Lines there and back at three speeds, 1000 mm/s²; then a circle's coordinate.
std::vector<double> servo_test_mm() {
  constexpr double kMost_mm_s2 = 1000.0;
  std::vector<double> out(300, 0.0);
  for (const double speed : {10.0, 50.0, 25.0}) {
    for (const double sign : {1.0, -1.0}) {
      const double from = out.back();
      const double ramp_s = speed / kMost_mm_s2;
      const double end_s = 10.0 / speed + ramp_s;
      for (double t = 0.0; t < end_s + 0.001; t += 0.001) {
        const double rest = std::max(0.0, end_s - t);
        out.push_back(from + sign * (t < ramp_s      ? 0.5 * kMost_mm_s2 * t * t
                                     : rest > ramp_s ? speed * (t - 0.5 * ramp_s)
                                                     : 10.0 - 0.5 * kMost_mm_s2 * rest * rest));
      }
    }
  }
  const double from = out.back();
  for (int n = 0; n < 1256; ++n) {
    out.push_back(from + 5.0 * (1.0 - std::cos(0.005 * n)));
  }
  out.resize(out.size() + 300, out.back());
  return out;
}

/// Fiftieths of a cycle by the midpoint rule; noise of 1 µm.
ServoLog recorded(const LaggingAxis& axis, unsigned seed) {
  constexpr double kStep_s = 2e-5;
  constexpr double kMode_rad_s = 2.0 * 3.14159265358979 * 40.0;
  ServoLog out;
  out.command = servo_test_mm();
  const auto command = [&](double t) {
    const double at = std::clamp(t / 0.001, 0.0, static_cast<double>(out.command.size() - 1));
    const auto n = std::min(static_cast<std::size_t>(at), out.command.size() - 2);
    return std::lerp(out.command[n], out.command[n + 1], at - static_cast<double>(n));
  };
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.001);
  double x = 0.0;
  double v = 0.0;
  double hung = 0.0;
  double hung_speed = 0.0;
  for (std::size_t n = 0; n < out.command.size(); ++n) {
    out.time_s.push_back(0.001 * static_cast<double>(n));
    out.actual.push_back(x + axis.mode_weight * hung + noise(random));
    for (int i = 0; i < 50; ++i) {
      const double t = out.time_s.back() + i * kStep_s - axis.delay_s;
      const double asked = axis.feed_forward * (command(t + kStep_s) - command(t)) / kStep_s +
                           axis.gain_1_s * (command(t + 0.5 * kStep_s) - x - 0.5 * kStep_s * v);
      const double a = (asked - v) / (axis.lag_s + 0.5 * kStep_s);
      const double pull = -a - 0.1 * kMode_rad_s * hung_speed - kMode_rad_s * kMode_rad_s * hung;
      x += kStep_s * (v + 0.5 * kStep_s * a);
      v += kStep_s * a;
      hung_speed += kStep_s * pull;
      hung += kStep_s * hung_speed;
    }
  }
  return out;
}

kernel::machine::Axis mill_axis() {
  kernel::machine::Axis out;
  out.max_speed_au_s = 200.0;
  out.encoder.count_au = 0.0;
  return out;
}

ServoFit fit_of(const LaggingAxis& axis, unsigned seed) {
  const auto fits = fit_servos({recorded(axis, seed)}, {mill_axis()});
  EXPECT_TRUE(fits) << fits.error().what;
  return fits ? fits->axes[0] : ServoFit{};
}

TEST(ServoLagFit, FindsGainAndLagWithAndWithoutAMode) {
  unsigned seed = 1;
  for (const LaggingAxis& axis :
       {LaggingAxis{}, LaggingAxis{.gain_1_s = 40.0, .feed_forward = 0.6, .lag_s = 0.005},
        LaggingAxis{.mode_weight = 0.3},
        LaggingAxis{.feed_forward = 0.3, .lag_s = 0.02, .delay_s = 0.0023}}) {
    const ServoFit fit = fit_of(axis, seed++);
    EXPECT_NEAR(fit.gain_1_s, axis.gain_1_s, 0.02 * axis.gain_1_s) << seed;
    EXPECT_NEAR(fit.gain_1_s, axis.gain_1_s, 3.0 * fit.gain_sd_1_s + 0.001 * axis.gain_1_s);
    EXPECT_NEAR(fit.lag_s, axis.lag_s, 0.001);
    if (axis.mode_weight == 0.0) {
      EXPECT_NEAR(fit.delay_s, axis.delay_s, 0.001);
    }
    // The mode passes for 3 ms of delay and as much feed-forward: only their sum is determined.
    EXPECT_NEAR(fit.delay_s + (1.0 - fit.feed_forward) / fit.gain_1_s,
                axis.delay_s + (1.0 - axis.feed_forward) / axis.gain_1_s, 1e-4)
        << seed;
    EXPECT_LT(fit.rms, 0.0012);
    EXPECT_GT(fit.rms, 0.0009);
    EXPECT_LE(fit.least_lag_s, fit.lag_s);
    EXPECT_GE(fit.most_lag_s, fit.lag_s);
  }
}

// The circle's error in closed form, ε = R·(1 − |G|): FF2 takes it away, MD32810 leaves 1/(1 + τs).
TEST(ServoProposal, TakesTheErrorAwayAsFarAsTheLawAllows) {
  ServoFit fit{.axis = "X",
               .gain_1_s = 20.0,
               .gain_sd_1_s = 0.02,
               .feed_forward = 0.0,
               .feed_forward_sd = 0.001,
               .lag_s = 0.015,
               .lag_sd_s = 0.0001,
               .least_lag_s = 0.0148,
               .most_lag_s = 0.0152,
               .rms = 0.001};
  kernel::machine::Axis axis = mill_axis();
  axis.max_acceleration_au_s2 = 2000.0;
  const auto mill = propose(fit, axis, kernel::machine::Dialect::linuxcnc);
  ASSERT_TRUE(mill);
  ASSERT_EQ(mill->settings.size(), 2U);  // k·τ is 0.3 already: no P
  EXPECT_EQ(mill->settings[0].parameter, "FF1");
  EXPECT_EQ(mill->settings[0].value, 1.0);
  EXPECT_EQ(mill->settings[1].parameter, "FF2");
  EXPECT_EQ(mill->settings[1].value, 0.015);
  EXPECT_NEAR(mill->after.radius_error, 0.0, 1e-9);
  const double w = std::sqrt(2000.0 * 10.0) / 10.0;
  EXPECT_NEAR(mill->before.radius_error, 10.0 * (1.0 - 20.0 / std::hypot(20.0 - 0.015 * w * w, w)),
              1e-9);
  const auto vmc = propose(fit, axis, kernel::machine::Dialect::sinumerik);
  ASSERT_TRUE(vmc);
  EXPECT_NEAR(vmc->after.radius_error, 10.0 * (1.0 - 1.0 / std::hypot(1.0, 0.015 * w)), 1e-9);
  fit.lag_s = fit.least_lag_s = 0.005;
  fit.most_lag_s = 0.00625;
  const auto stiff = propose(fit, axis, kernel::machine::Dialect::linuxcnc);
  ASSERT_TRUE(stiff);
  EXPECT_EQ(stiff->settings.back().parameter, "P");
  EXPECT_NEAR(stiff->settings.back().value, 40.0, 1e-9);  // ¼ of the longest lag allowed
  fit.mode_hz = 40.0;
  EXPECT_EQ(propose(fit, axis, kernel::machine::Dialect::linuxcnc)->settings.size(), 1U);
}

TEST(ServoProposal, IsNotMadeWithinTheUncertainty) {
  ServoFit fit{.axis = "X",
               .gain_1_s = 50.0,
               .gain_sd_1_s = 10.0,
               .feed_forward = 0.98,
               .feed_forward_sd = 0.05,
               .rms = 0.001};
  EXPECT_FALSE(propose(fit, mill_axis(), kernel::machine::Dialect::linuxcnc));
  EXPECT_FALSE(propose(fit, mill_axis(), kernel::machine::Dialect::fanuc));
}

}  // namespace
}  // namespace steadyrest::contour::offline
