// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::test {
namespace {

using kernel::testing::cases;
using kernel::testing::kSanitized;
using nlohmann::json;
using testing::HasSubstr;

const std::string kSlotRadius = "chatter radius examples/processes/slot-922hz.toml";
const std::string kPoint = kSlotRadius + " --speed-rpm 5000 --depth-mm 1";

// Converged values of reference tables (spectral collocation, 8 digits), not the literature's
// three.
TEST(ChatterRadius, GivesTheConvergedRadiusOfTheSlot) {
  const json stable = answer_of(kSlotRadius + " --speed-rpm 5000 --depth-mm 0.2");
  EXPECT_NEAR(stable["spectral_radius"], 0.81974278, 1e-7);
  EXPECT_EQ(stable["stable"], true);
  EXPECT_EQ(stable["type"], "none");
  EXPECT_EQ(stable["passes"], 1);
  EXPECT_EQ(stable["law"], "constant");
  const json unstable = answer_of(kPoint);
  EXPECT_NEAR(unstable["spectral_radius"], 1.40647353, 1e-7);
  EXPECT_NEAR(unstable["log_radius"], std::log(1.40647353), 1e-7);
  EXPECT_EQ(unstable["stable"], false);
  EXPECT_EQ(unstable["type"], "hopf");
  EXPECT_GT(unstable["frequency_hz"], 900.0);
  EXPECT_LT(unstable["frequency_hz"], 1100.0);
  const std::string half = "chatter radius examples/processes/half-down-922hz.toml";
  EXPECT_NEAR(answer_of(half + " --speed-rpm 5000 --depth-mm 1")["spectral_radius"], 1.086208,
              1e-6);
}

// At constant speed there is no period: the worst vibration is followed over 20 passes and grows by
// at least ρ per pass.
TEST(ChatterRadius, SaysOverHowManyPassesItFollowsTheWorstGrowth) {
  EXPECT_THAT(run_line(kPoint).out, HasSubstr("worst growth within 20 tooth passes"));
  EXPECT_GT(answer_of(kPoint)["peak_growth"], std::pow(1.40647, 20.0));
  // A law of 20 passes: two periods.
  EXPECT_THAT(run_line(kPoint + " --law triangle --rva 0.2 --rvf 0.1").out,
              HasSubstr("worst growth within 40 tooth passes"));
}

// RVA 0.2 and RVF 0.1 at 5000 rpm are ±1000 rpm every 0.12 s: all notations give the same law.
TEST(ChatterRadius, TakesAModulationInRatiosAndInTheWordsOfTheShopFloor) {
  const json ratios = answer_of(kPoint + " --law sine --rva 0.2 --rvf 0.1");
  EXPECT_NEAR(ratios["spectral_radius"], 0.0446131, 5e-7);
  EXPECT_EQ(ratios["passes"], 20);
  EXPECT_EQ(ratios["stable"], true);
  EXPECT_NEAR(ratios["amplitude_rpm"], 1000.0, 1e-9);
  EXPECT_NEAR(ratios["period_s"], 0.12, 1e-12);
  EXPECT_FALSE(ratios.contains("wanted_rvf"));
  EXPECT_NEAR(ratios["frequency_hz"], 922.0, 100.0);
  EXPECT_NEAR(ratios["frequency_step_hz"], 1.0 / 0.12, 1e-9);
  const double log_radius = ratios["log_radius"];
  for (const char* words : cases({" --amplitude-rpm 1000", " --amplitude-percent 20"})) {
    const json same = answer_of(kPoint + " --law sine --period-s 0.12" + words);
    EXPECT_NEAR(same["log_radius"], log_radius, 1e-8) << words;
  }
}

// ρ = 3e-14 over the period, yet a vibration grows 921-fold on its way: the radius alone would call
// it harmless.
TEST(ChatterRadius, TellsSlowModulationThoughTheRadiusIsNothing) {
  const json slow = answer_of(kPoint + " --law triangle --rva 0.2 --rvf 0.02");
  EXPECT_NEAR(slow["log_radius"], std::log(3e-14), 0.2);
  EXPECT_NEAR(slow["spectral_radius"], 3e-14, 1e-14);
  EXPECT_GT(slow["peak_growth"], 500.0);
}

TEST(ChatterRadius, KnowsEveryLaw) {
  for (const char* law : cases({"square", "pulse", "triangle", "sine", "random", "stop"}, 4)) {
    const json found = answer_of(kPoint + " --rva 0.1 --rvf 0.5 --law " + law);
    EXPECT_EQ(found["law"], law);
    EXPECT_GT(found["spectral_radius"], 0.0) << law;
  }
  const json one = answer_of(kPoint + " --law random --rva 0.1 --rvf 0.5 --seed 7");
  const json other = answer_of(kPoint + " --law random --rva 0.1 --rvf 0.5 --seed 8");
  EXPECT_NE(one["log_radius"], other["log_radius"]);
  EXPECT_EQ(answer_of(kPoint + " --law constant")["spectral_radius"],
            answer_of(kPoint)["spectral_radius"]);
}

// 2/0.1234567891 is not a ratio of small numbers; the RVF moves by at most 0.5 %, and the answer
// says so.
TEST(ChatterRadius, MovesAPeriodToWholeToothPassesAndSaysSo) {
  // A shorter law has fewer passes.
  const std::string rvf = kSanitized ? "0.8234567891" : "0.1234567891";
  const json moved = answer_of(kPoint + " --law sine --rva 0.1 --rvf " + rvf);
  EXPECT_NEAR(moved["wanted_rvf"], std::stod(rvf), 1e-12);
  EXPECT_NEAR(moved["rvf"], std::stod(rvf), 0.005 * std::stod(rvf));
  EXPECT_LT(moved["passes"], 200);
  EXPECT_THAT(run_line(kPoint + " --law sine --rva 0.1 --rvf " + rvf).out,
              HasSubstr("RVF changed from 0." + rvf.substr(2, 5) + "7"));
}

TEST(ChatterRadius, ShowsAShortTableToPeople) {
  const std::string out = run_line(kPoint).out;
  EXPECT_THAT(out, HasSubstr("unstable (hopf)"));
  EXPECT_THAT(out, HasSubstr("1.40647"));
}

TEST(ChatterRadius, ReadsTurningAndHelix) {
  EXPECT_EQ(answer_of("chatter radius examples/processes/turning-250hz.toml --speed-rpm 800 "
                      "--depth-mm 0.5")["passes"],
            1);
  EXPECT_EQ(answer_of("chatter radius examples/processes/helical-600hz.toml --speed-rpm 6000 "
                      "--depth-mm 0.3")["stable"],
            true);
}

// One line per way to get amplitude, period, law or file wrong.
TEST(ChatterRadius, RefusesBadUsage) {
  const std::string sine = kPoint + " --law sine";
  expect_refused(kSlotRadius + " --speed-rpm 5000");
  expect_refused(kSlotRadius + " --speed-rpm 0 --depth-mm 1", "--speed-rpm 0 is not above 0");
  expect_refused(kSlotRadius + " --speed-rpm nan --depth-mm 1", "--speed-rpm nan");
  expect_refused(kSlotRadius + " --speed-rpm 5000 --depth-mm -1", "--depth-mm -1 is not above 0");
  expect_refused(kPoint + " --law saw --rva 0.1 --rvf 0.1", "saw");
  expect_refused(kPoint + " --rva 0.1 --rvf 0.1", "without a law");
  expect_refused(sine + " --rvf 0.1", "needs an amplitude");
  expect_refused(sine + " --rva 0.1", "needs a period");
  expect_refused(sine + " --rva 1 --rvf 0.1", "must be between 0 and 1");
  expect_refused(sine + " --rva nan --rvf 0.1", "--rva nan is not a finite number");
  expect_refused(sine + " --amplitude-rpm 6000 --rvf 0.1", "1.2 of the mean speed");
  expect_refused(sine + " --rva 0.1 --rvf 0", "--rvf 0");
  expect_refused(sine + " --rva 0.1 --rvf inf", "--rvf inf");
  expect_refused(sine + " --rva 0.1 --period-s -1", "--period-s -1");
  expect_refused(sine + " --rva 0.1 --rvf 0.0001", "20000 tooth passes");
  expect_refused(sine + " --rva 0.1 --amplitude-percent 10 --rvf 0.1");
  expect_refused(sine + " --rva 0.1 --period-s 1 --rvf 0.1");
  expect_refused("chatter radius no/such.toml --speed-rpm 5000 --depth-mm 1", "no/such.toml");
  const Scratch scratch;
  const std::string file = scratch.file("bad.toml", "[tool]\nteeth = 0\n[cut]\n[[mode]]\n");
  expect_refused("chatter radius " + file + " --speed-rpm 5000 --depth-mm 1", "bad.toml:2: teeth");
}

const std::string kLobes = "chatter lobes examples/processes/slot-922hz.toml";

/// Rows of numbers below the head, which must be the documented one.
std::vector<std::vector<double>> rows_of(const std::string& path, const std::string& head) {
  std::istringstream in(text_of_file(path));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, head);
  std::vector<std::vector<double>> out;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string field;
    out.emplace_back();
    while (std::getline(fields, field, ',')) {
      out.back().push_back(std::stod(field));
    }
  }
  return out;
}

