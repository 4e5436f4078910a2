// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

const std::string kPaperPlan = "examples/paper-thermal/plan.json";
const std::string kAdapt =
    "thermal adapt " + kPaperPlan + " --measured examples/paper-thermal/measured.csv";

std::string adapt(const Scratch& scratch, const std::string& csv, const std::string& more = "") {
  return "thermal adapt " + kPaperPlan + " --measured " + scratch.file("measured.csv", csv) + more;
}

// The stored plan equals the verb's present output: the other tests rely on it.
TEST(ThermalAdapt, ItsExampleIsThePlanOfThePapersExample) {
  const Scratch scratch;
  answer_of(
      "thermal plan --machine examples/paper-thermal/machine.toml --cyclogram "
      "examples/paper-thermal/cyclogram.toml --tolerance-um 10 --level 0 -o " +
      scratch.at("plan.json"));
  const auto written = nlohmann::json::parse(text_of_file(scratch.at("plan.json")));
  const auto stored = nlohmann::json::parse(text_of_file(project_file(kPaperPlan)));
  EXPECT_EQ(written["transitions"], stored["transitions"]);
  EXPECT_EQ(written["k"], stored["k"]);
}

// The parts were measured on a machine that grows 1.1 times as far as its passport says; 1.3 times
// k·Δ at the end calls for the next level.
TEST(ThermalAdapt, FindsTheGainOfTheExamplesMachineAndTheNextLevel) {
  const auto answer = answer_of(kAdapt);
  EXPECT_EQ(answer["level_before"], 0);
  EXPECT_EQ(answer["level"], 1) << "the last parts are 13 µm off, their share is 10";
  EXPECT_EQ(answer["k"], 0.7);
  EXPECT_TRUE(answer["fits"].get<bool>());
  EXPECT_EQ(answer["reason"], "none");
  EXPECT_TRUE(answer["outliers"].empty());
  const auto& z = answer["axes"][0];
  EXPECT_NEAR(z["gain"][0].get<double>(), 1.1, 0.02);
  EXPECT_LT(z["rms_after_um"].get<double>(), 0.6);
  EXPECT_GT(z["rms_before_um"].get<double>(), 3.0);
}

