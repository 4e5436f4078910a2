// SPDX-License-Identifier: Apache-2.0
#include <string>
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
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kCircle = "examples/programs/circle-r10.mpf";
const std::string kIdeal = " --machine examples/machines/ideal-k50.toml";
const std::string kCut = "cut " + kCircle + " --quick" + kIdeal;

// Ideal axes with 50 1/s and the arc of the reference table: R = 10 mm at 4000 mm/min.
TEST(Cut, GivesBothCutsAsJson) {
  const json answer = answer_of(kCut);
  EXPECT_EQ(answer["program"], kCircle);
  EXPECT_EQ(answer["machine"], "Ideal axes, servo gain 50 1/s");
  EXPECT_EQ(answer["limit_um"], 10.0);
  EXPECT_FALSE(answer.contains("report"));
  for (const char* cut : {"without", "with"}) {
    for (const char* key :
         {"cycle_time_s", "contour_error_max_mm", "contour_error_rms_mm", "tracking_error_max_mm",
          "over_limit_s", "override_changes", "cutting_time_s", "samples", "samples_over_limit"}) {
      EXPECT_TRUE(answer[cut][key].is_number()) << cut << " " << key;
    }
  }
}

// Outside the travel the layer does not trust its input: moves that the machine cannot make are
// reported by line, and the layer's withdrawal by its time. The simulated machine's offsets are
// known.
TEST(Cut, SaysThatTheProgramLeavesTheTravelAndHowLongTheLayerWithdrew) {
  const Scratch scratch;
  const std::string far =
      scratch.file("far.ngc", "G21 G90 F4000\nM3 S1000\nG0 X1600 Y0\nG2 X1600 Y0 I10 J0\nM2\n");
  const std::string line = "cut " + far + " --quick --machine examples/machines/linuxcnc-mill.toml";
  const json answer = answer_of(line);
  ASSERT_EQ(answer["withdrawn"].size(), 1U);
  EXPECT_EQ(answer["withdrawn"][0]["reason"], "input_out_of_range");
  EXPECT_GT(answer["withdrawn"][0]["seconds"], answer["with"]["cutting_time_s"]);
  ASSERT_EQ(answer["warning_count"], 2U);
  for (const int at : {3, 4}) {
    const json& warning = answer["warnings"][static_cast<std::size_t>(at - 3)];
    EXPECT_EQ(warning["line"], at);
    EXPECT_THAT(warning["text"].get<std::string>(), HasSubstr("outside its travel -500"));
  }
  EXPECT_THAT(run_line(line).out,
              ContainsRegex("the layer withdrew for [0-9]+\\.[0-9] s: input_out_of_range"));
  const json within = answer_of(kCut);
  EXPECT_TRUE(within["withdrawn"].empty());
  EXPECT_EQ(within["warning_count"], 0U);
}

// 840D with encoders of 1 µm: the estimate must beat differences, and the guaranteed bounds must
// hold for every sample (coverage 1).
TEST(Cut, SaysWhatTheEstimatesOfTheMotionAreWorthOnEachAxis) {
  const json motion =
      answer_of("cut " + kCircle + " --quick --machine examples/machines/vmc-840d.toml")["motion"];
  ASSERT_EQ(motion.size(), 3U);
  for (const json& axis : motion) {
    EXPECT_THAT(axis["axis"].get<std::string>(), testing::AnyOf("X", "Y", "Z"));
    for (const char* key : {"velocity_rms_mm_s", "acceleration_rms_mm_s2",
                            "difference_velocity_rms_mm_s", "difference_acceleration_rms_mm_s2",
                            "velocity_coverage_ratio", "acceleration_coverage_ratio"}) {
      EXPECT_TRUE(axis[key].is_number()) << key;
    }
    EXPECT_LT(axis["velocity_rms_mm_s"], axis["difference_velocity_rms_mm_s"]);
    EXPECT_EQ(axis["velocity_coverage_ratio"], 1.0);
    EXPECT_EQ(axis["acceleration_coverage_ratio"], 1.0);
  }
  EXPECT_TRUE(answer_of(kCut)["motion"].empty()) << "ideal encoders have no counts";
}

// Without the layer the closed form rules: ε = 0.0877 mm, following error v/k on the lines. With it
// the limit of 10 µm holds, and the price is time.
TEST(Cut, BuysTheLimitWithTime) {
  const json answer = answer_of(kCut);
  const json& without = answer["without"];
  const json& with = answer["with"];
  EXPECT_NEAR(without["contour_error_max_mm"], 0.0877, 0.01 * 0.0877);
  EXPECT_NEAR(without["tracking_error_max_mm"], 4000.0 / 60.0 / 50.0, 0.01);  // on the lines: v/k
  EXPECT_EQ(without["override_changes"], 0);
  // A real part may have 0.1 % of its samples over the limit; here the few at the circle's entry.
  EXPECT_LE(with["samples_over_limit"], 0.001 * with["samples"].get<double>());
  EXPECT_LE(with["contour_error_max_mm"], 1.01 * 0.010);
  EXPECT_GT(with["cycle_time_s"], without["cycle_time_s"]);
}

