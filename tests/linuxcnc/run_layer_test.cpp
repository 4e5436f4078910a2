// SPDX-License-Identifier: Apache-2.0
// `steadyrest run` on a LinuxCNC that cuts circles of 10 mm at F4000 with axes that lag like a
// position loop with 20 1/s. Time is the servo thread's own count; no other clock judges anything.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tests/linuxcnc/live_mill.hpp>
#include <tests/linuxcnc/servo_log.hpp>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/testing/run_records.hpp>
#include <steadyrest/trial/replay/replay.hpp>

namespace steadyrest {
namespace {

using kernel::file::testing::OwnFolder;
using kernel::file::testing::text_of_file;
using linuxcnc_test::servo_log;
using linuxcnc_test::ServoRow;
using nlohmann::json;

constexpr double kFeed_mm_s = 4000.0 / 60.0;

void expect_slowed_and_handed_back(const std::vector<ServoRow>& log) {
  ASSERT_GT(log.size(), 6000U);
  double lowest = 1.0;
  std::size_t slowed = 0;
  for (std::size_t i = 1; i < log.size(); ++i) {
    lowest = std::min(lowest, log[i].ratio);
    slowed += log[i].ratio < 0.3 ? 1 : 0;
    // layer.hal's ramp: 15 1/s.
    EXPECT_LE(log[i].ratio - log[i - 1].ratio, 0.015 * (log[i].tick - log[i - 1].tick) + 1e-9)
        << "at tick " << log[i].tick;
  }
  EXPECT_LT(lowest, 0.15);
  EXPECT_GT(slowed, 2000U);
  EXPECT_DOUBLE_EQ(log.back().ratio, 1.0);
  EXPECT_TRUE(std::ranges::any_of(log.end() - 1000, log.end(), [](const ServoRow& row) {
    return std::abs(row.speed_mm_s - kFeed_mm_s) < 0.01;
  })) << "the feed is back";
}

/// The record of a live run decides the same again.
void expect_replays(const std::string& file, const kernel::machine::Machine& machine) {
  const auto replayed = trial::replay::replay(file, machine);
  ASSERT_TRUE(replayed.has_value()) << replayed.error().what;
  EXPECT_GE(replayed->cycles, 2000U);
  EXPECT_FALSE(replayed->first_difference.has_value());
}

/// The files that layer.py had read again.
void expect_reloads_judged_by_the_control(const OwnFolder& folder) {
  const std::vector<std::string> refused = {"axis X: upper end of travel 9000 mm",
                                            "offset_slew_um_s differs from the running layer's",
                                            "[control] differs from the running layer's"};
  for (std::size_t i = 0; i < refused.size(); ++i) {
    const std::string name = "reload" + std::to_string(i + 1) + ".json";
    const json reload = json::parse(text_of_file(folder.at(name)), nullptr, false);
    ASSERT_TRUE(reload.is_object()) << name;
    EXPECT_EQ(reload["outcome"], "refused") << name;
    EXPECT_THAT(reload["words"].get<std::string>(), testing::HasSubstr(refused[i]));
  }
  const json last = json::parse(text_of_file(folder.at("reload4.json")), nullptr, false);
  ASSERT_TRUE(last.is_object());
  EXPECT_EQ(last["outcome"], "taken") << last;
}

// v²/(2·R·k²) with k = 20 1/s: 10 µm ask for 8.9 mm/s on this circle, 13 % of its feed.
TEST(RunOnLinuxCnc, SlowsTheCircleAndHandsBack) {
  const OwnFolder folder;
  linuxcnc_test::write_mill(folder.at("machine.toml"));
  std::ofstream(folder.at("circles.ngc"))
      << "G21 G90 G94 G17 G61\nM52 P1 S6000 M3\nG0 X10 Y-30 Z0\nG1 Y0 F4000\n"
         "G3 X10 Y0 I-10 J0 P80\n";
  const int status = linuxcnc_test::run_on_linuxcnc(
      folder,
      {.script = "layer.py", .program = "circles.ngc", .hal = "lag.hal layer.hal lag_log.hal"});
  if (status == linuxcnc_test::kCannotRun) {
    GTEST_SKIP() << "LinuxCNC cannot run here";
  }
  ASSERT_EQ(status, 0);
  const json observed = json::parse(text_of_file(folder.at("observe.json")), nullptr, false);
  const json acted = json::parse(text_of_file(folder.at("act.json")), nullptr, false);
  ASSERT_TRUE(observed.is_object()) << text_of_file(folder.at("observe.said"));
  ASSERT_TRUE(acted.is_object()) << text_of_file(folder.at("act.said"));
  EXPECT_EQ(observed["cycles"], 3000);
  EXPECT_GT(observed["over_limit_s"].get<double>(), 2.9);
  expect_reloads_judged_by_the_control(folder);
  EXPECT_LT(acted["over_limit_s"].get<double>(), 1.0) << "of 4 s";
  EXPECT_EQ(acted["handed_back"], true);
  EXPECT_EQ(acted["port_faults"], 0);
  expect_slowed_and_handed_back(servo_log(folder.at("log")));
  const auto machine = passport::read(folder.at("machine.toml"));
  ASSERT_TRUE(machine.has_value());
  const std::vector<std::string> records = record::testing::run_records(folder.path());
  EXPECT_EQ(records.size(), 3U);
  for (const std::string& record : records) {
    expect_replays(record, *machine);
  }
}

}  // namespace
}  // namespace steadyrest