// Four map points and two border points with published values; more border points in between.
TEST(ChatterLobes, WritesTheMapAndItsBorder) {
  const Scratch scratch;
  const json made = answer_of(kLobes + " --speeds-rpm 5000:10000:2 --depths-mm 0.2:0.5:2 -o " +
                              scratch.at("map.csv"));
  EXPECT_EQ(made["points"], 4);
  EXPECT_TRUE(made["border_settled"]);
  EXPECT_GE(made["seconds"], 0.0);
  const auto map = rows_of(scratch.at("map.csv"), "speed_rpm,depth_mm,spectral_radius");
  ASSERT_EQ(map.size(), 4U);
  const double wanted[] = {0.81974278, 1.07397559, 0.94084672, 1.07460805};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(map[i][0], i < 2 ? 5000.0 : 10000.0);
    EXPECT_EQ(map[i][1], i % 2 == 0 ? 0.2 : 0.5);
    EXPECT_NEAR(map[i][2], wanted[i], 1e-6);
  }
  const auto border = rows_of(scratch.at("map.border.csv"), "speed_rpm,depth_mm");
  EXPECT_EQ(made["border_points"], border.size());
  ASSERT_GE(border.size(), 20U);  // refined between the two speeds
  EXPECT_EQ(border.front()[0], 5000.0);
  EXPECT_NEAR(border.front()[1], 0.4086, 5e-5);
  EXPECT_EQ(border.back()[0], 10000.0);
  EXPECT_NEAR(border.back()[1], 0.3224, 5e-5);
}

