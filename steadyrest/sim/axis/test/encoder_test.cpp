// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/sim/axis/encoder.hpp>

namespace steadyrest::sim {
namespace {

kernel::machine::Encoder scale(double count_mm, double line_error_mm = 0.0,
                               double line_period_mm = 0.004) {
  kernel::machine::Encoder out;
  out.count_au = count_mm;
  out.line_error_au = line_error_mm;
  out.line_period_au = line_period_mm;
  return out;
}

TEST(Encoder, ReadsWholeCountsWithinHalfACount) {
  const auto encoder = Encoder::make(scale(0.002));
  ASSERT_TRUE(encoder);
  for (double x = -1.0; x < 1.0; x += 0.000137) {
    const double y = encoder->read(x);
    ASSERT_LE(std::abs(y - x), 0.001 + 1e-12);
    ASSERT_NEAR(y / 0.002, std::round(y / 0.002), 1e-9);
  }
}

TEST(Encoder, LineErrorRepeatsWithEachLineAndHasItsAmplitude) {
  const auto encoder = Encoder::make(scale(0.0, 0.0003));
  ASSERT_TRUE(encoder);
  double largest = 0.0;
  for (double x = 0.0; x < 0.02; x += 0.00001) {
    const double error = encoder->read(x) - x;
    ASSERT_NEAR(error, 0.0003 * std::sin(2.0 * std::numbers::pi * x / 0.004), 1e-12);
    largest = std::max(largest, std::abs(error));
  }
  EXPECT_NEAR(largest, 0.0003, 1e-9);
}

TEST(Encoder, IdealEncoderReadsTheTruth) {
  const auto encoder = Encoder::make(scale(0.0));
  ASSERT_TRUE(encoder);
  EXPECT_EQ(encoder->read(1.23456789), 1.23456789);
}

// Slope of the reading: 1 + 2π·A/p·cos ≥ 0 while A < p/2π = 0.64 µm at a line of 4 µm.
TEST(Encoder, ReadingNeverFallsWhilePositionRises) {
  EXPECT_TRUE(rc::check("monotone for a line error below 1/(2π) of the line", [] {
    const auto encoder = Encoder::make(scale(0.001, 0.0006));
    const double x = *rc::gen::inRange(-1000000, 1000000) * 1e-5;
    const double dx = *rc::gen::inRange(0, 1000) * 1e-6;
    RC_ASSERT(encoder->read(x + dx) >= encoder->read(x));
  }));
}

TEST(Encoder, RefusesWhatNoEncoderHas) {
  EXPECT_FALSE(Encoder::make(scale(-0.001)));
  EXPECT_FALSE(Encoder::make(scale(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(Encoder::make(scale(0.001, -1.0)));
  EXPECT_FALSE(Encoder::make(scale(0.001, 0.001, 0.0)));
}

}  // namespace
}  // namespace steadyrest::sim
