// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/page/chatter/chatter_page.hpp>
#include <steadyrest/apps/page/chatter/cut_recorder.hpp>
#include <steadyrest/apps/page/chatter/lobes_page.hpp>
#include <steadyrest/apps/page/chatter/spectrogram.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Signals that are known exactly: tones, and circles of one vibration a turn.
namespace steadyrest::apps::page {
namespace {

using kernel::units::kTurn;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr double kRate_hz = 8000.0;

/// A tone of 1000 Hz; from half-time on also one of 2000 Hz at a tenth of its amplitude, 20 dB
/// below. Both are whole numbers of bins of a 256-sample window at 8 kHz, so nothing leaks.
std::vector<double> tones(std::size_t samples) {
  std::vector<double> out;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t_s = static_cast<double>(i) / kRate_hz;
    const double second = 2 * i > samples ? 0.1 : 0.0;
    out.push_back(std::sin(kTurn * 1000.0 * t_s) + second * std::sin(kTurn * 2000.0 * t_s));
  }
  return out;
}

int level(const Spectrogram& s, double t_s, double hz, double bin_hz) {
  const auto column = static_cast<std::size_t>((t_s - s.start_s) / s.column_s);
  const auto row = static_cast<std::size_t>((hz + 0.5 * bin_hz) / s.row_hz);
  return s.level_db.at(column * s.rows + row);
}

TEST(Spectrogram, HasToneAndTimeWhereTheyAre) {
  const double bin_hz = kRate_hz / 256.0;
  const auto s = spectrogram(
      tones(8000), {.rate_hz = kRate_hz, .start_s = 3.0, .window = 256, .most_hz = 4000.0});
  EXPECT_EQ(s.level_db.size(), s.columns * s.rows);
  EXPECT_NEAR(level(s, 3.2, 1000.0, bin_hz), 0, 1);
  EXPECT_LT(level(s, 3.2, 2000.0, bin_hz), -100);
  EXPECT_NEAR(level(s, 3.8, 1000.0, bin_hz), 0, 1);
  EXPECT_NEAR(level(s, 3.8, 2000.0, bin_hz), -20, 1);  // a tenth of the amplitude
  EXPECT_LT(level(s, 3.8, 3000.0, bin_hz), -80);
}

// 400 000 samples in 50 × 40 cells: maxima keep the tones where means would lose them.
TEST(Spectrogram, OfALongSignalIsNoLargerAndLosesNoTone) {
  const auto s = spectrogram(
      tones(400'000),
      {.rate_hz = kRate_hz, .window = 2048, .most_hz = 4000.0, .columns = 50, .rows = 40});
  EXPECT_LE(s.columns, 50U);
  EXPECT_LE(s.rows, 40U);
  const double bin_hz = kRate_hz / 2048.0;
  EXPECT_NEAR(level(s, 10.0, 1000.0, bin_hz), 0, 1);
  EXPECT_NEAR(level(s, 40.0, 2000.0, bin_hz), -20, 1);
}

/// One vibration per turn, 50 steps each; the place at angle 0 is (1, 0) µm in every turn.
trial::vibration::Moment moment(std::size_t step, double turns_per_s) {
  trial::vibration::Moment out;
  out.angle_rad = kTurn * (static_cast<double>(step) + 0.5) / 50.0;
  out.t_s = out.angle_rad / kTurn / turns_per_s;
  out.speed_rev_s = turns_per_s;
  out.cut.displacement_mm = {0.001 * std::cos(out.angle_rad), 0.002 * std::sin(out.angle_rad)};
  out.cut.force_n = {3.0, 4.0};
  return out;
}

// 200 turns, of which the last is not complete. Linear interpolation between two of 50 steps on a
// cosine errs by 1 − cos(π/50) = 0.002 at most.
TEST(CutRecorder, SamplesOnceARevolutionAndKeepsExtremes) {
  CutRecorder cut(2.0, 100.0);
  for (std::size_t step = 0; step < 50 * 200; ++step) {
    cut.add(moment(step, 100.0));
  }
  ASSERT_EQ(cut.turns().t_s.size(), 199U);  // the 200th is not done
  for (std::size_t i = 0; i < 199; ++i) {
    EXPECT_NEAR(cut.turns().t_s[i], 0.01 * static_cast<double>(i + 1), 1e-12);
    EXPECT_NEAR(cut.turns().place_um[0][i], 1.0, 0.003);
    EXPECT_NEAR(cut.turns().place_um[1][i], 0.0, 1e-9);
  }
  EXPECT_NEAR(std::ranges::max(cut.envelope().high[1]), 2.0, 1e-2);
  EXPECT_NEAR(std::ranges::min(cut.envelope().low[1]), -2.0, 1e-2);
  EXPECT_EQ(cut.envelope().low[2].front(), 5.0);
  EXPECT_EQ(cut.envelope().t_s.size(), 3000U) << "15 to each vibration: its shape is seen";
  const auto last = cut.last();
  EXPECT_NEAR(last.back().angle_rad - last.front().angle_rad, 6.0 * kTurn, kTurn / 49.0);
}

// 20 000 turns; every fifth is kept, so that at most 4000 remain.
TEST(CutRecorder, OfALongCutTakesNoMoreRoom) {
  CutRecorder cut(200.0, 100.0);
  for (std::size_t step = 0; step < 50 * 20'000; ++step) {
    cut.add(moment(step, 100.0));
  }
  EXPECT_EQ(cut.turns_between(), 5U);
  EXPECT_LE(cut.turns().t_s.size(), 4000U);
  EXPECT_EQ(cut.envelope().t_s.size(), 3000U);
  EXPECT_LE(cut.last().size(), 8000U);
}

// A border loses its cusps if it is thinned; the map does not mind. The last value of the map
// proves that both ends are kept: 1001·501 − 1.
TEST(LobesPage, ThinsTheMapButNotTheBorder) {
  LobesPage lobes;
  for (std::size_t i = 0; i < 1001; ++i) {
    lobes.map.speed_rev_s.push_back(50.0 + static_cast<double>(i));
    lobes.border.speed_rev_s.push_back(50.0 + static_cast<double>(i));
    lobes.border.depth_mm.emplace_back(i == 7 ? std::nullopt : std::optional(0.5));
  }
  for (std::size_t i = 0; i < 501; ++i) {
    lobes.map.depth_mm.push_back(0.01 * static_cast<double>(i));
  }
  for (std::size_t i = 0; i < 1001 * 501; ++i) {
    lobes.map.log_radius.push_back(static_cast<double>(i));
  }
  const Json page = Json::parse(text_of(lobes_page(Json::object(), {}, lobes)));
  EXPECT_EQ(page["border"]["depth_mm"].size(), 1001U);
  EXPECT_TRUE(page["border"]["depth_mm"][7].is_null());
  EXPECT_EQ(page["map"]["speed_rpm"].size(), 400U);
  EXPECT_EQ(page["map"]["depth_mm"].size(), 250U);
  EXPECT_EQ(page["map"]["log_radius"].size(), 100'000U);
  EXPECT_EQ(page["map"]["speed_rpm"].back(), 60.0 * 1050.0);
  EXPECT_EQ(page["map"]["log_radius"].back(), 501500.0);
}

// A file name or a block of a program can hold </script>; the page must not end there.
TEST(ChatterPage, NoTextLeavesTheScriptElement) {
  const std::string html =
      to_html(text_of(chatter_head("lobes", "</script><b>", {{"text", "\xff<!--"}})));
  EXPECT_THAT(html, StartsWith("<!doctype html>"));
  EXPECT_THAT(html, EndsWith("</html>\n"));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>\\u003cb>"));
  EXPECT_THAT(html, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
  EXPECT_THAT(html, Not(HasSubstr("@STEADYREST_REPORT_DATA@")));
}

}  // namespace
}  // namespace steadyrest::apps::page
