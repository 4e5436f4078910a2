// SPDX-License-Identifier: Apache-2.0
// Signals whose parts are known: what repeats with the tooth, and one line beside it.
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/trial/vibration/vibration_summary.hpp>

namespace steadyrest::trial::vibration {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSample_s = 1e-4;
constexpr double kSeconds = 4.0;
constexpr std::size_t kRepeat = 50;  ///< 200 Hz tooth passing

Moment moment_at(double t_s) {
  Moment now;
  now.t_s = t_s;
  now.cut.period_s = kSample_s;
  return now;
}

/// x is what repeats with amplitude `forced_um`, and a line of `rest_um` at `rest_hz`.
Summary summary_of(double forced_um, double rest_um, double rest_hz, std::size_t repeat = kRepeat,
                   std::size_t axis = 0) {
  VibrationSummary summary(kSeconds, repeat);
  const auto steps = static_cast<int>(kSeconds / kSample_s);
  for (int i = 0; i < steps; ++i) {
    const double t_s = i * kSample_s;
    Moment now = moment_at(t_s);
    now.cut.displacement_mm[axis] = 1e-3 * (forced_um * std::sin(kTurn * t_s * 200.0) +
                                            rest_um * std::sin(kTurn * t_s * rest_hz));
    summary.add(now);
  }
  return summary.summary();
}

TEST(VibrationSummary, PartsWhatRepeatsFromTheRest) {
  const Summary both = summary_of(30.0, 7.0, 923.0);
  EXPECT_NEAR(*both.forced_um, 30.0, 0.1);
  EXPECT_NEAR(*both.rest_rms_um, 7.0 / std::numbers::sqrt2, 0.05);
  EXPECT_NEAR(*both.frequency_hz, 923.0, 0.05);
  EXPECT_NEAR(both.peak_um, 37.0, 0.5);
}

// A stable cut has no chatter frequency, and a harmonic of the tooth passing is forced.
TEST(VibrationSummary, NamesNoFrequencyWhereAllRepeats) {
  const Summary quiet = summary_of(30.0, 0.0, 900.0);
  EXPECT_LT(*quiet.rest_rms_um, 0.01);
  EXPECT_FALSE(quiet.frequency_hz);
  const Summary harmonic = summary_of(30.0, 10.0, 800.0);
  EXPECT_LT(*harmonic.rest_rms_um, 0.01);
  EXPECT_FALSE(harmonic.frequency_hz);
}

// Flip chatter: half the tooth-passing frequency repeats only every second tooth.
TEST(VibrationSummary, HalfTheToothPassingIsNoRepetition) {
  const Summary flip = summary_of(5.0, 20.0, 100.0);
  EXPECT_NEAR(*flip.rest_rms_um, 20.0 / std::numbers::sqrt2, 0.01);
  EXPECT_NEAR(*flip.frequency_hz, 100.0, 0.05);
  // Per turn of two teeth it does repeat.
  EXPECT_LT(*summary_of(5.0, 20.0, 100.0, 2 * kRepeat).rest_rms_um, 0.01);
}

TEST(VibrationSummary, IsOfTheAxisThatVibratesMore) {
  const Summary across = summary_of(12.0, 3.0, 700.0, kRepeat, 1);
  EXPECT_NEAR(*across.forced_um, 12.0, 0.1);
  EXPECT_NEAR(*across.frequency_hz, 700.0, 0.1);
}

// Under a law nothing repeats, so nothing is parted; a short run cannot be either.
TEST(VibrationSummary, PartsNothingWithoutARepetition) {
  const Summary modulated = summary_of(30.0, 7.0, 923.0, 0);
  EXPECT_FALSE(modulated.forced_um);
  EXPECT_FALSE(modulated.frequency_hz);
  EXPECT_GT(modulated.peak_um, 36.0);
  VibrationSummary brief(1.0, kRepeat);
  for (std::size_t i = 0; i < 3 * kRepeat; ++i) {
    brief.add(moment_at(0.9));
  }
  EXPECT_FALSE(brief.summary().forced_um);
}

// The entry is over by the second half: a peak counts always, the wall only then.
TEST(VibrationSummary, TheWallIsThatOfTheSecondHalf) {
  VibrationSummary summary(10.0, 0);
  const auto add = [&](double t_s, double wall_mm, double force_n) {
    Moment now = moment_at(t_s);
    now.cut.wall = true;
    now.cut.wall_mm = wall_mm;
    now.cut.force_n = {0.6 * force_n, 0.8 * force_n};
    summary.add(now);
  };
  add(1.0, 0.500, 900.0);
  EXPECT_FALSE(summary.summary().wall_error_um);
  add(5.0, 0.002, 100.0);
  add(6.0, -0.004, 100.0);
  add(7.0, 0.005, 100.0);
  EXPECT_NEAR(*summary.summary().wall_error_um, 1.0, 1e-9);
  EXPECT_NEAR(*summary.summary().wall_range_um, 9.0, 1e-9);
  EXPECT_NEAR(summary.summary().force_peak_n, 900.0, 1e-9);
}

// Between the lines of the spectrum, to a hundredth of their distance of 1 Hz.
TEST(StrongestLine, IsFoundBetweenTheLines) {
  for (const double hz : {50.0, 123.25, 333.5, 480.9}) {
    std::vector<double> signal;
    for (int i = 0; i < 1000; ++i) {
      signal.push_back(5.0 + 2.0 * std::sin(kTurn * hz * i * 1e-3) +
                       std::sin(kTurn * 40.0 * i * 1e-3));
    }
    const auto found = strongest_line_hz(signal, 1e-3);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, hz, 0.03) << hz;
  }
  EXPECT_FALSE(strongest_line_hz(std::vector<double>(15, 1.0), 1e-3));
}

}  // namespace
}  // namespace steadyrest::trial::vibration
