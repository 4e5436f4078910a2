// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kChatterPlan = "chatter plan examples/processes/slot-922hz.toml ";
const std::string kWithVmc = "--machine examples/machines/vmc-840d.toml ";

// Borders from the table of converged values: 5000 rpm is stable to 0.4086 mm, 110 % of it, 5500
// rpm, to 2.7653 mm. The machine has 15 spindle steps; 100 % is index 10.
TEST(ChatterPlan, TakesTheOverrideStepIntoTheStablePocket) {
  const json plan = answer_of(kChatterPlan + kWithVmc + "--speed-rpm 5000 --depth-mm 1");
  EXPECT_EQ(plan["decision"], "constant");
  EXPECT_EQ(plan["override_percent"], json::array({110.0}));
  EXPECT_EQ(plan["law"], "constant");
  EXPECT_EQ(plan["rva"], 0.0);
  EXPECT_EQ(plan["rvf"], 0.0);
  EXPECT_NEAR(plan["limit_depth_mm"], 2.7653, 1e-3);
  EXPECT_NEAR(plan["speed_rpm"], 5500.0, 1e-9);
  EXPECT_EQ(plan["alternatives"].size(), 15U);
  EXPECT_NEAR(plan["alternatives"][10]["limit_depth_mm"], 0.4086, 1e-4);
  EXPECT_FALSE(plan["alternatives"][10]["reasons"].empty());
}

// Ranked, within the spindle's limits, and stable by `chatter radius` at 95 % of the depth that
// they promise.
TEST(ChatterPlan, NamesTheBestSpeedsOfTheSpindle) {
  const json plan = answer_of(kChatterPlan + kWithVmc + "--speed-rpm 5000 --depth-mm 1");
  const json& best = plan["best_speeds"];
  ASSERT_GE(best.size(), 2U);
  double last = 1e9;
  for (const json& one : kernel::testing::cases(best)) {
    const double rpm = one["speed_rpm"];
    EXPECT_GT(rpm, 0.0);
    EXPECT_LE(rpm, 12000.0 * (1.0 + 1e-9));
    const double sure = one["sure_depth_mm"].is_null() ? 5.0 : one["sure_depth_mm"].get<double>();
    EXPECT_LE(sure, last);
    last = sure;
    const json radius =
        answer_of("chatter radius examples/processes/slot-922hz.toml --speed-rpm " +
                  std::to_string(rpm) + " --depth-mm " + std::to_string(0.95 * sure));
    EXPECT_EQ(radius["stable"], true) << rpm;
  }
  EXPECT_THAT(run_line(kChatterPlan + kWithVmc + "--speed-rpm 5000 --depth-mm 1").out,
              HasSubstr("best spindle speeds"));
}

TEST(ChatterPlan, KeepsWhatIsStable) {
  const json plan = answer_of(kChatterPlan + kWithVmc + "--speed-rpm 5500 --depth-mm 1");
  EXPECT_EQ(plan["decision"], "keep");
  EXPECT_EQ(plan["override_percent"], json::array({100.0}));
}

// A triangle needs RVA·RVF·n²/15 = 0.2·0.1·5000²/15 = 33 333 rpm/s; the example's drive makes 4000
// rpm/s.
TEST(ChatterPlan, SaysWhyALawCannotBe) {
  const std::string line = kChatterPlan + kWithVmc +
                           "--speed-rpm 5000 --depth-mm 1 --laws-only --laws triangle --rva 0.2 ";
  const json plan = answer_of(line + "--rvf 0.1");
  EXPECT_EQ(plan["decision"], "nothing");
  const json law = plan["alternatives"].back();
  EXPECT_EQ(law["law"], "triangle");
  EXPECT_NEAR(law["amplitude_rpm"], 1000.0, 1e-9);
  EXPECT_NEAR(law["period_s"], 0.12, 1e-9);
  EXPECT_THAT(law["reasons"][0], HasSubstr("needs 33333 rpm/s, the drive delivers 4000 rpm/s"));
}

TEST(ChatterPlan, LawsAloneThatDoNotHelpNameTheStepThatDoes) {
  const std::string line =
      kChatterPlan + kWithVmc +
      "--speed-rpm 5000 --depth-mm 1 --laws-only --laws triangle --rva 0.2 --rvf 0.1";
  EXPECT_EQ(answer_of(line)["helping_override_percent"], 110.0);
  EXPECT_THAT(run_line(line).out,
              HasSubstr("No law helps at 1 mm; a constant 110 % = 5500 rpm does\n"));
}

TEST(ChatterPlan, SpeaksToPeople) {
  const std::string text = run_line(kChatterPlan + kWithVmc + "--speed-rpm 5000 --depth-mm 1").out;
  EXPECT_THAT(text, HasSubstr("Set the spindle override to 110 % = 5500 rpm\n"));
  EXPECT_THAT(text, HasSubstr("100 % = 5000 rpm: unstable from 0.4086 mm on\n"));
  EXPECT_THAT(text, HasSubstr("the spindle override on the panel must be 110 % or more"));
}

TEST(ChatterPlan, RefusesBadUsage) {
  const std::string line = kChatterPlan + kWithVmc;
  expect_all_refused({line, line + "--speed-rpm 5000", line + "--speed-rpm 0 --depth-mm 1",
                      line + "--speed-rpm 5000 --depth-mm -1",
                      line + "--speed-rpm nan --depth-mm 1",
                      line + "--speed-rpm 5000 --depth-mm 1 --laws waltz",
                      line + "--speed-rpm 5000 --depth-mm 1 --laws constant",
                      line + "--speed-rpm 5000 --depth-mm 1 --rva 1.5",
                      line + "--speed-rpm 5000 --depth-mm 1 --samples 0",
                      line + "--speed-rpm 5000 --depth-mm 1 --most-depth-mm 0.5",
                      line + "--speed-rpm 5000 --depth-mm 1 --probability-percent 101"});
  expect_refused(kChatterPlan + "--machine nowhere.toml --speed-rpm 5000 --depth-mm 1");
  expect_refused("chatter plan nowhere.toml " + kWithVmc + "--speed-rpm 5000 --depth-mm 1");
}

}  // namespace
}  // namespace steadyrest::test
