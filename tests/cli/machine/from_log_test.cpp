// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kServoLog = project_file("examples/logs/servo-test.csv");
const std::string kVmcFile = project_file("examples/machines/vmc-840d.toml");

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Runs a program on the simulated machine, in real time, and gives its record.
std::string recorded(const Scratch& scratch, const std::string& machine,
                     const std::string& program) {
  return answer_of("run --machine " + machine + " --program " + program + " --record " +
                   scratch.at("runs") + " --socket " + scratch.at("s"))["record"]["file"];
}

json fitted(const Scratch& scratch, const std::string& record, const std::string& machine,
            const std::string& axes) {
  return answer_of("machine from-log " + record + " --machine " + machine + " --axes " + axes +
                   " -o " + scratch.at("fitted.toml") + " --force");
}

void expect_gains(const json& answer, double gain_1_s, double share) {
  for (const json& axis : answer["axes"]) {
    EXPECT_NEAR(axis["servo_gain_1_s"].get<double>(), gain_1_s, share * gain_1_s) << axis;
    EXPECT_NEAR(axis["feed_forward"].get<double>(), 0.0, 0.01) << axis;
    EXPECT_LT(axis["servo_gain_sd_1_s"].get<double>(), 0.01 * gain_1_s) << axis;
  }
}

// Only the gains' lines differ from the machine file; a feed_forward is added where there was none.
TEST(MachineFromLog, ChangesTheFilesGainsAndNothingElse) {
  const Scratch scratch;
  const json answer = fitted(scratch, kServoLog, kVmcFile, "Y");
  ASSERT_EQ(answer["axes"].size(), 1U);
  EXPECT_EQ(answer["axes"][0]["name"], "Y");
  EXPECT_NEAR(answer["cycle_ms"].get<double>(), 4.0, 1e-9);
  expect_gains(answer, 50.0, 0.01);
  const std::string was = text_of_file(kVmcFile);
  const std::string text = text_of_file(scratch.at("fitted.toml"));
  const std::size_t key = was.find("servo_gain", was.find("name = \"Y\""));
  EXPECT_EQ(text.substr(0, key), was.substr(0, key));
  const std::size_t behind = was.find('\n', key);
  EXPECT_TRUE(text.ends_with(was.substr(behind)));
  const std::string changed = text.substr(key, text.size() - key - (was.size() - behind));
  EXPECT_THAT(changed,
              testing::MatchesRegex("servo_gain_m_min_mm = 3\\.0[0-9]*  # fitted: sd [0-9.]+ "
                                    "1/s, from servo-test.csv\nfeed_forward = [0-9.e-]+  # "
                                    "fitted: sd [0-9.e-]+, from servo-test.csv"));
}

TEST(MachineFromLog, FindsTheGainsOfTheLinuxCncMill) {
  const Scratch scratch;
  const std::string mill = project_file("examples/machines/linuxcnc-mill.toml");
  const std::string record =
      recorded(scratch, mill, project_file("examples/programs/servo-test.ngc"));
  const json answer = fitted(scratch, record, mill, "X,Y,Z");
  ASSERT_EQ(answer["axes"].size(), 3U);
  expect_gains(answer, 20.0, 0.01);
  EXPECT_NEAR(answer["cycle_ms"].get<double>(), 1.0, 1e-9);
  EXPECT_TRUE(passport::read(scratch.at("fitted.toml")));
  // The table of the same record says the same.
  answer_of("record export " + record + " -o " + scratch.at("r.csv"));
  EXPECT_EQ(fitted(scratch, scratch.at("r.csv"), mill, "X,Y,Z")["axes"], answer["axes"]);
}

// Friction, counts, noise, a servo of half the record's cycle: within a percent all the same.
TEST(MachineFromLog, FindsTheGainsOfAMachineWithFriction) {
  const Scratch scratch;
  std::string text = text_of_file(project_file("examples/programs/servo-test.ngc"));
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"G21", "G71"},
                                 {"G61", "G60"},
                                 {"G4 P", "G4 F"},
                                 {"M2\n", "M30\n"}}) {
    text = replaced(text, from, to);
  }
  const std::string record = recorded(scratch, kVmcFile, scratch.file("servo-test.mpf", text));
  const json answer = fitted(scratch, record, kVmcFile, "X,Y,Z");
  ASSERT_EQ(answer["axes"].size(), 3U);
  expect_gains(answer, 50.0, 0.01);
  EXPECT_THAT(text_of_file(scratch.at("fitted.toml")), HasSubstr("servo_gain_m_min_mm = "));
}

TEST(MachineFromLog, RefusesByName) {
  const Scratch scratch;
  const std::string circle = project_file("examples/records/circle-start.sqlite");
  const std::string ideal = project_file("examples/machines/ideal-k50.toml");
  const std::string record = "machine from-log " + circle;
  const std::string out = " -o " + scratch.at("none.toml");
  expect_refused(record + " --machine " + ideal + out,
                 "axis X: 170 samples in motion; at least 500 are needed");
  expect_refused(record + " --machine " + ideal + " --axes Q" + out, "has no axis Q");
  expect_refused(record + " --machine " + ideal + " --axes X,X" + out, "names X twice");
  expect_refused(record + " --machine examples/machines/lathe-16k20f3.toml" + out,
                 "has the axes XYZ, the machine file has X-Z");
  expect_refused("machine from-log examples/logs/sine-edges.csv --machine " + ideal + out,
                 "the column time_s is missing");
  expect_refused("machine from-log examples/programs/slot.mpf --machine " + ideal + out,
                 "slot.mpf");
  expect_refused("machine from-log none.csv --machine " + ideal + out, "none.csv");
  const std::string head = "time_s,axis.command_mm.0,axis.actual_mm.0\n";
  const auto refuse_table = [&](const std::string& rows, const std::string& why) {
    expect_refused("machine from-log " + scratch.file("t.csv", head + rows) + " --machine " +
                       ideal + " --axes X" + out,
                   why);
  };
  refuse_table("", "");
  refuse_table("0,0,0\n", "holds 1 samples");
  refuse_table("0,0,0\n0,0,0\n", "the time does not rise");
  EXPECT_FALSE(std::filesystem::exists(scratch.at("none.toml")));
}

}  // namespace
}  // namespace steadyrest::test
