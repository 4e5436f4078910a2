// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/plan/test/slot_plan.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

/// Each n-th part of a normal distribution once: the mean and variance of 64 samples are nearly
/// exact.
TEST(Uncertainty, SamplesAreALatinHypercube) {
  const Uncertainty of{.frequency = 0.01, .damping = 0.2, .coefficients = 0.1, .samples = 64};
  const auto cuts = possible_cuts(kSlot, of);
  ASSERT_EQ(cuts.size(), 64U);
  double mean = 0.0;
  double square = 0.0;
  for (const Process& cut : cuts) {
    const double g = (cut.modes[0].frequency_hz / 922.0 - 1.0) / 0.01;
    mean += g / 64.0;
    square += g * g / 64.0;
    // The stiffness stays.
    EXPECT_NEAR(cut.modes[0].mass_kg * cut.modes[0].frequency_hz * cut.modes[0].frequency_hz,
                0.03993 * 922.0 * 922.0, 1e-6);
  }
  EXPECT_NEAR(mean, 0.0, 0.02);
  EXPECT_NEAR(square, 1.0, 0.1);
  EXPECT_EQ(possible_cuts(kSlot, of)[7].cut.radial_n_mm2, cuts[7].cut.radial_n_mm2);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
