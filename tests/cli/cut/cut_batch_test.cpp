// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

/// `cut --batch`: the thermal error of a day's parts; and the pages of the thermal verbs.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

// A short program, so that the cut itself takes no time; the batch has the machine of the example.
const std::string kShort =
    "cut examples/programs/circle-r10.ngc --machine examples/thermal-batch/machine.toml";

// The batch adds its keys and changes none of the cut's; the band is k3 times the tolerance,
// 0.35·10 µm.
TEST(CutBatch, StandsBesideTheKeysOfTheCut) {
  const json answer = answer_of(kShort + " --batch 3 --pause-min 10");
  EXPECT_TRUE(answer["without"]["contour_error_max_mm"].is_number());
  EXPECT_TRUE(answer["with"]["contour_error_max_mm"].is_number());
  const json& batch = answer["batch"];
  ASSERT_EQ(batch["parts"].size(), 3U);
  EXPECT_EQ(batch["axes"], json({"Z"}));
  EXPECT_NEAR(batch["band_um"].get<double>(), 3.5, 1e-9);  // k3 of 10 µm
  EXPECT_NEAR(batch["parts"][1]["start_s"].get<double>(), 600.0 + batch["program_s"].get<double>(),
              1.0);
  for (const char* way : {"without", "text", "online"}) {
    EXPECT_GE(batch[way]["largest_um"], batch[way]["rms_um"]) << way;
    EXPECT_TRUE(batch["parts"][2][way]["largest_um"].is_number()) << way;
  }
  EXPECT_FALSE(answer_of(kShort).contains("batch"));
}

TEST(CutBatch, TakesItsToleranceFromTheCommandLine) {
  EXPECT_NEAR(answer_of(kShort + " --batch 1 --tolerance-um 4")["batch"]["band_um"].get<double>(),
              1.4, 1e-9);
}

TEST(CutBatch, RefusesWhatMakesNoBatch) {
  expect_refused(
      "cut examples/programs/circle-r10.mpf --machine examples/machines/vmc-840d.toml "
      "--batch 3",
      "[compensation]");
  expect_refused(
      "cut examples/programs/circle-r10.ngc --machine "
      "examples/machines/linuxcnc-mill.toml --batch 3",
      "no [[thermal.axis]] for any of its axes");
  expect_refused(kShort + " --pause-min 3", "--batch");
  expect_refused(kShort + " --batch 3 --break-min 30", "--break-after");
  expect_refused(kShort + " --batch 0", "--batch");
}

json page_of(const std::string& folder) {
  EXPECT_THAT(text_of_file(folder + "/report.html"), StartsWith("<!doctype html>"));
  return json::parse(text_of_file(folder + "/report.json"));
}

TEST(CutBatch, WritesItsPageBesideThatOfTheCut) {
  const Scratch scratch;
  const json answer = answer_of(kShort + " --batch 2 --report " + scratch.at("out"));
  EXPECT_EQ(answer["report"], scratch.at("out/report.html"));
  EXPECT_EQ(answer["batch"]["report"], scratch.at("out/batch/report.html"));
  const json page = page_of(scratch.at("out/batch"));
  EXPECT_EQ(page["schema"], "steadyrest-thermal/1");
  EXPECT_EQ(page["kind"], "batch");
  EXPECT_EQ(page["answer"]["parts"], answer["batch"]["parts"]);
  EXPECT_EQ(page["course"]["t_min"].size(), page["course"]["online_um"].size());
}

// The instants of the paper's example (Marusich 2012).
TEST(ThermalReport, OfAPlanHasTheCorrectionsOfThePaper) {
  const Scratch scratch;
  const json answer =
      answer_of("thermal plan" + kPaperWork + " --tolerance-um 10 --report " + scratch.at("out"));
  EXPECT_EQ(answer["report"], scratch.at("out/report.html"));
  const json page = page_of(scratch.at("out"));
  EXPECT_EQ(page["kind"], "plan");
  json instants = json::array();
  for (const json& one : page["courses"][0]["corrections"]) {
    instants.push_back(one["t_min"]);
  }
  EXPECT_EQ(instants, json({18.0, 45.0, 75.0, 115.0}));
}

TEST(ThermalReport, OfAForecastHasItsCurveAndItsBand) {
  const Scratch scratch;
  answer_of("thermal forecast" + kPaperWork + " --report " + scratch.at("out"));
  const json page = page_of(scratch.at("out"));
  EXPECT_EQ(page["kind"], "forecast");
  EXPECT_EQ(page["transitions"].size(), 5U);
  EXPECT_EQ(page["courses"][0]["t_min"].size(), page["courses"][0]["sd_um"].size());
  expect_refused("thermal forecast" + kPaperWork + " --report /dev/null/out", "/dev/null/out");
}

}  // namespace
}  // namespace steadyrest::test
