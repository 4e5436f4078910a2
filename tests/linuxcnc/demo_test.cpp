// SPDX-License-Identifier: Apache-2.0
// `PORT=linuxcnc make demo` on a circle of 10 mm at F3000. Its servos lag like position loops with
// K = 50 1/s, which cuts the circle too small by v²/(2·K²·r): 50 µm at 50 mm/s, 10 µm at 22 mm/s.
// Time is LinuxCNC's servo thread, the error that of its positions.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tests/linuxcnc/live_mill.hpp>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/run_folder.hpp>

namespace steadyrest {
namespace {

using kernel::file::testing::OwnFolder;
using kernel::file::testing::text_of_file;
using kernel::signal::ProgramState;
using record::Sample;

constexpr double kRadius_mm = 10.0;
constexpr double kLimit_um = 10.0;    ///< of the machine file
constexpr std::uint32_t kCircle = 5;  ///< its line; the first one is M52 P1
/// A layer that is kept waiting for 20 ms hands back, and half a second later cuts as before.
constexpr double kLate_s = 0.015;
constexpr double kBack_s = 0.5;

struct Seen {
  std::vector<double> error_um;  ///< in the circle, once it is at its speed and the layer acts
  std::vector<double> speed_mm_s;
  std::size_t begins = 0;  ///< of the program
  double seconds = 0.0;
};

Seen read(const std::string& file) {
  Seen seen;
  auto reader = record::RecordReader::open(file);
  EXPECT_TRUE(reader.has_value());
  const auto sample = std::make_unique<Sample>();
  ProgramState before = ProgramState::running;
  double first_s = -1.0;
  double last_s = 0.0;
  double circle_s = 0.0;
  while (reader->next(*sample).value_or(false)) {
    const auto& frame = sample->frame;
    const double since_s = frame.time_s - std::exchange(last_s, frame.time_s);
    first_s = first_s < 0.0 ? frame.time_s : first_s;
    seen.seconds = frame.time_s - first_s;
    seen.begins +=
        before == ProgramState::stopped && frame.program == ProgramState::running ? 1 : 0;
    before = frame.program;
    const bool circle = frame.program == ProgramState::running && frame.program_line == kCircle &&
                        frame.motion == kernel::signal::Motion::feed;
    circle_s = circle && std::max(frame.age_s, since_s) < kLate_s ? circle_s + 1e-3 : 0.0;
    if (circle_s > kBack_s) {
      const double radius_mm =
          std::hypot(frame.axis[0].actual_mm - 100.0, frame.axis[1].actual_mm - 60.0);
      seen.error_um.push_back(1e3 * std::abs(radius_mm - kRadius_mm));
      seen.speed_mm_s.push_back(frame.path_speed_mm_s);
    }
  }
  return seen;
}

/// The folders of demos.
std::set<std::string> demos() {
  std::set<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator("/var/tmp")) {
    if (entry.path().filename().string().starts_with("steadyrest-demo.")) {
      all.insert(entry.path().string());
    }
  }
  return all;
}

TEST(LinuxCncDemo, TheLayerHoldsTheContourLimitAgainAndAgainAndNothingIsLeft) {
  const OwnFolder folder;
  const std::set<std::string> before = demos();
  std::ofstream(folder.at("circle.ngc"))
      << "G21 G90 G94 G17 G61 G54\nS6000 M3\nG0 X10 Y0 Z0\nG3 X10 Y0 I-10 J0 P2 F3000\nM2\n";
  const int code = linuxcnc_test::status_of("LAYER='" STEADYREST_PROGRAM "' PROGRAM='" +
                                            folder.at("circle.ngc") + "' KEEP='" + folder.at("") +
                                            "' LISTEN=0 FOR_S=18 sh " STEADYREST_SOURCE_DIR
                                            "/scripts/linuxcnc/demo.sh >'" +
                                            folder.at("said") + "' 2>&1");
  const std::string said = text_of_file(folder.at("said"));
  if (code == linuxcnc_test::kCannotRun) {
    GTEST_SKIP() << said;
  }
  ASSERT_EQ(code, 0) << said;
  EXPECT_NE(said.find("Page: http://127.0.0.1:"), std::string::npos) << said;
  EXPECT_EQ(said.find("LinuxCNC:"), std::string::npos) << said;

  const auto runs = record::run_files(folder.at(""));
  ASSERT_TRUE(runs.has_value() && runs->size() == 1) << said;
  const Seen seen = read(runs->front().file);
  EXPECT_GT(seen.seconds, 15.0);
  EXPECT_GE(seen.begins, 2U);
  ASSERT_GT(seen.error_um.size(), 5000U);
  const auto within =
      std::ranges::count_if(seen.error_um, [](double error_um) { return error_um <= kLimit_um; });
  EXPECT_GT(static_cast<double>(within), 0.95 * static_cast<double>(seen.error_um.size()));
  std::vector<double> speed = seen.speed_mm_s;
  std::ranges::nth_element(speed, speed.begin() + static_cast<std::ptrdiff_t>(speed.size() / 2));
  EXPECT_GT(speed[speed.size() / 2], 18.0) << "the highest feed step within the limit";

  for (const std::string& demo : demos()) {
    EXPECT_TRUE(before.contains(demo)) << demo << " is left";
  }
}

}  // namespace
}  // namespace steadyrest
