// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

/// How a report tells how it was made.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

const std::string kTapped = "examples/processes/slot-tapped.toml";
const std::string kRadius = " --speed-rpm 5000 --depth-mm 0.2 --report ";

/// By another program: coreutils' sha256sum.
std::string sha256sum(const std::string& file) {
  FILE* const pipe = ::popen(("sha256sum '" + project_file(file) + "'").c_str(), "r");
  std::array<char, 65> hash{};
  EXPECT_EQ(std::fread(hash.data(), 1, 64, pipe), 64U);
  ::pclose(pipe);
  return hash.data();
}

json made_by(const std::string& line, const std::string& folder) {
  answer_of(line + folder);
  return json::parse(text_of_file(folder + "/report.json"))["made"];
}

TEST(ReportMade, SaysDateCommandAndHashesOfItsInputs) {
  const Scratch scratch;
  const json made = made_by("chatter radius " + kSlotProcess + kRadius, scratch.at("out"));
  EXPECT_THAT(made["date"].get<std::string>(),
              MatchesRegex("20[0-9]{2}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"));
  EXPECT_THAT(made["command"].get<std::string>(),
              HasSubstr("steadyrest chatter radius " + kSlotProcess + kRadius + scratch.at("out")));
  ASSERT_EQ(made["inputs"].size(), 1U);
  EXPECT_EQ(made["inputs"][0]["file"], kSlotProcess);
  EXPECT_EQ(made["inputs"][0]["sha256"], sha256sum(kSlotProcess));
  EXPECT_THAT(made["command"].get<std::string>(), Not(HasSubstr("bin/")));
}

// The process file names a tap test; both are inputs.
TEST(ReportMade, NamesWhatAnInputNames) {
  const Scratch scratch;
  const json made = made_by("chatter radius " + kTapped + kRadius, scratch.at("out"));
  ASSERT_EQ(made["inputs"].size(), 2U);
  EXPECT_EQ(made["inputs"][1]["file"], kTapTest);
  EXPECT_EQ(made["inputs"][1]["sha256"], sha256sum(kTapTest));
}

TEST(ReportMade, TakesTheDateThatIsGiven) {
  const Scratch scratch;
  const std::string fit = "chatter fit " + kTapTest + " --axis x --report-date ";
  EXPECT_EQ(made_by(fit + "2026-01-02 --report ", scratch.at("a"))["date"], "2026-01-02");
  EXPECT_TRUE(made_by(fit + "none --report ", scratch.at("b"))["date"].is_null());
  expect_refused(fit + "tomorrow --report " + scratch.at("c"), "tomorrow is neither a date");
}

TEST(ReportMade, IsInTheReportOfEachNewPage) {
  const Scratch scratch;
  const json fit = made_by("chatter fit " + kTapTest + " --axis x --report ", scratch.at("fit"));
  EXPECT_EQ(fit["inputs"][0]["sha256"], sha256sum(kTapTest));
  const std::string log = "examples/logs/sine-edges.csv";
  const json estimate =
      made_by("motion estimate " + log + " --input edges --count-mm 0.001 --cycle-hz 1000 -o " +
                  scratch.at("out.csv") + " --report ",
              scratch.at("estimate"));
  EXPECT_EQ(estimate["inputs"][0]["sha256"], sha256sum(log));
}

// ticks_each is 1 here, so each stretch is one row of the table.
TEST(MotionEstimateReport, HoldsWhatTheTableHolds) {
  const Scratch scratch;
  answer_of(
      "motion estimate examples/logs/sine-edges.csv --input edges --count-mm 0.001 "
      "--cycle-hz 1000 --max-acceleration 25 --max-jerk 300 -o " +
      scratch.at("out.csv") + " --report " + scratch.at("out"));
  const json page = json::parse(text_of_file(scratch.at("out/report.json")));
  EXPECT_EQ(page["schema"], "steadyrest-motion/1");
  EXPECT_EQ(page["ticks_each"], 1);
  std::istringstream table(text_of_file(scratch.at("out.csv")));
  std::string line;
  std::getline(table, line);
  for (std::size_t i = 0; std::getline(table, line); ++i) {
    std::array<double, 3> row{};
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", row.data(), &row[1], &row[2]), 3);
    EXPECT_NEAR(page["t_s"].at(i), row[0], 1e-6);
    EXPECT_NEAR(page["velocity_mm_s"]["low"].at(i), row[2], 1e-4 + 1e-5 * std::abs(row[2]));
  }
}

TEST(ChatterFitReport, HoldsTheMeasurementAndTheFit) {
  const Scratch scratch;
  const json fit = answer_of("chatter fit " + kTapTest + " --axis x --report " + scratch.at("out"));
  const json page = json::parse(text_of_file(scratch.at("out/report.json")));
  EXPECT_EQ(page["kind"], "fit");
  EXPECT_EQ(page["measured"][0]["name"], "tap-922hz.csv");
  EXPECT_EQ(page["measured"][0]["frequency_hz"].size(), fit["points"]);
  EXPECT_GT(page["fitted"]["real_um_N"].size(), 1000U);
}

}  // namespace
}  // namespace steadyrest::test
