// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/testing/cases.hpp>

/// Pages and report.json of the chatter verbs.
namespace steadyrest::test {
namespace {

using kernel::testing::kSanitized;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kWanted = " --speed-rpm 5000 --depth-mm 1";
const std::string kLobesMap =
    "chatter lobes " + kSlotProcess + " --speeds-rpm 5000:10000:11 --depths-mm 0:2:9";

struct Report {
  json answer;
  json page;
};

/// Runs the verb with --report. The page must be there with the answer inside, so that page and
/// script cannot differ.
Report report_of(const std::string& line, const Scratch& scratch) {
  Report out;
  out.answer = answer_of(line + " --report " + scratch.at("report"));
  EXPECT_EQ(out.answer["report"], scratch.at("report/report.html"));
  EXPECT_THAT(text_of_file(scratch.at("report/report.html")), StartsWith("<!doctype html>"));
  out.page = json::parse(text_of_file(scratch.at("report/report.json")));
  EXPECT_EQ(out.page["schema"], "steadyrest-chatter/1");
  json without_path = out.answer;
  without_path.erase("report");
  without_path.erase("written");  // the page is one of these files
  EXPECT_EQ(out.page["answer"], without_path);
  return out;
}

/// speed, depth of the CSV beside the map.
std::vector<std::pair<double, double>> border_of(const std::string& path) {
  std::istringstream in(text_of_file(path));
  std::string line;
  std::getline(in, line);
  std::vector<std::pair<double, double>> out;
  while (std::getline(in, line)) {
    const std::size_t comma = line.find(',');
    out.emplace_back(std::stod(line.substr(0, comma)), std::stod(line.substr(comma + 1)));
  }
  return out;
}

// The page has every point of the CSV border and otherwise only gaps. The zero-order sketch must be
// near the true border, not on it.
TEST(ChatterReport, LobesHaveTheBorderOfTheCsv) {
  const Scratch scratch;
  const json page = report_of(kLobesMap + " -o " + scratch.at("map.csv"), scratch).page;
  EXPECT_EQ(page["kind"], "lobes");
  const auto csv = border_of(scratch.at("map.border.csv"));
  ASSERT_GE(csv.size(), 5U);
  std::size_t row = 0;
  for (std::size_t i = 0; i < page["border"]["speed_rpm"].size(); ++i) {
    const json& depth = page["border"]["depth_mm"][i];
    if (depth.is_null()) {
      continue;
    }
    ASSERT_LT(row, csv.size());
    EXPECT_NEAR(page["border"]["speed_rpm"][i], csv[row].first, 1e-6);
    EXPECT_NEAR(depth, csv[row].second, 1e-9 * csv[row].second);
    ++row;
  }
  EXPECT_EQ(row, csv.size());
  EXPECT_EQ(page["map"]["log_radius"].size(), 99U);
  EXPECT_EQ(page["others"][0]["name"], "zero-order sketch");
  // At 10000 rpm in the slot the sketch is within a few percent of 0.3224 mm.
  EXPECT_NEAR(page["others"][0]["depth_mm"].back(), 0.3224, 0.03);
}

// One cut, three verbs, one answer.
TEST(ChatterReport, TheWantedCutIsWhatRadiusAndPlanSayOfIt) {
  const Scratch scratch;
  const auto made =
      report_of(kLobesMap + kWanted + kOnVmc + " -o " + scratch.at("map.csv"), scratch);
  const json radius = answer_of("chatter radius " + kSlotProcess + kWanted);
  for (const char* key : {"spectral_radius", "log_radius", "stable", "type", "frequency_hz"}) {
    EXPECT_EQ(made.answer["point"][key], radius[key]) << key;
  }
  const json plan = answer_of("chatter plan " + kSlotProcess + kOnVmc + kWanted);
  ASSERT_EQ(made.page["steps"].size(), plan["alternatives"].size());
  for (std::size_t i = 0; i < plan["alternatives"].size(); ++i) {
    const json& step = made.page["steps"][i];
    const json& alternative = plan["alternatives"][i];
    EXPECT_NEAR(step["percent"], alternative["override_percent"][0], 1e-6);
    EXPECT_NEAR(step["speed_rpm"], alternative["speed_rpm"], 1e-6);
    if (step["limit_depth_mm"].is_null()) {
      EXPECT_GT(alternative["limit_depth_mm"], 2.0);  // the map's greatest depth
    } else {
      EXPECT_NEAR(step["limit_depth_mm"], alternative["limit_depth_mm"], 1e-6) << i;
    }
  }
}

// Under a law the border at constant speed is drawn too, with its published values.
TEST(ChatterReport, LobesUnderALawShowConstantSpeedBesideThem) {
  const Scratch scratch;
  // With one speed there is no border line to refine.
  const std::string speeds = kSanitized ? "10000:10000:1" : "5000:10000:2";
  const json page = report_of("chatter lobes " + kSlotProcess + " --speeds-rpm " + speeds +
                                  " --depths-mm 0:4:9 --law sine --rva 0.2 --rvf 0.1 "
                                  "-o " +
                                  scratch.at("map.csv"),
                              scratch)
                        .page;
  EXPECT_EQ(page["others"][0]["name"], "constant speed");
  EXPECT_NEAR(page["others"][0]["depth_mm"][0], kSanitized ? 0.3224 : 0.4086, 5e-5);
  EXPECT_NEAR(page["others"][0]["depth_mm"].back(), 0.3224, 5e-5);
  EXPECT_GT(page["border"]["depth_mm"].back(), 2.0);
}

// The square law: 6000 rpm in the first half of 0.12 s, 4000 in the second; times near the jumps
// are left out. The plotted peak is the answer's.
TEST(ChatterReport, GrowthHasThePeakOfTheAnswerAndTheSpeedOfTheLaw) {
  const Scratch scratch;
  const auto made = report_of(
      "chatter radius " + kSlotProcess + kWanted + " --law square --rva 0.2 --rvf 0.1", scratch);
  const json& worst = made.page["courses"][made.page["worst"].get<std::size_t>()];
  double peak = 0.0;
  for (const json& value : worst["log_growth"]) {
    peak = std::max(peak, value.get<double>());
  }
  EXPECT_NEAR(std::exp(peak), made.answer["peak_growth"], 1e-4 * std::exp(peak));
  EXPECT_EQ(worst["time_s"].size(), worst["log_growth"].size());
  EXPECT_NEAR(made.page["law_period_s"], 0.12, 1e-9);
  const json& speed = made.page["speed"];
  for (std::size_t i = 0; i < speed["time_s"].size(); ++i) {
    const double phase = std::fmod(speed["time_s"][i].get<double>(), 0.12) / 0.12;
    if (std::abs(phase - 0.5) > 1e-3 && phase > 1e-3 && phase < 1.0 - 1e-3) {
      EXPECT_NEAR(speed["speed_rpm"][i], phase < 0.5 ? 6000.0 : 4000.0, 1e-6) << phase;
    }
  }
}

// 5000 rpm make one turn in 12 ms: 25 in 0.3 s.
TEST(ChatterReport, SimulationHasItsPeakAndOnePointForEachRevolution) {
  const Scratch scratch;
  const auto made =
      report_of("chatter simulate " + kSlotProcess + kWanted + " --seconds 0.3", scratch);
  const json& envelope = made.page["envelope"];
  double most = 0.0;
  for (const char* column : {"x_low_um", "x_high_um"}) {
    for (const json& value : envelope[column]) {
      most = std::max(most, std::abs(value.get<double>()));
    }
  }
  EXPECT_NEAR(most, made.answer["peak_um"], 1e-3);  // this tool moves along x alone
  const auto turns = made.page["turns"]["t_s"].get<std::vector<double>>();
  EXPECT_EQ(turns.size(), 25U);  // 0.3 s at 5000 rpm
  EXPECT_NEAR(turns.front(), 0.012, 1e-6);
  EXPECT_NEAR(turns[20] - turns[19], 0.012, 1e-6);
}

// The spectrogram is checked where the detector found the chatter.
TEST(ChatterReport, DetectionHasTheRecordingWithItsLoudestLine) {
  const Scratch scratch;
  const auto made =
      report_of("chatter detect examples/logs/slot-chatter.csv" + kOnVmc + " --teeth 2", scratch);
  const json& s = made.page["spectrogram"];
  const auto rows = s["rows"].get<std::size_t>();
  const auto levels = s["level_db"].get<std::vector<int>>();
  ASSERT_EQ(levels.size(), rows * s["columns"].get<std::size_t>());
  // The last column, within the chatter: the loudest cell is at the reported frequency.
  const auto column = levels.end() - static_cast<std::ptrdiff_t>(rows);
  const auto loudest = static_cast<double>(std::ranges::max_element(column, levels.end()) - column);
  const double row_hz = s["row_hz"];
  EXPECT_NEAR(loudest * row_hz, made.answer["events"][0]["frequency_hz"], row_hz);
  EXPECT_NEAR(made.page["course"]["speed_rpm"][0], 5000.0, 1e-6);
}

// All 15 steps, and a map that reaches beyond the lowest and the highest.
TEST(ChatterReport, PlanShowsTheLobesOverTheSteps) {
  const Scratch scratch;
  const auto made = report_of("chatter plan " + kSlotProcess + kOnVmc + kWanted, scratch);
  EXPECT_EQ(made.page["kind"], "plan");
  EXPECT_EQ(made.page["steps"].size(), 15U);
  EXPECT_NEAR(made.page["steps"][10]["limit_depth_mm"], 0.4086, 1e-4);
  EXPECT_LT(made.page["map"]["speed_rpm"].front(), 2500.0);
  EXPECT_GT(made.page["map"]["speed_rpm"].back(), 6000.0);
}

TEST(ChatterReport, SaysToPeopleWhereItIs) {
  const Scratch scratch;
  const Finished finished =
      run_line("chatter radius " + kSlotProcess + kWanted + " --report " + scratch.at("a/b"));
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.out, HasSubstr("report: " + scratch.at("a/b/report.html")));
}

// A file where the folder should be, and incomplete cuts.
TEST(ChatterReport, RefusesWhatItCannotWriteOrPlace) {
  const Scratch scratch;
  const std::string file = scratch.file("file", "");
  const std::string lobes = kLobesMap + " -o " + scratch.at("map.csv");
  expect_refused("chatter radius " + kSlotProcess + kWanted + " --report " + file,
                 "Not a directory");
  expect_refused("chatter simulate " + kSlotProcess + kWanted + " --report " + file,
                 "Not a directory");
  expect_refused("chatter plan " + kSlotProcess + kOnVmc + kWanted + " --report " + file,
                 "Not a directory");
  expect_refused(
      "chatter detect examples/logs/slot-chatter.csv --teeth 2" + kOnVmc + " --report " + file,
      "Not a directory");
  expect_refused(lobes + " --report " + file, "Not a directory");
  expect_refused(lobes + " --speed-rpm 5000", "belong together");
  expect_refused(lobes + " --depth-mm 1", "belong together");
  expect_refused(lobes + " --speed-rpm 0 --depth-mm 1", "--speed-rpm 0 is not above 0");
  expect_refused(lobes + " --speed-rpm 5000 --depth-mm nan", "--depth-mm nan");
  expect_refused(lobes + kOnVmc, "--machine without");
  expect_refused(lobes + kWanted + " --machine no.toml", "no.toml");
}

}  // namespace
}  // namespace steadyrest::test
