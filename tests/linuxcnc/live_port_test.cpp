// SPDX-License-Identifier: Apache-2.0
// The port on a LinuxCNC that cuts circles of 10 mm at F4000 with axes that lag like a position
// loop with 20 1/s: what probes read, what their ratios do, and what is left when one is killed.
// Time is the servo thread's own count; no other clock judges anything.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest {
namespace {

using testing::HasSubstr;
using Table = std::vector<std::vector<double>>;

constexpr int kCannotRun = 77;
constexpr double kPeriod_s = 0.001;
constexpr double kRadius_mm = 10.0;
constexpr double kFeed_mm_s = 4000.0 / 60.0;
constexpr double kPathAcceleration_mm_s2 = 2000.0;

/// M52 P1 lets the layer in. One block: no queue can run dry.
const std::string kCircles =
    "G21 G90 G94 G17 G61\nM52 P1 S6000 M3\nG0 X10 Y-30 Z0\nG1 Y0 F4000\nG3 X10 Y0 I-10 J0 P80\n";

/// Columns of a probe's frames (probe.cpp).
constexpr std::size_t kTime = 0;
constexpr std::size_t kMotion = 2;
constexpr std::size_t kLine = 3;
constexpr std::size_t kSpeed = 4;
constexpr std::size_t kFeed = 5;
constexpr std::size_t kInForce = 6;
constexpr std::size_t kCmdX = 7;
constexpr std::size_t kActX = 9;
constexpr std::size_t kErrX = kActX + 2;
constexpr std::size_t kSpindle = kErrX + 2;  ///< program, drive, measured
/// Columns of the servo thread's log (live.py).
constexpr std::size_t kTick = 1;
constexpr std::size_t kLogSpeed = 2;
constexpr std::size_t kLayer = 3;
constexpr std::size_t kBeat = 4;
constexpr std::size_t kAlive = 5;
constexpr std::size_t kCmdZ = 6;

Table table(const std::string& name) {
  std::ifstream in(name);
  Table rows;
  for (std::string line; std::getline(in, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0.0; words >> value;) {
      row.push_back(value);
    }
    if (row.size() > kAlive) {
      rows.push_back(row);
    }
  }
  return rows;
}

std::string text_of(const std::string& name) {
  std::ifstream in(name);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The servos' response on the circle: fb += g·(c − fb) in each period, g = kT/(1 + kT), so with
/// ω = v/R it is g/(1 − (1 − g)·e^(−iωT)).
std::complex<double> lag() {
  const double g = 0.02 / 1.02;
  const double angle = kFeed_mm_s / kRadius_mm * kPeriod_s;
  return g / (1.0 - (1.0 - g) * std::polar(1.0, -angle));
}

void expect_coherent(const Table& frames) {
  ASSERT_EQ(frames.size(), 2000U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& f = frames[i];
    EXPECT_EQ(f[kMotion], static_cast<double>(kernel::signal::Motion::feed));
    EXPECT_EQ(f[kLine], 5.0);
    EXPECT_NEAR(f[kFeed], kFeed_mm_s, 1e-6);
    EXPECT_NEAR(f[kSpeed], kFeed_mm_s, 1e-6);
    EXPECT_EQ(f[kInForce], 1.0);
    EXPECT_NEAR(std::hypot(f[kActX], f[kActX + 1]), kRadius_mm * std::abs(lag()), 0.001);
    EXPECT_NEAR(std::hypot(f[kErrX], f[kErrX + 1]), kRadius_mm * std::abs(1.0 - lag()), 0.001);
    // The error belongs to this cycle's position and the command of the cycle before.
    if (i > 0 && std::abs(f[kTime] - frames[i - 1][kTime] - kPeriod_s) < 1e-9) {
      EXPECT_NEAR(frames[i - 1][kCmdX] - f[kActX], f[kErrX], 1e-9);
    }
  }
  // The closed form of the continuous loop, R/√(1 + q²), is 9.487 mm.
  EXPECT_NEAR(std::hypot(frames[0][kActX], frames[0][kActX + 1]), 9.487, 0.011);
}

void expect_hold_keeps_its_block(const Table& frames) {
  std::size_t held = 0;
  for (const auto& f : frames) {
    EXPECT_EQ(f[kMotion], static_cast<double>(kernel::signal::Motion::feed));
    held += f[kSpeed] == 0.0 ? 1 : 0;
  }
  EXPECT_GT(held, 100U);
  EXPECT_LT(held, frames.size() - 100);
}

/// The first frame that shows a ratio below 1 in force.
std::size_t first_corrected(const Table& frames) {
  const auto at =
      std::find_if(frames.begin(), frames.end(), [](const auto& f) { return f[kInForce] < 0.999; });
  return static_cast<std::size_t>(at - frames.begin());
}

void expect_half_speed(const Table& frames) {
  ASSERT_EQ(frames.size(), 1500U);
  EXPECT_NEAR(frames[400][kSpeed], kFeed_mm_s, 1e-6);
  // Held from frame 500 on: whoever reads its successor sees it.
  const std::size_t at = first_corrected(frames);
  EXPECT_GE(at, 501U);
  EXPECT_LE(at, 505U);
  for (std::size_t i = 600; i < frames.size(); ++i) {
    EXPECT_NEAR(frames[i][kInForce], 0.5, 1e-9);
    EXPECT_NEAR(frames[i][kSpeed], 0.5 * kFeed_mm_s, 1e-6);
    EXPECT_NEAR(frames[i][kSpindle], 100.0, 1e-9);
    EXPECT_NEAR(frames[i][kSpindle + 1], 90.0, 1e-9);
  }
  // The drive's lag of 0.2 s has passed five times.
  EXPECT_NEAR(frames.front()[kSpindle + 2], 100.0, 0.1);
  EXPECT_NEAR(frames.back()[kSpindle + 2], 90.0, 0.1);
}

/// The operator turned the panel to 80 %, then to 30 %: min(layer, panel) with the layer at 50 %.
void expect_lesser_of_layer_and_panel(const Table& frames, const Table& log) {
  ASSERT_FALSE(frames.empty());
  const double from = frames.front()[kTime] / kPeriod_s + 200;
  const double to = frames.back()[kTime] / kPeriod_s;
  std::size_t at_layer = 0;
  std::size_t at_panel = 0;
  for (const auto& row : log) {
    if (row[kTick] > from && row[kTick] < to) {
      at_layer += std::abs(row[kLogSpeed] - 0.5 * kFeed_mm_s) < 0.01 ? 1 : 0;
      at_panel += std::abs(row[kLogSpeed] - 0.3 * kFeed_mm_s) < 0.01 ? 1 : 0;
      EXPECT_LT(row[kLogSpeed], 0.5 * kFeed_mm_s + 0.01) << "at tick " << row[kTick];
    }
  }
  EXPECT_GT(at_layer, 600U);
  EXPECT_GT(at_panel, 300U);
}

/// A probe that was stopped for 60 ms: the feed has not risen meanwhile, nor when it went on.
void expect_never_above(const Table& frames, double ratio) {
  // The feed falls by its slew; from there on it stays.
  const auto reached = std::ranges::find_if(
      frames, [&](const auto& frame) { return frame[kInForce] <= ratio + 1e-9; });
  ASSERT_NE(reached, frames.end());
  for (auto frame = reached; frame != frames.end(); ++frame) {
    EXPECT_LE((*frame)[kInForce], ratio + 1e-9) << "frame " << (frame - frames.begin());
  }
}

/// The killed probe held 0.2: that stays for a second after its last heartbeat, and the full feed
/// is back 0.4 s later, by the servo thread's log.
void expect_ramp_after_kill(const Table& log) {
  std::size_t end = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    end = std::abs(log[i][kLayer] - 0.2) < 1e-9 ? i : end;
  }
  ASSERT_GT(end, 500U);
  std::size_t beat = end;
  while (beat > 1 && log[beat][kBeat] == log[beat - 1][kBeat]) {
    --beat;
  }
  ASSERT_LT(beat + 1500, log.size());
  for (std::size_t i = beat + 1; i <= beat + 1410; ++i) {
    ASSERT_EQ(log[i][kTick], log[i - 1][kTick] + 1.0);
    EXPECT_LE(log[i][kLayer] - log[i - 1][kLayer], i < beat + 1000 ? 1e-9 : 2.0 * kPeriod_s + 1e-9);
    EXPECT_LE(std::abs(log[i][kLogSpeed] - log[i - 1][kLogSpeed]),
              kPathAcceleration_mm_s2 * kPeriod_s);
    EXPECT_GE(log[i][kLogSpeed], log[i - 1][kLogSpeed] - 1e-6);
  }
  EXPECT_EQ(log[beat + 15][kAlive], 1.0);
  EXPECT_EQ(log[beat + 25][kAlive], 0.0);
  // The path offset goes within 0.2 s; the one against heat stays.
  EXPECT_NEAR(log[beat][kCmdZ], 0.25, 1e-4);
  EXPECT_NEAR(log[beat + 200][kCmdZ], 0.05, 1e-4);
  EXPECT_NEAR(log[beat + 300][kCmdZ], 0.05, 1e-4);
  EXPECT_NEAR(log[beat][kLogSpeed], 0.2 * kFeed_mm_s, 1e-6);
  EXPECT_NEAR(log[beat + 995][kLogSpeed], 0.2 * kFeed_mm_s, 1e-6);
  EXPECT_NEAR(log[beat + 1410][kLogSpeed], kFeed_mm_s, 1e-6);
}

/// The probe after the killed one asks for no offset: from its 0.05 mm to 0 by 1 mm/s.
void expect_offset_goes_on(const Table& log) {
  const auto last = std::find_if(
      log.rbegin(), log.rend(), [](const auto& row) { return std::abs(row[kCmdZ] - 0.05) < 1e-4; });
  ASSERT_NE(last, log.rend());
  for (auto i = last.base(); i < log.end(); ++i) {
    EXPECT_LE(std::abs((*i)[kCmdZ] - (*(i - 1))[kCmdZ]), 0.002 * ((*i)[kTick] - (*(i - 1))[kTick]))
        << "at tick " << (*i)[kTick];
  }
  EXPECT_NEAR(log.back()[kCmdZ], 0.0, 1e-4);
}

int run_live(const std::string& folder) {
  const std::string command = "PROBE=" STEADYREST_PROBE
                              " DRIVE=live.py HAL='lag.hal layer.hal layer_offsets.hal "
                              "lag_log.hal' bash " STEADYREST_SOURCE_DIR
                              "/tests/linuxcnc/measure.sh " +
                              folder + "/circles.ngc " + folder + "/log";
  return WEXITSTATUS(std::system(command.c_str()));
}

TEST(LinuxCncPortLive, ReadsCorrectsAndLetsGo) {
  const kernel::file::testing::OwnFolder folder;
  std::ofstream(folder.at("circles.ngc")) << kCircles;
  const std::string path = folder.at(".");
  // A computer so busy that a probe misses 20 ms says nothing of the port: once more.
  const std::string smooth = "missed 0 skipped 0 rearmed 0\n";
  bool all_smooth = false;
  for (int i = 0; i < 4 && !all_smooth; ++i) {
    const int status = run_live(path);
    if (status == kCannotRun) {
      GTEST_SKIP() << "LinuxCNC cannot run here";
    }
    ASSERT_EQ(status, 0);
    all_smooth = text_of(folder.at("stalled.said")).find("rearmed 1\n") != std::string::npos;
    for (const char* name : {"read", "hold", "half", "panel", "again"}) {
      all_smooth = all_smooth && text_of(folder.at(std::string(name) + ".said")) == smooth;
    }
  }
  if (!all_smooth) {
    GTEST_SKIP() << "the computer is too busy for a probe in every servo cycle";
  }
  const Table log = table(folder.at("log"));
  expect_coherent(table(folder.at("read.csv")));
  expect_hold_keeps_its_block(table(folder.at("hold.csv")));
  expect_half_speed(table(folder.at("half.csv")));
  expect_lesser_of_layer_and_panel(table(folder.at("panel.csv")), log);
  expect_ramp_after_kill(log);

  // One that was stopped for more than the watchdog's time comes back by itself.
  EXPECT_THAT(text_of(folder.at("stalled.said")), HasSubstr("missed 0 "));
  EXPECT_THAT(text_of(folder.at("stalled.said")), HasSubstr("rearmed 1"));
  EXPECT_NEAR(table(folder.at("stalled.csv")).back()[kSpeed], 0.5 * kFeed_mm_s, 1e-6);
  expect_never_above(table(folder.at("stalled.csv")), 0.5);
  EXPECT_THAT(text_of(folder.at("taken.said")), HasSubstr("a layer runs on this LinuxCNC"));
  // The pins of a dead process keep its signals, for the next one with the same pins.
  EXPECT_THAT(text_of(folder.at("driven.said")), HasSubstr("layer-feed is missing or another"));
  EXPECT_NEAR(table(folder.at("again.csv")).back()[kSpeed], 0.5 * kFeed_mm_s, 1e-6);
  expect_offset_goes_on(log);
}

}  // namespace
}  // namespace steadyrest
