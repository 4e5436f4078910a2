// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/speed_law.hpp>

namespace steadyrest::chatter::online::test {
namespace {

constexpr std::array kLaws{Law::constant, Law::square, Law::pulse, Law::triangle,
                           Law::sine,     Law::random, Law::stop};

// With a nonzero mean a law would change the average speed and with it the principal period.
TEST(SpeedLaw, HasMeanZeroAndStaysWithinOne) {
  for (const Law law : kLaws) {
    const SpeedLaw s(law, 7);
    EXPECT_NEAR(s.integral(1.0), 0.0, 1e-15);
    for (int i = 0; i < 1000; ++i) {
      EXPECT_LE(std::abs(s.at(0.001 * i)), 1.0);
    }
  }
}

TEST(SpeedLaw, ItsIntegralIsTheSumOfItsValues) {
  constexpr int kSteps = 200'000;
  for (const Law law : kLaws) {
    const SpeedLaw s(law, 3);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      sum += s.at((i + 0.5) / kSteps) / kSteps;
      if (i % 9973 == 0) {
        // The midpoint sum errs by a step at each jump: 1/200 000.
        EXPECT_NEAR(s.integral((i + 1.0) / kSteps), sum, 1e-5) << static_cast<int>(law);
      }
    }
  }
}

// Triangle from 0 up to +1 at a quarter, square +1 first: the figures that the solver is tested
// against belong to these phases.
TEST(SpeedLaw, PhasesAreThoseOfTheLiterature) {
  EXPECT_DOUBLE_EQ(SpeedLaw(Law::triangle).at(0.25), 1.0);
  EXPECT_DOUBLE_EQ(SpeedLaw(Law::triangle).at(0.75), -1.0);
  EXPECT_DOUBLE_EQ(SpeedLaw(Law::square).at(0.1), 1.0);
  EXPECT_DOUBLE_EQ(SpeedLaw(Law::square).at(0.6), -1.0);
  EXPECT_DOUBLE_EQ(SpeedLaw(Law::sine).at(0.25), 1.0);
  EXPECT_DOUBLE_EQ(SpeedLaw(Law::stop).at(0.05), -1.0);
  EXPECT_DOUBLE_EQ(SpeedLaw(Law::sine).at(-0.75), 1.0);
}

// A plan's stability holds only for the exact law it was computed for.
TEST(SpeedLaw, RandomIsTheSameForTheSameSeedAlone) {
  EXPECT_EQ(SpeedLaw(Law::random, 5).at(0.3), SpeedLaw(Law::random, 5).at(0.3));
  EXPECT_NE(SpeedLaw(Law::random, 5).at(0.3), SpeedLaw(Law::random, 6).at(0.3));
}

TEST(SpeedLaw, WordsReadBack) {
  for (const Law law :
       {Law::constant, Law::square, Law::pulse, Law::triangle, Law::sine, Law::random, Law::stop}) {
    EXPECT_EQ(law_of(name(law)), law);
  }
  EXPECT_STREQ(name(Law::stop), "stop");
  EXPECT_FALSE(law_of("Sine").has_value());
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