// 5 µm, 40 µm: the cut without the layer does not care.
TEST(Cut, TakesTheLimitFromTheCommandLine) {
  const json tight = answer_of(kCut + " --limit-um 5");
  const json loose = answer_of(kCut + " --limit-um 40");
  EXPECT_EQ(tight["limit_um"], 5.0);
  EXPECT_LE(tight["with"]["contour_error_max_mm"], 0.005);
  EXPECT_GT(loose["with"]["contour_error_max_mm"], 0.010);
  EXPECT_LE(loose["with"]["contour_error_max_mm"], 0.040);
  EXPECT_GT(tight["with"]["cycle_time_s"], loose["with"]["cycle_time_s"]);
  EXPECT_EQ(tight["without"]["cycle_time_s"], loose["without"]["cycle_time_s"]);
}

// Contour priority must be the slowest; the three must differ.
TEST(Cut, TakesTheStrategyFromTheCommandLine) {
  const double contour_s = answer_of(kCut + " --strategy contour_priority")["with"]["cycle_time_s"];
  const double feed_s = answer_of(kCut + " --strategy feed_priority")["with"]["cycle_time_s"];
  const double both_s = answer_of(kCut + " --strategy combined")["with"]["cycle_time_s"];
  EXPECT_GT(contour_s, feed_s);
  EXPECT_NE(both_s, feed_s);
  EXPECT_NE(both_s, contour_s);
}

TEST(Cut, ShowsATableToPeople) {
  const Finished finished = run_line(kCut);
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("without the layer"));
  EXPECT_THAT(finished.out, HasSubstr("contour error, largest"));
  EXPECT_THAT(finished.out, HasSubstr("over the limit of 10.0 µm"));
  EXPECT_THAT(finished.out, Not(HasSubstr("motion estimate error"))) << "ideal encoders have none";
}

TEST(Cut, ShowsPeopleALineForEachAxisWhoseMotionIsEstimated) {
  const std::string line = "cut " + kCircle + " --quick --machine examples/machines/vmc-840d.toml";
  const Finished finished = run_line(line);
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("motion estimate error, RMS"));
  for (const json& axis : answer_of(line)["motion"]) {
    const auto both = [&](const std::string& of) {
      return fmt::format("{:.3g} mm/s, {:.3g} mm/s²", axis[of + "velocity_rms_mm_s"].get<double>(),
                         axis[of + "acceleration_rms_mm_s2"].get<double>());
    };
    EXPECT_THAT(finished.out, ContainsRegex("\n" + axis["axis"].get<std::string>() + " +" +
                                            both("") + " +" + both("difference_")));
  }
}

TEST(Cut, WritesTheReportAsPageAndAsJson) {
  const Scratch scratch;
  const json answer = answer_of(kCut + " --report " + scratch.at("new/folder"));
  EXPECT_EQ(answer["report"], scratch.at("new/folder/report.html"));
  EXPECT_THAT(text_of_file(scratch.at("new/folder/report.html")), StartsWith("<!doctype html>"));
  const json report = json::parse(text_of_file(scratch.at("new/folder/report.json")));
  EXPECT_EQ(report["program"], "circle-r10.mpf");
  EXPECT_EQ(report["with"]["figures"], answer["with"]);
}

