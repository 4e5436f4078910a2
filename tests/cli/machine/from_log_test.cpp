// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/file/testing/recorded.hpp>
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

/// A machine with the axes that move in the recorded capture.
std::string recorded_machine() {
  std::string text =
      "name = \"recorded\"\nport = \"sim\"\n[control]\ndialect = \"sinumerik\"\n"
      "interpolator_period_ms = 2\nservo_period_ms = 2\n[override.feed]\n"
      "percent = [0, 50, 100]\n";
  for (const char axis : {'X', 'Y', 'Z', 'U'}) {
    text += fmt::format(
        "[[axis]]\nname = \"{}\"\nservo_gain_1_s = 50\nmax_feed_mm_min = 40000\n"
        "max_acceleration_mm_s2 = 8000\nmin_mm = -2000\nmax_mm = 2000\n"
        "encoder = {{ count_um = 0.1 }}\n",
        axis);
  }
  return text;
}

// A real 840D sl, read as it was captured: feed-forward on, a delay of some milliseconds.
TEST(MachineFromLog, FitsTheCaptureOfARealControl) {
  const auto capture = kernel::file::testing::shared_data() / "edge/capture_840dsl.json.gz";
  if (!std::filesystem::exists(capture)) {
    GTEST_SKIP() << capture << " is not there";
  }
  const Scratch scratch;
  const std::string command = "machine from-log " + capture.string() + " --machine " +
                              scratch.file("m.toml", recorded_machine()) + " -o " +
                              scratch.at("fitted.toml");
  const json answer = answer_of(command + " --columns X=1,Y=2,Z=4,U=6");
  ASSERT_EQ(answer["axes"].size(), 4U);
  for (const json& axis : answer["axes"]) {
    EXPECT_LT(axis["rms_um"].get<double>(), 3.0) << axis;
    EXPECT_GT(axis["feed_forward"].get<double>(), 0.6) << axis;
    EXPECT_NEAR(axis["delay_ms"].get<double>(), 4.5, 2.5) << axis;
    // So little lag is left that the gain stays open: the machine file keeps its own.
    EXPECT_FALSE(axis["determined"].get<bool>()) << axis;
  }
  EXPECT_THAT(answer["warnings"].dump(), HasSubstr("axis Z: the record leaves the gain open"));
  EXPECT_TRUE(answer["proposals"].empty());
  EXPECT_EQ(kernel::file::testing::text_of_file(scratch.at("fitted.toml")), recorded_machine());
  expect_refused(command + " --columns X=1,Y=9", "no positions of machine axis 9");
}

/// A trace as SINUMERIK writes it: values at their changes alone.
std::string trace_of(const std::vector<std::array<double, 3>>& rows) {
  std::string out =
      "<traceSession>\n<traceData>\n <dataFrame>\n"
      "  <dataSignal interval=\"0.001\" id=\"f1\" name=\"/Nck/!SD/nckServoDataCmdPos2ndEnc64 [u1, "
      "1]\"/>\n"
      "  <dataSignal interval=\"0.001\" id=\"f2\" name=\"/Nck/!SD/nckServoDataFlwErr64 [u1, "
      "1]\"/>\n";
  std::array<double, 3> was{-1.0, 1e9, 1e9};
  for (const auto& row : rows) {
    std::string values = row[1] != was[1] ? fmt::format(" f1=\"{:.6f}\"", row[1]) : "";
    values += row[2] != was[2] ? fmt::format(" f2=\"{:.6f}\"", row[2]) : "";
    out += values.empty() ? "" : fmt::format("  <rec time=\"{:.6f}\"{}/>\n", row[0], values);
    was = row;
  }
  return out + " </dataFrame>\n</traceData>\n</traceSession>\n";
}

// e⁺ = p·e + (1 − p)/(k·h)·d, the law's own solution, in four forms.
TEST(MachineFromLog, ReadsEveryForm) {
  const Scratch scratch;
  std::vector<std::array<double, 3>> rows;
  std::string cut = "t_s,x_cmd_mm,x_act_mm\n";
  std::string inch = "time [ms];x_cmd [inch];x_err [inch]\n";
  std::string sampler;
  double error = 0.0;
  double last = 0.0;
  for (int n = 0; n < 3000; ++n) {
    const double t = 0.001 * n;
    const double c =
        std::round(1e6 * (5.0 * (1.0 - std::cos(4.0 * t)) + 0.5 * (1.0 - std::cos(31.0 * t)))) /
        1e6;
    const double p = std::exp(-0.04);
    error = p * error + (1.0 - p) / 0.04 * (c - last);
    last = c;
    const double e = std::round(1e6 * error) / 1e6;
    rows.push_back({t, c, e});
    cut += fmt::format("{:.3f},{:.6f},{:.6f}\n", t, c, c - e);
    inch += fmt::format("{};{:.9f};{:.9f}\n", n, c / 25.4, e / 25.4);
    sampler += fmt::format("{} {:.6f} {:.6f}\n", n, c, c - e);
  }
  const std::string mill = project_file("examples/machines/linuxcnc-mill.toml");
  for (const std::string& record : {scratch.file("cut.csv", cut), scratch.file("inch.csv", inch),
                                    scratch.file("sampler.txt", sampler) +
                                        " --columns sample,x_cmd_mm,x_act_mm --sample-hz 1000",
                                    scratch.file("trace.xml", trace_of(rows))}) {
    const json answer = fitted(scratch, record, mill, "X");
    EXPECT_NEAR(answer["axes"][0]["servo_gain_1_s"].get<double>(), 40.0, 0.4) << record;
    EXPECT_NEAR(answer["cycle_ms"].get<double>(), 1.0, 1e-6);
  }
  const std::string to = " --machine " + mill + " --axes X -o " + scratch.at("none.toml");
  expect_refused("machine from-log " + scratch.file("a.json", "{\"Header\": {}}") + to,
                 "not a capture of SINUMERIK Edge");
  expect_refused("machine from-log " + scratch.file("a.xml", "<a/>") + to,
                 "not a trace of SINUMERIK");
  expect_refused("machine from-log " + scratch.file("b.csv", "t_s,x_cmd_mm\n0,0\n") + to,
                 "the column x_act_mm is missing");
}

// The servo test in the plane: Z stands, and X and Y are fitted all the same.
TEST(MachineFromLog, LeavesAxesThatStandAlone) {
  const Scratch scratch;
  const std::string servo_test = text_of_file(project_file("examples/programs/servo-test.ngc"));
  const std::string part =
      scratch.file("flat.ngc", std::regex_replace(servo_test, std::regex("(G1 )?Z-?[0-9]+"), ""));
  const std::string mill = " --machine " + project_file("examples/machines/linuxcnc-mill.toml");
  answer_of("cut " + part + mill + " --record " + scratch.at("flat.csv"));
  const std::string line = "machine from-log " + scratch.at("flat.csv") + mill;
  const json answer = answer_of(line + " -o " + scratch.at("fitted.toml"));
  ASSERT_EQ(answer["axes"].size(), 2U);
  EXPECT_NEAR(answer["axes"][1]["servo_gain_1_s"].get<double>(), 20.0, 0.4);
  EXPECT_NE(answer["warnings"].dump().find("axis Z: does not move in the record"),
            std::string::npos);
  expect_refused(line + " --axes X,Y,Z -o " + scratch.at("all.toml"), "axis Z: 0 samples");
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
