// SPDX-License-Identifier: Apache-2.0
// A predistorted program on LinuxCNC itself: its interpreter reads it, its planner plans it, its
// sampler says what the joints were commanded. The servos are this file's own: ẋ = k·(c − x) with
// k = 20 1/s, exact for a command that holds over a servo period of 1 ms.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <tests/linuxcnc/measure.hpp>

#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest {
namespace {

using linuxcnc_test::kCannotRun;
using linuxcnc_test::Ran;
using linuxcnc_test::run_planned;

constexpr double kGain_1_s = 20.0;
constexpr double kPeriod_s = 0.001;

/// A tangent, three turns of a circle of 10 mm about the origin, a tangent.
const std::string kCircle =
    "G21 G90 G94 G17 G61\nG0 X10 Y-30 Z0\nG4 P0.5\nG1 Y0 F4000\nG3 X10 Y0 I-10 J0 P3\nG1 Y30\nM2\n";

struct Measured {
  double rms_mm = 0.0;
  double max_mm = 0.0;
  std::size_t periods = 0;  ///< in the cut
};

/// What lagging axes make of the commands in the sampler's log, to the line x = 10 or the circle,
/// whichever is nearer.
Measured measured(const std::string& log) {
  std::ifstream in(log);
  const double decay = std::exp(-kGain_1_s * kPeriod_s);
  double x = 0.0;
  double y = 0.0;
  bool cuts = false;
  Measured out;
  for (std::string row; std::getline(in, row);) {
    std::istringstream words(row);
    double number = 0.0, in_position = 0.0, speed = 0.0, line = 0.0, cx = 0.0, cy = 0.0;
    if (!(words >> number >> in_position >> speed >> line >> cx >> cy)) {
      continue;
    }
    x = cx + (x - cx) * decay;
    y = cy + (y - cy) * decay;
    cuts = cuts || cy < -29.99;
    if (cuts && cy > -29.9) {
      const double error = std::min(std::abs(std::hypot(x, y) - 10.0), std::abs(x - 10.0));
      out.rms_mm += error * error;
      out.max_mm = std::max(out.max_mm, error);
      ++out.periods;
    }
  }
  out.rms_mm = std::sqrt(out.rms_mm / static_cast<double>(std::max<std::size_t>(out.periods, 1)));
  return out;
}

TEST(PredistortOnLinuxCnc, CutsACircleInTheSameTimeWithoutItsError) {
  const kernel::file::testing::OwnFolder folder;
  const std::string original = folder.at("circle.ngc");
  const std::string changed = folder.at("changed.ngc");
  std::ofstream(original) << kCircle;
  const auto machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  nc::interpret::Config config;
  config.axes = "XYZ";
  const auto done = contour::offline::predistort(
      original, config, machine,
      {.max_shift_mm = 2.0, .told = {{"changes", "predistort"}, {"tube-mm", "2"}}});
  ASSERT_TRUE(done.has_value());
  std::ofstream(changed) << done->replaced.text;

  const std::string log = folder.at("log");
  const Ran as_it_is = run_planned(original, log, done->seconds_before);
  if (as_it_is.status == kCannotRun) {
    GTEST_SKIP() << "LinuxCNC cannot run here";
  }
  ASSERT_EQ(as_it_is.status, 0);
  const Measured before = measured(log);
  const Ran changed_run = run_planned(changed, log, done->seconds_after);
  ASSERT_EQ(changed_run.status, 0);
  const Measured after = measured(log);
  // The closed form: R·(1 − 1/√(1 + q²)) with q = v/(R·k) = 1/3.
  EXPECT_NEAR(before.max_mm, 0.5132, 0.005);
  // As predicted, and far less than a fifth.
  EXPECT_NEAR(after.rms_mm, done->after.nominal().rms_mm(), 0.001);
  EXPECT_LT(after.rms_mm, 0.01 * before.rms_mm);
  EXPECT_LT(after.max_mm, 0.02 * before.max_mm);
  EXPECT_NEAR(changed_run.seconds, as_it_is.seconds, 0.005 * as_it_is.seconds);
}

}  // namespace
}  // namespace steadyrest
