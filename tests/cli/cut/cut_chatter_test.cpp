// SPDX-License-Identifier: Apache-2.0
// `cut --process`: chatter in the simulated machine, without and with the layer.
#include <algorithm>
#include <cmath>
#include <cstddef>
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

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string kCutSlot =
    "cut examples/programs/slot.mpf --machine examples/machines/vmc-840d.toml";
const std::string kProcess = " --process examples/processes/slot-922hz.toml";

std::string at_depth(double depth_mm, const std::string& more = "") {
  return kCutSlot + kProcess + fmt::format(" --depth-mm {}", depth_mm) + more;
}

// 5000 rpm, 1 mm: far in the unstable region; 110 % is stable. The margins (1 % of the chatter,
// half the force) leave room for the approach.
TEST(CutChatter, TheLayerTakesTheOverrideStepThatIsStable) {
  const json answer = answer_of(at_depth(1.0));
  for (const char* cut : {"without", "with"}) {
    for (const char* key : {"vibration_rms_um", "vibration_peak_um", "unforced_rms_um",
                            "force_peak_n", "power_peak_w", "chip_peak_um"}) {
      EXPECT_TRUE(answer[cut][key].is_number()) << cut << " " << key;
    }
  }
  EXPECT_GT(answer["without"]["unforced_rms_um"], 50.0);
  EXPECT_LT(answer["with"]["unforced_rms_um"].get<double>(),
            0.01 * answer["without"]["unforced_rms_um"].get<double>());
  EXPECT_LT(answer["with"]["force_peak_n"].get<double>(),
            0.5 * answer["without"]["force_peak_n"].get<double>());
  ASSERT_EQ(answer["chatter"].size(), 1U);
  EXPECT_EQ(answer["chatter"][0]["decision"], "constant");
  EXPECT_NEAR(answer["chatter"][0]["mean_percent"].get<double>(), 110.0, 1e-9);
  EXPECT_NEAR(answer["chatter"][0]["spindle_switch_percent"].get<double>(), 110.0, 1e-9);
}

/// The part that does not repeat from tooth to tooth, in the cut without the layer: µm over s.
std::vector<std::pair<double, double>> unforced(double depth_mm) {
  const Scratch scratch;
  answer_of(at_depth(depth_mm, " --report " + scratch.at("report")));
  const json report = json::parse(text_of_file(scratch.at("report/report.json")));
  const json& course = report["without"]["vibration"]["course"];
  std::vector<std::pair<double, double>> out;
  for (std::size_t i = 0; i < course["time_s"].size(); ++i) {
    out.emplace_back(course["time_s"][i], course["unforced_um"][i]);
  }
  return out;
}

double at_time(const std::vector<std::pair<double, double>>& course, double time_s) {
  return std::ranges::lower_bound(course, time_s, {}, &std::pair<double, double>::first)->second;
}

/// The published border of this cut at 5000 rpm is 0.4086 mm; the slot is entered at 1.8 s and left
/// at 5.4 s, where the braking feed is a disturbance of its own.
TEST(CutChatter, DiesAndGrowsOnEitherSideOfThePublishedBorder) {
  const auto below = unforced(0.388);
  const double rate_1_s = std::log(at_time(below, 3.4) / at_time(below, 2.0)) / 1.4;
  // |μ| of a tooth's pass is 0.98277 there (the solver's, equal to the published ones to 1e-6).
  EXPECT_NEAR(rate_1_s, std::log(0.98277) * 2.0 * 5000.0 / 60.0, 0.3);
  const auto above = unforced(0.430);
  EXPECT_GT(at_time(above, 5.0), 10.0 * at_time(above, 2.0));
}

// Two speeds in one program, each unstable as programmed: each gets its own step, which the
// solver then confirms.
TEST(CutChatter, EachSpindleSpeedOfTheProgramGetsItsOwnChoice) {
  const Scratch scratch;
  const std::string program = scratch.file("two-speeds.mpf",
                                           "N10 G71 G90 G94 S5000 M3\n"
                                           "N20 G0 X0 Y0 Z5\n"
                                           "N30 G4 F1\n"
                                           "N40 G1 Z0 F500\n"
                                           "N50 G1 X40 F1000\n"
                                           "N60 G0 Z50\n"
                                           "N70 S7500 M3\n"
                                           "N80 G4 F1\n"
                                           "N90 G1 Z0 F2000\n"
                                           "N100 G1 X0 F2000\n"
                                           "N110 G0 Z50\n"
                                           "N120 M30\n");
  const json answer = answer_of("cut " + program + " --machine examples/machines/vmc-840d.toml" +
                                kProcess + " --depth-mm 0.5");
  ASSERT_EQ(answer["chatter"].size(), 2U);
  for (const json& choice : answer["chatter"]) {
    // The solver, whose borders match the published ones, checks the chosen step.
    const double speed_rpm = choice["speed_rpm"].get<double>();
    EXPECT_EQ(choice["decision"], "constant") << speed_rpm;
    const json at_step = answer_of(
        "chatter radius examples/processes/slot-922hz.toml --depth-mm 0.5" +
        fmt::format(" --speed-rpm {}", speed_rpm * choice["mean_percent"].get<double>() / 100.0));
    EXPECT_TRUE(at_step["stable"].get<bool>()) << speed_rpm;
    const json programmed =
        answer_of("chatter radius examples/processes/slot-922hz.toml --depth-mm 0.5" +
                  fmt::format(" --speed-rpm {}", speed_rpm));
    EXPECT_FALSE(programmed["stable"].get<bool>()) << speed_rpm;
  }
  EXPECT_LT(answer["with"]["unforced_rms_um"].get<double>(),
            0.1 * answer["without"]["unforced_rms_um"].get<double>());
}

