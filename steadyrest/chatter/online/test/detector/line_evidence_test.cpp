// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/line_evidence.hpp>

namespace steadyrest::chatter::online::test {
namespace {

Detector::Output line_off(double off_hz, double sd_hz) {
  Detector::Output out;
  out.kind = Detector::Kind::hopf;
  out.line = {.order = 15.0, .frequency_hz = 1234.0, .off_hz = off_hz, .sd_hz = sd_hz};
  return out;
}

TEST(LineConfidence, OfManySpectraIsTheNormalLaws) {
  // Within one, two and three standard deviations: 0.6827, 0.9545, 0.9973.
  const std::array<double, 3> share = {0.682689, 0.954500, 0.997300};
  for (std::size_t sds = 1; sds <= 3; ++sds) {
    for (const double side : {-1.0, 1.0}) {
      LineConfidence confidence;
      for (int i = 0; i < 40; ++i) {
        confidence.add(line_off(side * 0.6 * static_cast<double>(sds), 0.6));
      }
      EXPECT_NEAR(confidence.value(), share[sds - 1], 1e-6);
    }
  }
}

TEST(LineConfidence, OfOneSpectrumIsAHalfAtMost) {
  LineConfidence confidence;
  EXPECT_EQ(confidence.value(), 0.0);
  confidence.add(line_off(100.0, 0.1));
  EXPECT_DOUBLE_EQ(confidence.value(), 0.5);
  confidence.add(line_off(100.0, 0.1));
  EXPECT_DOUBLE_EQ(confidence.value(), 0.75);
  confidence.reset();
  EXPECT_EQ(confidence.value(), 0.0);
}

TEST(LineConfidence, OfALineAtItsOrderIsNoneAndOfOneThatCanBeNoOrderIsFull) {
  LineConfidence at;
  LineConfidence beyond;
  for (int i = 0; i < 60; ++i) {
    at.add(line_off(0.0, 0.6));
    Detector::Output none = line_off(0.0, 0.0);
    none.line.order = 0.0;
    beyond.add(none);
  }
  EXPECT_EQ(at.value(), 0.0);
  EXPECT_DOUBLE_EQ(beyond.value(), 1.0);
}

TEST(LineConfidence, OfPeriodDoublingIsItsShareOfTheEnergy) {
  LineConfidence confidence;
  Detector::Output flip = line_off(0.0, 0.6);
  flip.kind = Detector::Kind::flip;
  flip.energy_ratio = 0.8;
  for (int i = 0; i < 60; ++i) {
    confidence.add(flip);
  }
  EXPECT_NEAR(confidence.value(), 0.8, 1e-12);
}

TEST(NearestMode, IsTheOneLeastFarAndNoneWithoutModes) {
  const std::array<double, 3> modes_hz = {410.0, 922.0, 1100.0};
  EXPECT_EQ(nearest_mode_hz(modes_hz, 1000.0), 922.0);
  EXPECT_EQ(nearest_mode_hz(modes_hz, 5000.0), 1100.0);
  EXPECT_EQ(nearest_mode_hz({}, 1000.0), 0.0);
}

TEST(ShownSpeed, IsOneThatTheOrdersKnowBetterThanTheControl) {
  Detector::Output heard;
  EXPECT_FALSE(shows_speed(heard)) << "told exactly";
  heard.speed_sd = 2e-4;
  EXPECT_TRUE(shows_speed(heard));
  heard.speed_sd = 1e-3;
  EXPECT_FALSE(shows_speed(heard));
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
