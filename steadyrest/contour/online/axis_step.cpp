// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/contour/online/axis_step.hpp>

namespace steadyrest::contour::online {
namespace {

// A velocity loop faster than this is none: on a circle it changes ε by 2kτ, 1 % at k = 50 1/s. At
// τ = 0.1 ms kSub steps of 4 ms/64 are 0.6·τ long, well inside of where Runge and Kutta's are
// stable (2.8·τ). Test AxisStep, OfNoLagIsTheLimitOfSmallLag.
constexpr double kNoLag_s = 1e-4;

}  // namespace

AxisStep AxisStep::of(const AxisModel& model, double h_s) noexcept {
  AxisStep step;
  const double k = model.gain_1_s;
  const double a = model.feed_forward;
  // Without lag: ė = (1 − a)·ċ − k·e. φ₁ = ∫e^−k(h−t)dt, φ₂ the same with t/h; ċ's slope enters by
  // t/h − ½.
  if (model.velocity_lag_s < kNoLag_s) {
    const double decay = std::exp(-k * h_s);
    const double phi1 = -std::expm1(-k * h_s) / k;
    const double phi2 = (1.0 - phi1 / h_s) / k;
    step.ee = decay;
    step.e_mean = (1.0 - a) * phi1;
    step.e_change = (1.0 - a) * (phi2 - 0.5 * phi1);
    return step;
  }
  // With lag the roots may be real, double or complex. Unit responses by Runge–Kutta of fourth
  // order serve all three alike; the step is linear, so four of them are the whole matrix. Not in
  // the cycle but when the model changes.
  constexpr int kSub = 64;
  const double d = h_s / kSub;
  const double tau = model.velocity_lag_s;
  const auto shoot = [&](double e, double w, double mean, double change) {
    const auto rate = [&](double t, double ei, double wi) {
      const double c = mean + change * (t / h_s - 0.5);
      return std::array{c - wi, (k * ei + a * c - wi) / tau};
    };
    for (int i = 0; i < kSub; ++i) {
      const double t = d * i;
      const auto r1 = rate(t, e, w);
      const auto r2 = rate(t + 0.5 * d, e + 0.5 * d * r1[0], w + 0.5 * d * r1[1]);
      const auto r3 = rate(t + 0.5 * d, e + 0.5 * d * r2[0], w + 0.5 * d * r2[1]);
      const auto r4 = rate(t + d, e + d * r3[0], w + d * r3[1]);
      e += d / 6.0 * (r1[0] + 2.0 * r2[0] + 2.0 * r3[0] + r4[0]);
      w += d / 6.0 * (r1[1] + 2.0 * r2[1] + 2.0 * r3[1] + r4[1]);
    }
    return std::array{e, w};
  };
  const auto from_e = shoot(1, 0, 0, 0);
  const auto from_w = shoot(0, 1, 0, 0);
  const auto from_mean = shoot(0, 0, 1, 0);
  const auto from_change = shoot(0, 0, 0, 1);
  step.ee = from_e[0];
  step.we = from_e[1];
  step.ew = from_w[0];
  step.ww = from_w[1];
  step.e_mean = from_mean[0];
  step.w_mean = from_mean[1];
  step.e_change = from_change[0];
  step.w_change = from_change[1];
  return step;
}

}  // namespace steadyrest::contour::online