// Same seed, same bytes, with noise and all.
TEST(Cut, TwiceTheSameIsTheSameToTheByte) {
  const Scratch scratch;
  const std::string noisy = "cut " + kCircle +
                            " --machine examples/machines/vmc-840d.toml --report-date none "
                            "--report " +
                            scratch.at("a");
  const auto both = [&scratch] {
    return text_of_file(scratch.at("a/report.json")) + text_of_file(scratch.at("a/report.html"));
  };
  answer_of(noisy);
  const std::string first = both();
  EXPECT_GT(first.size(), 10'000U);
  answer_of(noisy);
  EXPECT_TRUE(first == both());
}

// A feed that exceeded the limit does not hold it, whatever the closed form says.
TEST(Cut, NamesNoFeedAsHoldingThatIsFasterThanOneThatLeftTheLimit) {
  const Scratch scratch;
  answer_of(
      "cut examples/programs/circle-r10.ngc --quick --machine examples/machines/linuxcnc-mill.toml "
      "--report " +
      scratch.at("out"));
  const json page = json::parse(text_of_file(scratch.at("out/report.json")));
  bool left = false;
  for (const json& line : page["worst_lines"]) {
    if (std::abs(line["with_um"].get<double>()) > page["limit_um"]) {
      left = true;
      EXPECT_LT(line["hold_feed_mm_min"], line["feed_with_mm_min"]);
    }
  }
  EXPECT_TRUE(left) << "10.7 µm at the circle's entry, on a slow servo";
}

// Worst lines in falling order; on the arc the holding feed is that of `contour limit`.
TEST(Cut, ShowsTheWorstLinesWithTheFeedThatWouldHold) {
  const Scratch scratch;
  answer_of(kCut + " --strategy contour_priority --report " + scratch.at("out"));
  const json lines = json::parse(text_of_file(scratch.at("out/report.json")))["worst_lines"];
  ASSERT_FALSE(lines.empty());
  double last_um = 1e9;
  bool arc = false;
  for (const json& line : lines) {
    const double with_um = std::abs(line["with_um"].get<double>());
    EXPECT_LE(with_um, last_um);
    last_um = with_um;
    EXPECT_GT(line["feed_with_mm_min"], 0.0);
    if (line["held_by"] == "closed form") {
      // As in `contour limit` for this radius, gain and limit.
      arc = true;
      const json limit = answer_of("contour limit --radius-mm 10 --kv-1-s 50 --max-error-mm 0.010");
      EXPECT_NEAR(line["radius_mm"], 10.0, 1e-3);
      EXPECT_NEAR(line["hold_feed_mm_min"], limit["feed_mm_min"], 0.1);
    }
  }
  EXPECT_TRUE(arc);
}

// A program for another control, one that does not move, and a binary file.
TEST(Cut, RefusesAProgramByFileLineAndWord) {
  expect_refused("cut examples/programs/circle-r10.ngc" + kIdeal,
                 "examples/programs/circle-r10.ngc:2: `G21`");
  expect_refused("cut none.mpf" + kIdeal, "none.mpf");
  const Scratch scratch;
  expect_refused("cut " + scratch.file("still.mpf", "G71 G90\nM30\n") + kIdeal,
                 "the program moves no axis");
  const std::string binary("\x7f\x45\x4c\x46\0\x01\x02\xff", 8);
  expect_refused("cut " + scratch.file("binary.mpf", binary) + kIdeal, "binary.mpf:1");
}

TEST(Cut, RefusesAMachineFileByFileAndLine) {
  const std::string faulty = project_file("tests/refused/machine/gain-negative.toml");
  expect_refused("cut " + kCircle + " --machine " + faulty, faulty + ":12: servo_gain_1_s");
  expect_refused("cut " + kCircle + " --machine none.toml", "none.toml");
  expect_refused("cut " + kCircle, "--machine");
}

TEST(Cut, RefusesALimitAndAStrategyThatAreNone) {
  for (const char* limit : {"0", "-5", "nan", "inf", "1e9", "ten"}) {
    expect_refused(kCut + " --limit-um " + limit, "--limit-um");
  }
  expect_refused(kCut + " --strategy fastest", "--strategy");
}

TEST(Cut, RefusesAReportFolderThatCannotBeMade) {
  const Scratch scratch;
  const std::string file = scratch.file("a-file", "not a folder");
  expect_refused(kCut + " --report " + file + "/below", file);
}

// 600 mm at 600 mm/min and a dwell of 2 s.
TEST(ProgramTime, IsPathOverFeedAndItsParts) {
  const Scratch scratch;
  // 600 mm at 600 mm/min are 60 s; the ramps cost v/a = 1 ms.
  const std::string program = scratch.file("line.mpf", "G71 G90 G94\nG1 X600 F600\nG4 F2\nM30\n");
  const json answer = answer_of("program time " + program + kIdeal + " --lines");
  EXPECT_NEAR(answer["cut_s"], 60.0, 0.01);
  EXPECT_NEAR(answer["dwell_s"], 2.0, 0.001);
  EXPECT_NEAR(answer["seconds"], 62.0, 0.01);
  EXPECT_NEAR(answer["cut_mm"], 600.0, 1e-6);
  EXPECT_EQ(answer["rapid_s"], 0.0);
  EXPECT_EQ(answer["lines"][0]["line"], 2);
  EXPECT_NEAR(answer["lines"][0]["seconds"], 60.0, 0.01);
}

TEST(ProgramTime, RefusesAProgramByFileLineAndWord) {
  expect_refused("program time examples/programs/circle-r10.ngc" + kIdeal,
                 "examples/programs/circle-r10.ngc:2: `G21`");
}

}  // namespace
}  // namespace steadyrest::test
