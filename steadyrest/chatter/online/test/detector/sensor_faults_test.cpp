// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/sensor_faults.hpp>

namespace steadyrest::chatter::online {
namespace {

std::vector<double> noise(std::size_t count) {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> gauss;
  std::vector<double> out(count);
  std::ranges::generate(out, [&] { return gauss(rng); });
  return out;
}

std::size_t gaps_in(SensorFaults& faults, const std::vector<double>& values) {
  return static_cast<std::size_t>(
      std::ranges::count_if(values, [&](double value) { return faults.update(value); }));
}

TEST(SensorFaults, ThirdOfEqualValuesIsAGapInAFineSignal) {
  SensorFaults faults(8e3);
  EXPECT_EQ(gaps_in(faults, noise(8000)), 0U);
  EXPECT_EQ(gaps_in(faults, std::vector<double>(100, 0.0)), 98U);
  EXPECT_EQ(gaps_in(faults, {std::nan(""), std::numeric_limits<double>::infinity()}), 2U);
  EXPECT_FALSE(faults.clips());
}

// Of counts as coarse as the noise two in a row are equal in every third sample.
TEST(SensorFaults, CoarseCountsRepeatWithoutAGap) {
  SensorFaults faults(8e3);
  std::vector<double> counts = noise(40000);
  for (double& value : counts) {
    value = std::round(value);
  }
  EXPECT_EQ(gaps_in(faults, {counts.begin(), counts.begin() + 8000}), 0U);
  EXPECT_LT(gaps_in(faults, counts), 40U);
  EXPECT_GT(gaps_in(faults, std::vector<double>(100, 0.0)), 80U);
}

TEST(SensorFaults, HearsASensorThatClips) {
  SensorFaults faults(8e3);
  std::vector<double> wave(8000);
  for (std::size_t i = 0; i < wave.size(); ++i) {
    wave[i] = std::clamp(std::sin(0.2 * static_cast<double>(i)), -0.8, 0.8);
  }
  gaps_in(faults, wave);
  EXPECT_TRUE(faults.clips());
}

}  // namespace
}  // namespace steadyrest::chatter::online
