// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/sim/base/portable.hpp>

namespace steadyrest::sim {
namespace {

// The platform's library is the oracle, good to half a unit in the last place; ten units are
// allowed, since identical bits everywhere are what counts here.
TEST(Portable, ExponentialAgreesWithTheLibrary) {
  for (double x = -690.0; x < 690.0; x += 0.3713) {
    const double truth = std::exp(x);
    ASSERT_NEAR(portable::exp(x) / truth, 1.0, 2e-15) << x;
  }
  EXPECT_EQ(portable::exp(0.0), 1.0);
  EXPECT_EQ(portable::exp(-1e9), 0.0);
}

// 600 decades in steps of 1.737: every exponent and all parts of the mantissa.
TEST(Portable, LogarithmAgreesWithTheLibrary) {
  for (double x = 1e-300; x < 1e300; x *= 1.737) {
    const double truth = std::log(x);
    ASSERT_NEAR(portable::log(x), truth, 2e-15 * std::max(1.0, std::abs(truth))) << x;
  }
  EXPECT_EQ(portable::log(1.0), 0.0);
}

// Whole turns must be exact zeros, or an axis at rest would creep.
TEST(Portable, SineAgreesWithTheLibrary) {
  for (double turns = -3.0; turns < 3.0; turns += 0.000731) {
    ASSERT_NEAR(portable::sin_turn(turns), std::sin(2.0 * std::numbers::pi * turns), 4e-15)
        << turns;
  }
  EXPECT_EQ(portable::sin_turn(1e6), 0.0);
  EXPECT_NEAR(portable::sin_turn(0.25), 1.0, 1e-15);
}

}  // namespace
}  // namespace steadyrest::sim
