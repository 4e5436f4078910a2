// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/estimate/reserve.hpp>

namespace steadyrest::contour::online {
namespace {

constexpr double kCycleS = 0.004;

Reserve::Config ten_micrometres() {
  return {.limit_mm = 0.010, .margin = 0.05};
}

/// Ten seconds in which the excess is drawn from N(mean, sigma).
Reserve learnt(const Reserve::Config& config, double mean_mm, double sigma_mm,
               double modelled_mm = 0.007) {
  Reserve reserve(config);
  std::mt19937 engine(7);
  std::normal_distribution<double> excess(mean_mm, sigma_mm);
  for (int i = 0; i < 2500; ++i) {
    reserve.update({.seen_mm = std::abs(modelled_mm + excess(engine)),
                    .modelled_mm = modelled_mm,
                    .step_s = kCycleS});
  }
  return reserve;
}

TEST(Reserve, IsNothingBeforeAnythingIsSeen) {
  EXPECT_DOUBLE_EQ(Reserve(ten_micrometres()).limit_mm(), 0.0095);
}

// 3σ = 1.2 µm, less the margin's 0.5 µm, leaves 8.8 µm. A mean square over a second of 4 ms is off
// by √(2/500)·½ ≈ 3 %, 0.04 µm; three of those.
TEST(Reserve, IsThreeSigmasOfANormalExcessBeyondTheMargin) {
  EXPECT_NEAR(learnt(ten_micrometres(), 0.0, 0.0004).limit_mm(), 0.0088, 0.00012);
}

TEST(Reserve, WithinTheMarginCostsNothing) {
  EXPECT_DOUBLE_EQ(learnt(ten_micrometres(), 0.0, 0.0001).limit_mm(), 0.0095);
}

// A quadrant glitch outwards on a circle that comes out too small: 2 µm off the error.
TEST(Reserve, WhatMakesTheErrorSmallerIsNoRisk) {
  EXPECT_DOUBLE_EQ(learnt(ten_micrometres(), -0.002, 0.0).limit_mm(), 0.0095);
}

// 0.5 µm beside a command on a straight line: far from the limit, and no sign of what it would be
// near it.
TEST(Reserve, WhereTheErrorIsFarFromTheLimitNothingIsLearnt) {
  EXPECT_DOUBLE_EQ(learnt(ten_micrometres(), 0.0005, 0.0, 0.001).limit_mm(), 0.0095);
  // … but 5 µm that nothing explains counts wherever it shows up: all that the reserve may take.
  EXPECT_DOUBLE_EQ(learnt(ten_micrometres(), 0.005, 0.0, 0.0).limit_mm(), 0.0095 - 0.006);
}

// Offsets keep the modelled error small at full feed; what the model misses is all there is to see.
TEST(Reserve, WhereOffsetsCancelTheErrorAllOfItCounts) {
  Reserve reserve(ten_micrometres());
  for (int i = 0; i < 2500; ++i) {
    reserve.update(
        {.seen_mm = 0.0015, .modelled_mm = 0.0005, .step_s = kCycleS, .cancelled = true});
  }
  // 3·√2·1 µm less the margin's 0.5 µm.
  EXPECT_NEAR(reserve.limit_mm(), 0.0095 - (3.0 * std::sqrt(2.0) * 0.001 - 0.0005), 1e-6);
}

// Counts of 1 µm read with an error of 1/√12 µm: that much is the encoder, not the machine.
TEST(Reserve, DoesNotPayForTheEncodersCounts) {
  Reserve::Config config = ten_micrometres();
  config.count_mm = 0.001;
  EXPECT_DOUBLE_EQ(learnt(config, 0.0, 0.00027).limit_mm(), 0.0095);
  EXPECT_LT(learnt(ten_micrometres(), 0.0, 0.00027).limit_mm(), 0.0093);
}

// b/2 = 5 µm, of which 2 µm are in doubt: alone they exceed the margin by 1.5 µm, and with 3σ =
// 1.5 µm, √(2² + 1.5²) = 2.5 µm, by 2 µm.
TEST(Reserve, DoubtsOfTheBacklashAndTheModelAddAsIndependentErrors) {
  Reserve::Config config = ten_micrometres();
  config.half_backlash_mm = 0.005;
  EXPECT_NEAR(Reserve(config).limit_mm(), 0.0080, 1e-12);
  EXPECT_NEAR(learnt(config, 0.0, 0.0005).limit_mm(), 0.0075, 0.0001);
}

TEST(Reserve, ForgetsWithItsMemoryAndAtOnceWithAnotherModel) {
  Reserve reserve = learnt(ten_micrometres(), 0.001, 0.0);
  const double before_mm2 = reserve.state().excess_mm2;
  for (int i = 0; i < 250; ++i) {
    reserve.update({.seen_mm = 0.007, .modelled_mm = 0.007, .step_s = kCycleS});
  }
  EXPECT_NEAR(reserve.state().excess_mm2, before_mm2 * std::exp(-1.0), 0.01 * before_mm2);
  reserve.forget();
  EXPECT_DOUBLE_EQ(reserve.limit_mm(), 0.0095);
}

TEST(Reserve, ARestoredStateGoesOnAndANonsensicalOneStartsOver) {
  const Reserve learned = learnt(ten_micrometres(), 0.001, 0.0);
  Reserve other(ten_micrometres());
  other.restore(learned.state());
  EXPECT_EQ(other.limit_mm(), learned.limit_mm());
  other.restore({.excess_mm2 = std::numeric_limits<double>::quiet_NaN()});
  EXPECT_DOUBLE_EQ(other.limit_mm(), 0.0095);
}

}  // namespace
}  // namespace steadyrest::contour::online
