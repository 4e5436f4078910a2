// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/vibration_spectrum.hpp>

namespace steadyrest::apps::live_page {
namespace {

constexpr double kRate_hz = 10e3;

std::vector<double> waves(double seconds, const std::vector<std::pair<double, double>>& waves) {
  std::vector<double> out(static_cast<std::size_t>(seconds * kRate_hz), 0.0);
  for (const auto& [hz, amplitude] : waves) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] +=
          amplitude * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / kRate_hz);
    }
  }
  return out;
}

/// The largest amplitude within 15 Hz, and where.
std::pair<double, double> peak(const VibrationSpectrum::Lines& lines, double hz) {
  std::pair<double, double> out{0.0, 0.0};
  for (std::size_t i = 0; i < lines.hz.size(); ++i) {
    if (std::abs(lines.hz[i] - hz) < 15.0 && lines.amplitude[i] > out.second) {
      out = {lines.hz[i], lines.amplitude[i]};
    }
  }
  return out;
}

TEST(VibrationSpectrum, ShowsWavesWithTheirAmplitudes) {
  VibrationSpectrum spectrum;
  const auto signal = waves(2.0, {{166.7, 2.0}, {946.0, 0.5}});
  // In pieces as they come from the cycle.
  for (std::size_t i = 0; i < signal.size(); i += 40) {
    spectrum.add(std::span(signal).subspan(i, 40), kRate_hz);
  }
  EXPECT_TRUE(spectrum.fresh());
  EXPECT_FALSE(spectrum.fresh());
  for (const std::size_t most : {4000UL, 300UL}) {
    const auto lines = spectrum.lines(2000.0, most);
    EXPECT_LE(lines.hz.size(), most);
    EXPECT_TRUE(std::ranges::is_sorted(lines.hz));
    EXPECT_LE(lines.hz.back(), 2000.0);
    // A Hann window loses 1.4 dB at most, midway between two lines.
    const auto [tooth_hz, tooth] = peak(lines, 166.7);
    EXPECT_NEAR(tooth_hz, 166.7, 3.0);
    EXPECT_GT(tooth, 2.0 * 0.84);
    EXPECT_LT(tooth, 2.0 * 1.01);
    const auto [chatter_hz, chatter] = peak(lines, 946.0);
    EXPECT_NEAR(chatter_hz, 946.0, 3.0);
    EXPECT_GT(chatter, 0.5 * 0.84);
    EXPECT_LT(chatter, 0.5 * 1.01);
    EXPECT_LT(peak(lines, 500.0).second, 0.01);
  }
}

TEST(VibrationSpectrum, ForgetsWhatIsOver) {
  VibrationSpectrum spectrum;
  spectrum.add(waves(1.0, {{946.0, 1.0}}), kRate_hz);
  EXPECT_GT(peak(spectrum.lines(5e3, 4000), 946.0).second, 0.8);
  spectrum.add(waves(2.0, {}), kRate_hz);
  EXPECT_LT(peak(spectrum.lines(5e3, 4000), 946.0).second, 0.1);
}

// Lines are 10e3/2048 = 4.88 Hz apart. Sines at whole lines have their amplitude exactly.
TEST(VibrationSpectrum, PutsEachWaveIntoItsBandInDecibels) {
  const double line_hz = kRate_hz / 2048.0;
  VibrationSpectrum spectrum;
  spectrum.add(waves(0.5, {{100.0 * line_hz, 10.0}, {310.0 * line_hz, 0.01}}), kRate_hz);
  const auto bands = spectrum.take_bands(2000.0, 200);
  ASSERT_EQ(bands.level_db.size(), 137U);  // of 410 lines, three in each
  EXPECT_DOUBLE_EQ(bands.band_hz, 3.0 * line_hz);
  EXPECT_EQ(bands.level_db[33], 20);    // lines 99 to 101
  EXPECT_EQ(bands.level_db[103], -40);  // lines 309 to 311
  // A Hann window has nothing beyond its neighbours.
  EXPECT_LT(bands.level_db[31], -100);
  EXPECT_LT(bands.level_db[60], -100);
  EXPECT_LT(bands.level_db[105], -100);
}

TEST(VibrationSpectrum, ABandHasTheLoudestOfItsWavesAndABurstIsNotAveraged) {
  const double line_hz = kRate_hz / 2048.0;
  VibrationSpectrum spectrum;
  spectrum.add(waves(1.0, {{99.0 * line_hz, 1.0}, {101.0 * line_hz, 0.1}}), kRate_hz);
  EXPECT_EQ(spectrum.take_bands(2000.0, 200).level_db[33], 0);
  EXPECT_TRUE(spectrum.take_bands(2000.0, 200).level_db.empty()) << "no new window";
  spectrum.add(waves(0.3, {{100.0 * line_hz, 100.0}}), kRate_hz);
  spectrum.add(waves(0.3, {}), kRate_hz);
  EXPECT_EQ(spectrum.take_bands(2000.0, 200).level_db[33], 40);
  spectrum.add(waves(0.5, {}), kRate_hz);
  EXPECT_EQ(spectrum.take_bands(2000.0, 200).level_db[33], VibrationSpectrum::kSilence_db);
}

TEST(VibrationSpectrum, HasNoEndlessWindowWhateverTheRate) {
  VibrationSpectrum spectrum;
  spectrum.add(waves(7.0, {{946.0, 1.0}}), 1e300);
  EXPECT_TRUE(spectrum.fresh());
}

TEST(VibrationSpectrum, IsEmptyWithoutASignal) {
  VibrationSpectrum spectrum;
  EXPECT_FALSE(spectrum.fresh());
  EXPECT_TRUE(spectrum.lines(1e3, 100).hz.empty());
  spectrum.add(waves(1.0, {{946.0, 1.0}}), kRate_hz);
  spectrum.add({}, 0.0);
  EXPECT_FALSE(spectrum.fresh());
  EXPECT_TRUE(spectrum.lines(1e3, 100).hz.empty());
  const std::vector<double> bad(3000, std::nan(""));
  spectrum.add(bad, kRate_hz);
  for (const double amplitude : spectrum.lines(1e3, 100).amplitude) {
    EXPECT_EQ(amplitude, 0.0);
  }
}

}  // namespace
}  // namespace steadyrest::apps::live_page