// 120 m/min at radii of 60 and, on the way to 40, of 50 mm: 318 and 382 rpm.
TEST(CutChatter, SaysWhichLinesAConstantCuttingSpeedLeavesUnplanned) {
  const Scratch scratch;
  const std::string program = scratch.file("faced.mpf",
                                           "N10 G71 G90 G94 S1500 M3\n"
                                           "N20 G0 X60 Y0 Z5\n"
                                           "N30 G96 S120\n"
                                           "N40 G1 Z0 F500\n"
                                           "N50 G1 X40 F500\n"
                                           "N60 G97 S1500\n"
                                           "N70 G0 Z50\n"
                                           "N80 M30\n");
  const std::string line = "cut " + program + " --machine examples/machines/vmc-840d.toml" +
                           kProcess + " --depth-mm 0.3";
  const json answer = answer_of(line);
  EXPECT_TRUE(answer["chatter"].empty());
  ASSERT_GE(answer["warnings"].size(), 1U);
  EXPECT_EQ(answer["warnings"][0]["line"], 4);
  EXPECT_THAT(answer["warnings"][0]["text"].get<std::string>(),
              AllOf(HasSubstr("up to line 5"), HasSubstr("318 … 382 rpm")));
}

TEST(CutChatter, HearsItAndTakesTheBetterStepOfTheTable) {
  // With the operator's switch at 100 % the layer can only slow the spindle down.
  const json answer = answer_of(at_depth(0.6, " --chatter detect"));
  ASSERT_EQ(answer["heard"].size(), 1U);
  const json& heard = answer["heard"][0];
  EXPECT_GT(heard["time_s"].get<double>(), 1.8) << "the slot is entered then";
  EXPECT_LT(heard["time_s"].get<double>(), 2.6);
  EXPECT_LT(heard["spindle_percent"].get<double>(), 100.0);
  const json limit =
      answer_of("chatter radius examples/processes/slot-922hz.toml --depth-mm 0.6" +
                fmt::format(" --speed-rpm {}", 50.0 * heard["spindle_percent"].get<double>()));
  EXPECT_TRUE(limit["stable"].get<bool>());
  EXPECT_LT(answer["with"]["unforced_rms_um"].get<double>(),
            0.8 * answer["without"]["unforced_rms_um"].get<double>());
}

TEST(CutChatter, HearsNothingInAStableCut) {
  EXPECT_TRUE(answer_of(at_depth(0.3, " --chatter detect"))["heard"].empty());
}

// [chatter] of the example is off, so the cut chatters as without the layer.
TEST(CutChatter, ByTheMachineFileNothingIsPlanned) {
  const json answer = answer_of(at_depth(1.0, " --chatter machine"));
  EXPECT_FALSE(answer.contains("chatter"));
  EXPECT_GT(answer["with"]["unforced_rms_um"], 50.0) << "its [chatter] is off";
}

TEST(CutChatter, WithoutAProcessItCutsAir) {
  const json answer = answer_of(kCutSlot);
  EXPECT_FALSE(answer["without"].contains("vibration_rms_um"));
  EXPECT_FALSE(answer.contains("chatter"));
}

TEST(CutChatter, ShowsPeopleTheVibrationAndTheChoice) {
  const Finished finished = run_line(at_depth(1.0));
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("chatter (not tooth-periodic), RMS"));
  EXPECT_THAT(finished.out, HasSubstr("S5000: override 110 %"));
}

TEST(CutChatter, TheReportHasItsCourse) {
  const Scratch scratch;
  answer_of(at_depth(1.0, " --report " + scratch.at("report")));
  const json report = json::parse(text_of_file(scratch.at("report/report.json")));
  const json& course = report["without"]["vibration"]["course"];
  ASSERT_GT(course["time_s"].size(), 500U);
  EXPECT_EQ(course["time_s"].size(), course["peak_um"].size());
  EXPECT_EQ(course["time_s"].size(), course["speed_rpm"].size());
}

TEST(CutChatter, RefusesWhatCannotBeCut) {
  const auto refuses = [](const std::string& line, const std::string& what) {
    const Finished finished = run_line(line);
    EXPECT_EQ(finished.code, 2) << line;
    EXPECT_THAT(finished.err, HasSubstr(what)) << line;
  };
  refuses(kCutSlot + kProcess, "--process without --depth-mm");
  refuses(at_depth(0.0), "--depth-mm 0 is not above 0");
  refuses(kCutSlot + " --depth-mm 1", "--process");
  refuses(kCutSlot + " --process none.toml --depth-mm 1", "none.toml");
  refuses(at_depth(1.0, " --chatter perhaps"), "--chatter");
  const Scratch scratch;
  const std::string still =
      scratch.file("still.mpf", "N10 G71 G90 G94\nN20 G1 X10 F1000\nN30 M30\n");
  refuses(
      "cut " + still + " --machine examples/machines/vmc-840d.toml" + kProcess + " --depth-mm 1",
      "with the spindle stopped");
}

// No spindle override: the answer is "nothing", not a refusal.
TEST(CutChatter, AMachineWithoutASpindleOverrideCanBeAskedToo) {
  const json answer =
      answer_of("cut examples/programs/circle-r10.mpf --machine examples/machines/ideal-k50.toml" +
                kProcess + " --depth-mm 1");
  EXPECT_EQ(answer["chatter"][0]["decision"], "nothing");
  EXPECT_TRUE(answer["with"]["unforced_rms_um"].is_number());
}

}  // namespace
}  // namespace steadyrest::test
