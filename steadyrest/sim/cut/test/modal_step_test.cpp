// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/sim/cut/modal_step.hpp>

namespace steadyrest::sim {
namespace {

struct State {
  double q = 0.0;
  double v = 0.0;
};

State advance(const ModalStep& step, const State& s, double g0, double g1) {
  return {
      step.position.q * s.q + step.position.v * s.v + step.position.g0 * g0 + step.position.g1 * g1,
      step.velocity.q * s.q + step.velocity.v * s.v + step.velocity.g0 * g0 +
          step.velocity.g1 * g1};
}

const CuttingMode kMode{.frequency_hz = 922.0, .damping_ratio = 0.011, .mass_kg = 0.04};
const double kRate = 2.0 * std::numbers::pi * 922.0;

// Closed form of the free damped vibration; 4 ms are more than three vibrations in one step.
TEST(ModalStep, RingsDownAsTheClosedFormSaysAtAnyStep) {
  const double root = std::sqrt(1.0 - 0.011 * 0.011);
  for (const double period_s : {1e-6, 2.7e-5, 4e-3}) {
    const ModalStep step = modal_step(kMode, period_s);
    State s{.q = 1.0, .v = 0.0};
    for (int i = 1; i <= 100; ++i) {
      s = advance(step, s, 0.0, 0.0);
      const double phase = kRate * root * period_s * i;
      const double truth = std::exp(-0.011 * kRate * period_s * i) *
                           (std::cos(phase) + 0.011 / root * std::sin(phase));
      ASSERT_NEAR(s.q, truth, 1e-11);
    }
  }
}

TEST(ModalStep, RestsWhereAConstantForceHoldsIt) {
  const double force = 5000.0;
  const State rest{.q = force / (kRate * kRate), .v = 0.0};
  const State s = advance(modal_step(kMode, 1.3e-4), rest, force, force);
  EXPECT_NEAR(s.q, rest.q, 1e-12 * rest.q);
  EXPECT_NEAR(s.v, 0.0, 1e-9 * rest.q * kRate);
}

// The response to a ramp is exact in one step: a thousand steps of the same ramp must agree.
TEST(ModalStep, ARampInOneStepIsARampInAThousand) {
  const double period_s = 1e-3;
  const State once = advance(modal_step(kMode, period_s), {.q = 0.1, .v = 3.0}, 100.0, 900.0);
  const ModalStep fine = modal_step(kMode, period_s / 1000.0);
  State s{.q = 0.1, .v = 3.0};
  for (int i = 0; i < 1000; ++i) {
    s = advance(fine, s, 100.0 + 0.8 * i, 100.0 + 0.8 * (i + 1));
  }
  EXPECT_NEAR(once.q, s.q, 1e-10);
  EXPECT_NEAR(once.v, s.v, 1e-6);
}

}  // namespace
}  // namespace steadyrest::sim
