// SPDX-License-Identifier: Apache-2.0
// One servo's step against the matrix exponential of its equation, in complex numbers.
#include <array>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/forecast.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

using math::geometry::test::number;
using Complex = std::complex<double>;

/// ∫₀ʰ e^λ(h−t) dt and ∫₀ʰ e^λ(h−t)·(t/h − ½) dt.
struct Response {
  Complex mean;
  Complex change;
};

Response response(Complex lambda, double h) {
  const Complex z = lambda * h;
  const Complex grown = std::exp(z) - 1.0;
  return {.mean = grown / lambda, .change = (grown - z) / (lambda * z) - 0.5 * grown / lambda};
}

/// ė = ċ − w, ẇ = (k·e − w + a·ċ)/τ by its two eigenvalues: λ² + λ/τ + k/τ = 0. To the eigenvalue
/// λ belongs the left eigenvector (k/τ, λ), as (e, w)ᵀ ↦ k/τ·e + λ·w grows by λ alone.
AxisStep by_eigenvalues(const AxisModel& model, double h) {
  const double p = 1.0 / model.velocity_lag_s;
  const double q = model.gain_1_s * p;
  const Complex root = std::sqrt(Complex(p * p - 4.0 * q, 0.0));
  const std::array lambda = {0.5 * (-p + root), 0.5 * (-p - root)};
  // Of the coordinates y_i = q·e + λ_i·w: e = (λ₂y₁ − λ₁y₂)/(q(λ₂ − λ₁)), w = (y₂ − y₁)/(λ₂ − λ₁).
  const auto back = [&](const std::array<Complex, 2>& y) {
    const Complex apart = lambda[1] - lambda[0];
    return std::array{((lambda[1] * y[0] - lambda[0] * y[1]) / (q * apart)).real(),
                      ((y[1] - y[0]) / apart).real()};
  };
  const auto start = [&](double e, double w) {
    std::array<Complex, 2> y;
    for (std::size_t i = 0; i < 2; ++i) {
      y[i] = std::exp(lambda[i] * h) * (q * e + lambda[i] * w);
    }
    return back(y);
  };
  const auto forced = [&](bool mean) {
    std::array<Complex, 2> y;
    for (std::size_t i = 0; i < 2; ++i) {
      const Response r = response(lambda[i], h);
      y[i] = (q + lambda[i] * model.feed_forward * p) * (mean ? r.mean : r.change);
    }
    return back(y);
  };
  return {.ee = start(1, 0)[0],
          .ew = start(0, 1)[0],
          .we = start(1, 0)[1],
          .ww = start(0, 1)[1],
          .e_mean = forced(true)[0],
          .w_mean = forced(true)[1],
          .e_change = forced(false)[0],
          .w_change = forced(false)[1]};
}

// The lags lie on both sides of 1/(4k), where the roots turn from real to complex. k·h stays below
// 1/5: the largest entry of the matrix is 1.
RC_GTEST_PROP(AxisStepWithLag, IsTheMatrixExponentialForRealAndForComplexRoots, ()) {
  const double k = *number(20.0, 100.0);
  const double tau = *rc::gen::element(0.05, 0.6, 0.9, 1.1, 2.0, 6.0) / (4.0 * k);
  const AxisModel model{k, *number(0.0, 1.0), tau};
  const double h = *number(5e-4, 2e-3);
  const AxisStep step = AxisStep::of(model, h);
  const AxisStep truth = by_eigenvalues(model, h);
  RC_ASSERT(std::abs(step.ee - truth.ee) <= 1e-6);
  RC_ASSERT(std::abs(step.ew - truth.ew) <= 1e-6 * h);
  RC_ASSERT(std::abs(step.we - truth.we) <= 1e-6 * k);
  RC_ASSERT(std::abs(step.ww - truth.ww) <= 1e-6);
  RC_ASSERT(std::abs(step.e_mean - truth.e_mean) <= 1e-6 * h);
  RC_ASSERT(std::abs(step.w_mean - truth.w_mean) <= 1e-6);
  RC_ASSERT(std::abs(step.e_change - truth.e_change) <= 1e-6 * h);
  RC_ASSERT(std::abs(step.w_change - truth.w_change) <= 1e-6);
}

// Without lag e(h) has a closed form for a command that moves by p·t² as well:
//   ė = (1 − a)·ċ − k·e ⇒ e = (1 − a)·(v/k − (1 − k·t)·…), here by the same two integrals with −k.
RC_GTEST_PROP(AxisStepWithoutLag, IsTheExponentialOfOneRoot, ()) {
  const AxisModel model{*number(10.0, 200.0), *number(0.0, 1.0), 0.0};
  const double h = *number(2e-4, 4e-3);
  const AxisStep step = AxisStep::of(model, h);
  const Response r = response(-model.gain_1_s, h);
  const double share = 1.0 - model.feed_forward;
  RC_ASSERT(std::abs(step.ee - std::exp(-model.gain_1_s * h)) <= 1e-14);
  RC_ASSERT(std::abs(step.e_mean - share * r.mean.real()) <= 1e-12 * h);
  RC_ASSERT(std::abs(step.e_change - share * r.change.real()) <= 1e-9 * h);
  RC_ASSERT(step.ew == 0.0);
}

// At constant speed the following error is (1 − a)·v/k, whatever the velocity loop's lag: its ẋ
// is v and its ẍ is 0.
RC_GTEST_PROP(AxisStep, OfAConstantSpeedEndsAtTheTextbooksFollowingError, ()) {
  const double k = *number(20.0, 100.0);
  const AxisModel model{k, *number(0.0, 0.9), *rc::gen::element(0.0, 0.002, 0.01)};
  const AxisStep step = AxisStep::of(model, 0.1 / k);
  double e = 0.0;
  double w = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double e1 = step.ee * e + step.ew * w + step.e_mean * 30.0;
    w = step.we * e + step.ww * w + step.w_mean * 30.0;
    e = e1;
  }
  RC_ASSERT(std::abs(e - (1.0 - model.feed_forward) * 30.0 / k) <= 1e-5);
  RC_ASSERT(model.velocity_lag_s == 0.0 || std::abs(w - 30.0) <= 1e-4);
}

}  // namespace
}  // namespace steadyrest::contour::online
