// SPDX-License-Identifier: Apache-2.0
// Where what is learnt begins and ends: at gaps, and where the tool does not move on.
#include <array>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/stretches.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kGapPeriod_s = 0.01;
constexpr double kGapSigma_s = 0.02;
constexpr std::array<double, 3> kNoLag_s{};

/// Samples 0.2 mm apart from 1 mm on, all 4 µm off in Y; a corner at 0 and at 100 mm.
std::vector<ErrorSample> even_samples(std::size_t count) {
  std::vector<ErrorSample> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<double>(i);
    out[i] = {.valid = true,
              .time_s = kGapPeriod_s * at,
              .foot_mm = 1.0 + 0.2 * at,
              .off_mm = {0.0, 0.004, 0.0}};
  }
  return out;
}

std::vector<Learnt::Stretch> stretches(const std::vector<ErrorSample>& samples) {
  return stretches_of(samples, SharpCorners({0.0, 100.0}), kNoLag_s, kGapSigma_s);
}

TEST(StretchesAtGaps, FourSamplesAreTheFewestThatTeach) {
  EXPECT_TRUE(stretches(even_samples(3)).empty());
  ASSERT_EQ(stretches(even_samples(4)).size(), 1U);
  EXPECT_EQ(stretches(even_samples(4))[0].knots.size(), 4U);
}

// Sample 20 is missing as no cut: both sides hold to the corners. As a disturbance: both fade.
TEST(StretchesAtGaps, FadeOnlyTowardsADisturbance) {
  for (const bool disturbed : {false, true}) {
    auto samples = even_samples(41);
    samples[20].valid = false;
    samples[20].fades = disturbed;
    const auto made = stretches(samples);
    ASSERT_EQ(made.size(), 2U);
    EXPECT_EQ(made[0].from_mm, 0.0);
    EXPECT_EQ(made[1].to_mm, 100.0);
    EXPECT_EQ(made[0].knots.front().weight, 1.0);
    EXPECT_EQ(made[1].knots.back().weight, 1.0);
    EXPECT_EQ(made[0].knots.back().weight, disturbed ? 0.0 : 1.0);
    EXPECT_EQ(made[1].knots.front().weight, disturbed ? 0.0 : 1.0);
    // 3σ are six samples.
    EXPECT_NEAR(made[0].knots[16].weight, disturbed ? 0.5 : 1.0, 1e-9);
    EXPECT_NEAR(made[1].knots[3].weight, disturbed ? 0.5 : 1.0, 1e-9);
    if (disturbed) {
      EXPECT_DOUBLE_EQ(made[0].to_mm, samples[19].foot_mm);
      EXPECT_DOUBLE_EQ(made[1].from_mm, samples[21].foot_mm);
    }
  }
}

// The tool stops and goes back a little: those samples belong to no place further on.
TEST(StretchesAtGaps, SamplesThatDoNotMoveOnAreLeftOut) {
  auto samples = even_samples(30);
  for (const std::size_t i : {10U, 11U, 12U}) {
    samples[i].foot_mm = samples[9].foot_mm - 0.01 * static_cast<double>(i - 10);
    samples[i].off_mm = {0.0, 9.0, 0.0};
  }
  const auto made = stretches(samples);
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].knots.size(), 27U);
  for (const Learnt::Knot& knot_of_rest : made[0].knots) {
    EXPECT_NEAR(knot_of_rest.shift_mm[1], 0.004, 1e-12);
  }
}

// 30 and 10 ms of lag and an error that grows by 1 and 2 mm/s: 30 and 20 µm ahead.
TEST(StretchesAtGaps, EachAxisLeadsByItsOwnLag) {
  auto samples = even_samples(40);
  for (ErrorSample& sample_of_ramp : samples) {
    sample_of_ramp.off_mm = {1.0 * sample_of_ramp.time_s, 2.0 * sample_of_ramp.time_s, 0.0};
  }
  const auto made =
      stretches_of(samples, SharpCorners({0.0, 100.0}), {0.03, 0.01, 0.5}, kGapSigma_s);
  ASSERT_EQ(made.size(), 1U);
  for (const Learnt::Knot& knot_of_ramp : made[0].knots) {
    EXPECT_NEAR(knot_of_ramp.shift_mm[0] - knot_of_ramp.unknown_mm[0], 0.030, 1e-9);
    EXPECT_NEAR(knot_of_ramp.shift_mm[1] - knot_of_ramp.unknown_mm[1], 0.020, 1e-9);
    EXPECT_EQ(knot_of_ramp.shift_mm[2], 0.0);
  }
}

}  // namespace
}  // namespace steadyrest::contour::offline