// The new passport forecasts the real growth: 48.79 µm, the example's final value, times the gain.
TEST(ThermalAdapt, WritesTheMachineFileByWhichTheNextPlanIsRight) {
  const Scratch scratch;
  const std::string machine = scratch.at("new.toml");
  const auto answer = answer_of(kAdapt + " -o " + machine);
  const std::string text = text_of_file(machine);
  EXPECT_NE(text.find("level = 1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("[spindle]\nmax_rpm = 4000"), std::string::npos) << "the rest stays";
  const auto plan = answer_of("thermal plan --machine " + machine +
                              " --cyclogram examples/paper-thermal/cyclogram.toml "
                              "--tolerance-um 10");
  EXPECT_EQ(plan["k"], 0.7) << "the level in force";
  const double gain = answer["axes"][0]["gain"][0].get<double>();
  EXPECT_NEAR(plan["axes"][0]["max_um"].get<double>(), 48.79 * gain, 0.05);
  const auto again = answer_of("thermal forecast --machine " + machine +
                               " --cyclogram examples/paper-thermal/cyclogram.toml");
  EXPECT_NEAR(again["max_um"].get<double>(), 48.79 * gain, 0.05);
}

// All parts at 2 µm, below half of k·Δ: one level back.
TEST(ThermalAdapt, PartsWellInsideGoBackOneLevel) {
  const Scratch scratch;
  answer_of(
      "thermal plan --machine examples/paper-thermal/machine.toml --cyclogram "
      "examples/paper-thermal/cyclogram.toml --tolerance-um 10 --level 2 -o " +
      scratch.at("plan.json"));
  std::string csv = "part,transition,deviation_um,tolerance_um\n";
  for (int part = 1; part <= 6; ++part) {
    csv += std::to_string(part) + ",stage 5,2.0,10\n";
  }
  const auto answer = answer_of("thermal adapt " + scratch.at("plan.json") + " --measured " +
                                scratch.file("measured.csv", csv));
  EXPECT_EQ(answer["level_before"], 2);
  EXPECT_EQ(answer["level"], 1);
  EXPECT_EQ(answer["k"], 0.7);
}

// Alternating ±60 µm: no gain explains that. The level still rises, the gains stay.
TEST(ThermalAdapt, SaysWhenTheModelNoLongerFitsAndKeepsItsGains) {
  const Scratch scratch;
  std::string csv = "part,time_min,deviation_um\n";
  for (int part = 1; part <= 10; ++part) {
    csv += std::to_string(part) + "," + std::to_string(30 * part) +
           (part % 2 == 0 ? ",60\n" : ",-60\n");
  }
  const auto answer = answer_of(adapt(scratch, csv, " -o " + scratch.at("new.toml")));
  EXPECT_FALSE(answer["fits"].get<bool>());
  EXPECT_EQ(answer["reason"], "thermal_model_unfit");
  EXPECT_EQ(answer["level"], 1);
  EXPECT_NE(text_of_file(scratch.at("new.toml")).find("levels_um = [0, 35.2245, 49.0785]"),
            std::string::npos);
  const Finished shown = run_line(adapt(scratch, csv));
  EXPECT_NE(shown.out.find("fit it again"), std::string::npos) << shown.out;
}

// One part with a chip under it among good ones.
TEST(ThermalAdapt, NamesAnOutlierAndLeavesItOut) {
  const Scratch scratch;
  std::string csv = text_of_file(project_file("examples/paper-thermal/measured.csv"));
  csv += "chip under it,200,-45\n";
  const auto answer = answer_of(adapt(scratch, csv));
  ASSERT_EQ(answer["outliers"].size(), 1U);
  EXPECT_EQ(answer["outliers"][0]["part"], "chip under it");
  EXPECT_EQ(answer["outliers"][0]["line"], 15);
  EXPECT_TRUE(answer["fits"].get<bool>());
  EXPECT_NEAR(answer["axes"][0]["gain"][0].get<double>(), 1.1, 0.02);
}

// Three parts do not show which one is wrong: all count for the level, none for the gains.
TEST(ThermalAdapt, OfThreePartsOutliersCountForTheLevelAndTheGainsStay) {
  const Scratch scratch;
  const std::string far = "part,time_min,deviation_um\na,5,900\nb,98,-900\nc,192,900\n";
  const auto answer = answer_of(adapt(scratch, far, " -o " + scratch.at("new.toml")));
  EXPECT_EQ(answer["outside"], 3);
  EXPECT_EQ(answer["level"], 1);
  EXPECT_FALSE(answer["fits"].get<bool>());
  EXPECT_EQ(answer["outliers"].size(), 3U);
  EXPECT_NE(text_of_file(scratch.at("new.toml")).find("levels_um = [0, 35.2245, 49.0785]"),
            std::string::npos);
  const Finished shown = run_line(adapt(scratch, far));
  EXPECT_NE(shown.out.find("outlier: line 3, part b, -900.0 µm"), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("Outliers count towards the level"), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("3 parts are too few"), std::string::npos) << shown.out;
}

// The first one, two, three, four lines of the example: from the fourth part on gains change.
TEST(ThermalAdapt, ThreeGoodPartsAreTooFewForTheGainsToo) {
  const Scratch scratch;
  const std::string all = text_of_file(project_file("examples/paper-thermal/measured.csv"));
  std::size_t end = 0;
  for (int line = -1; line < 5; ++line) {  // a comment and the head come first
    end = all.find('\n', end) + 1;
    if (line > 0) {
      const auto answer =
          answer_of(adapt(scratch, all.substr(0, end), " -o " + scratch.at("new.toml")));
      const bool enough = line >= 4;
      EXPECT_TRUE(answer["fits"].get<bool>());
      EXPECT_EQ(answer["axes"][0]["gains_kept"], !enough) << line << " parts";
      EXPECT_EQ(text_of_file(scratch.at("new.toml")).find("levels_um = [0, 35.2245, 49.0785]") ==
                    std::string::npos,
                enough)
          << line << " parts";
    }
  }
}

// A plan written by hand: no machine, no work. The level needs only parts and tolerances.
TEST(ThermalAdapt, APlanThatNamesNoWorkStillGivesTheLevel) {
  const Scratch scratch;
  const std::string plan = scratch.file(
      "plan.json",
      R"({"axis": "Z", "transitions": [{"n": 1, "t_min": [60], "delta_um": [0]}], "level": 0})");
  const std::string csv =
      scratch.file("measured.csv", "part,transition,deviation_um,tolerance_um\n1,1,15,10\n");
  const auto answer = answer_of("thermal adapt " + plan + " --measured " + csv +
                                " --machine examples/paper-thermal/machine.toml");
  EXPECT_EQ(answer["level"], 1);
  EXPECT_TRUE(answer["axes"].empty());
  expect_refused("thermal adapt " + plan + " --measured " + csv, "names no machine file");
  expect_refused("thermal adapt " + plan + " --measured " + csv +
                     " --machine examples/paper-thermal/machine.toml --cyclogram "
                     "examples/paper-thermal/cyclogram.toml",
                 "the plan lasts");
}

TEST(ThermalAdapt, RefusesWhatDoesNotFitThePlan) {
  const Scratch scratch;
  expect_refused(adapt(scratch, ""), "no measured part");
  expect_refused(adapt(scratch, "part,time_min,deviation_um\n1,301,3\n"), "after the plan's end");
  expect_refused(adapt(scratch, "part,transition,deviation_um\n1,6,3\n"), "no transition 6");
  expect_refused(adapt(scratch, "part,transition,deviation_um\n1,stage 9,3\n"),
                 "no transition stage 9");
  expect_refused(adapt(scratch, "part,axis,transition,deviation_um\n1,X,1,3\n"), "no axis X");
  expect_refused(adapt(scratch, "part,time_min,deviation\n1,30,3\n"), "deviation is unknown");
  expect_refused(adapt(scratch, "part,time_min,deviation_mm\n1,30,3\n"), "check the unit");
  expect_refused("thermal adapt " + kPaperPlan, "--measured");
  expect_refused("thermal adapt nosuch.json --measured x.csv", "give the path of a plan (JSON)");
  expect_refused("thermal adapt examples --measured x.csv", "is a folder; give the path of a plan");
  expect_refused("thermal adapt " + kPaperPlan + " --measured nosuch.csv", "CSV of measured parts");
  expect_refused("thermal adapt " + kPaperPlan + " --measured examples", "CSV of measured parts");
  for (const char* verb : {"forecast", "plan --tolerance-um 10"}) {
    const std::string work = std::string("thermal ") + verb +
                             " --machine examples/paper-thermal/machine.toml --cyclogram ";
    expect_refused(work + "nosuch.toml", "give the path of a cyclogram");
    expect_refused(work + scratch.file("empty.toml", ""), "is empty; give a cyclogram (TOML)");
  }
  expect_refused("thermal adapt examples/paper-thermal/machine.toml --measured x.csv", "not JSON");
}

}  // namespace
}  // namespace steadyrest::test
