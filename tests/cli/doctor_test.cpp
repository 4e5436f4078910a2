// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// The 840D's interpolator has 4 ms. Times depend on the computer, so only their order is checked.
TEST(Doctor, FindsAGoodMachineWell) {
  const Finished finished = run_line("doctor --machine examples/machines/vmc-840d.toml --json");
  ASSERT_EQ(finished.code, 0) << finished.err;
  const json answer = json::parse(finished.out);
  EXPECT_EQ(answer["ok"], true);
  EXPECT_EQ(answer["port"], "sim");
  EXPECT_TRUE(answer["findings"].is_array());
  const json& timing = answer["timing"];
  EXPECT_EQ(timing["cycle_us"], 4000.0);
  EXPECT_EQ(timing["most_share"], 0.5);
  EXPECT_EQ(timing["decisions"], 2000);
  EXPECT_GE(timing["cycles"], timing["decisions"]);
  EXPECT_GT(timing["work_p50_us"], 0.0);
  EXPECT_LE(timing["decision_p50_us"], timing["decision_p999_us"]);
  EXPECT_LE(timing["decision_p999_us"], timing["decision_worst_us"]);
  EXPECT_LE(timing["decision_p999_us"], timing["cycle_us"]);
}

// Read and written over the port every 20 ms; the interpolator's 4 ms are the control's.
TEST(Doctor, JudgesTheLayerByItsOwnCycle) {
  const Finished finished =
      run_line("doctor --machine examples/machines/vmc-840d-opcua.toml --json");
  const json answer = json::parse(finished.out);
  EXPECT_EQ(answer["timing"]["cycle_us"], 20000.0) << finished.err;
}

// A feed range without any step of the switch: the layer refuses it, and doctor reports it as a
// finding.
TEST(Doctor, FindsThatTheLayerRefusesAMachine) {
  const Scratch scratch;
  std::string text = text_of_file(project_file("examples/machines/linuxcnc-mill.toml"));
  const std::string range = "min_percent = 5\nmax_percent = 100\n";
  text.replace(text.find(range), range.size(), "min_percent = 99.11\nmax_percent = 99.15\n");
  const Finished finished =
      run({"doctor", "--machine", scratch.file("machine.toml", text), "--json"});
  EXPECT_EQ(finished.code, 1);
  const json answer = json::parse(finished.out);
  EXPECT_EQ(answer["ok"], false);
  EXPECT_TRUE(answer["timing"].is_null());
  const auto refused = std::ranges::find_if(
      answer["findings"], [](const json& finding) { return finding["check"] == "layer"; });
  ASSERT_NE(refused, answer["findings"].end());
  EXPECT_EQ((*refused)["severity"], "error");
}

TEST(Doctor, RefusesAFaultyFileByFileAndLine) {
  const std::string path = project_file("tests/refused/machine/gain-negative.toml");
  const Finished finished = run({"doctor", "--machine", path});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, IsEmpty());
  EXPECT_THAT(finished.err,
              StartsWith("steadyrest: " + path + ":12: servo_gain_1_s = -3 is out of range; "));
  const json answer = json::parse(run({"doctor", "--machine", path, "--json"}).out);
  EXPECT_EQ(answer["ok"], false);
  EXPECT_EQ(answer["findings"][0]["line"], 12);
}

TEST(Doctor, RefusesAMissingFile) {
  const Finished finished = run_line("doctor --machine none.toml");
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("steadyrest: none.toml: cannot be opened"));
  EXPECT_EQ(run_line("doctor").code, 2);
}

}  // namespace
}  // namespace steadyrest::test