// The border leaves the map upwards; beyond, no row says "stable to the bottom".
TEST(ChatterLobes, HasNoBorderWhereAllDepthsAreStable) {
  const Scratch scratch;
  const json made = answer_of(kLobes + " --speeds-rpm 5000:5500:2 --depths-mm 0:0.6:4 -o " +
                              scratch.at("map.csv"));
  const auto border = rows_of(scratch.at("map.border.csv"), "speed_rpm,depth_mm");
  EXPECT_EQ(made["border_points"], border.size());
  // It leaves the map between 5000 rpm, where it is 0.4086 mm, and 5500, where it is 2.7646 mm.
  ASSERT_GE(border.size(), 2U);
  EXPECT_EQ(border.front()[0], 5000.0);
  EXPECT_LT(border.back()[0], 5500.0);
  EXPECT_NEAR(border.back()[1], 0.6, 0.01);
}

TEST(ChatterLobes, TakesALaw) {
  const Scratch scratch;
  const json made = answer_of(kLobes + " --speeds-rpm 5000:5000:1 --depths-mm 1 --law sine " +
                              "--rva 0.2 --rvf 0.1 -o " + scratch.at("map.csv"));
  EXPECT_EQ(made["law"], "sine");
  const auto map = rows_of(scratch.at("map.csv"), "speed_rpm,depth_mm,spectral_radius");
  ASSERT_EQ(map.size(), 1U);
  EXPECT_NEAR(map[0][2], 0.0446131, 5e-7);
}

// FROM:TO:STEPS in every broken spelling.
TEST(ChatterLobes, RefusesBadUsage) {
  const std::string speeds = kLobes + " --speeds-rpm 5000:6000:3";
  const Scratch scratch;
  const std::string out = " -o " + scratch.at("map.csv");
  expect_refused(speeds + " --depths-mm 0:1:3");
  expect_refused(speeds + " --depths-mm 0:1" + out, "three separated by colons");
  expect_refused(speeds + " --depths-mm 0:1:2:3" + out, "three separated by colons");
  expect_refused(speeds + " --depths-mm 0:x:2" + out, "three separated by colons");
  expect_refused(speeds + " --depths-mm 0:1:0" + out, "STEPS");
  expect_refused(speeds + " --depths-mm 0:1:2.5" + out, "STEPS");
  expect_refused(speeds + " --depths-mm 1:0:5" + out, "TO is not above FROM");
  expect_refused(speeds + " --depths-mm -1:1:5" + out, "smallest value allowed is 0");
  expect_refused(speeds + " --depths-mm 0:inf:5" + out, "three separated by colons");
  expect_refused(speeds + " --depths-mm 0" + out, "depths");
  expect_refused(kLobes + " --speeds-rpm 0:1000:3 --depths-mm 0:1:3" + out, "smallest value");
  expect_refused(speeds + " --depths-mm 0:1:3 --law sine --rva 0.1 --period-s 1" + out,
                 "with several speeds");
  EXPECT_EQ(run_line(speeds + " --depths-mm 0:1:3 -o no/such/map.csv").code, 1);
}

}  // namespace
}  // namespace steadyrest::test
