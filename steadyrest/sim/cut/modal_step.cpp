// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <steadyrest/sim/base/portable.hpp>
#include <steadyrest/sim/cut/modal_step.hpp>

namespace steadyrest::sim {

// q̈ + 2ζω·q̇ + ω²·q = g with g = F·φ/m linear within the step. Rows of the transition: free
// motion, and the response to g at the step's start and at its end.
ModalStep modal_step(const CuttingMode& mode, double period_s) noexcept {
  const double w = 2.0 * std::numbers::pi * mode.frequency_hz;
  const double damping = mode.damping_ratio * w;
  const double root = std::sqrt(1.0 - mode.damping_ratio * mode.damping_ratio);
  const double damped = w * root;
  const double turns = mode.frequency_hz * root * period_s;
  const double fall = portable::exp(-damping * period_s);
  const double c = fall * portable::sin_turn(turns + 0.25);
  const double s = fall * portable::sin_turn(turns) / damped;
  ModalStep out;
  // Free vibration over the period: exact, so the step need not be short compared with it.
  out.position.q = c + damping * s;
  out.position.v = s;
  out.velocity.q = -w * w * s;
  out.velocity.v = c - damping * s;
  // Particular solution of a ramp: q = α + β·t, β = (g₁ − g₀)/(ω²·T), α = g₀/ω² − 2ζβ/ω.
  const double w2 = w * w;
  const double alpha1 = -2.0 * mode.damping_ratio / (w2 * w * period_s);
  const double beta1 = 1.0 / (w2 * period_s);
  const double alpha0 = 1.0 / w2 - alpha1;
  const double beta0 = -beta1;
  const auto share = [](const ModalStep::Row& row, double alpha, double beta) {
    return -row.q * alpha - row.v * beta;
  };
  out.position.g0 = alpha0 + beta0 * period_s + share(out.position, alpha0, beta0);
  out.position.g1 = alpha1 + beta1 * period_s + share(out.position, alpha1, beta1);
  out.velocity.g0 = beta0 + share(out.velocity, alpha0, beta0);
  out.velocity.g1 = beta1 + share(out.velocity, alpha1, beta1);
  return out;
}

}  // namespace steadyrest::sim
