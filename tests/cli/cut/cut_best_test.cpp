// SPDX-License-Identifier: Apache-2.0
// `cut` tells the best: each way's figures are what its own command or setting gives when it is
// cut.
#include <fstream>
#include <string>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kArcs = "examples/programs/circle-r10.ngc";
const std::string kArcsMill = "examples/machines/linuxcnc-mill.toml";

json way_of(const json& answer, const std::string& name) {
  for (json way : answer["ways"]) {
    if (way["way"] == name) {
      way.erase("way");
      way.erase("get");
      return way;
    }
  }
  ADD_FAILURE() << "no way " << name;
  return {};
}

TEST(CutBest, TheCommandWritesWhatWasCut) {
  const Scratch scratch;
  const json answer = answer_of("cut " + kArcs + " --machine " + kArcsMill);
  const json& best = answer["best"]["same_time"];
  ASSERT_EQ(best["way"], "text");
  const std::string start = "steadyrest ";
  std::string command = best["get"];
  ASSERT_THAT(command, StartsWith(start + "program correct " + kArcs));
  const std::string name = "circle-r10-corrected.ngc";
  ASSERT_TRUE(command.ends_with(name));
  command = command.substr(start.size(), command.size() - start.size() - name.size());
  const std::string changed = scratch.at("changed.ngc");
  answer_of(command + changed);
  const json cut = answer_of("cut " + changed + " --against " + kArcs + " --machine " + kArcsMill);
  EXPECT_EQ(way_of(answer, "text"), cut["without"]);
  // Far better, in the same time.
  EXPECT_LT(best["contour_error_rms_mm"].get<double>(),
            0.1 * answer["without"]["contour_error_rms_mm"].get<double>());
  EXPECT_LE(best["cycle_time_s"].get<double>(),
            1.02 * answer["without"]["cycle_time_s"].get<double>());
}

TEST(CutBest, SaysWhatIsMissingForMoreWhereNoLagIsKnown) {
  const Scratch scratch;
  std::string machine = text_of_file(project_file(kArcsMill));
  const std::string lag = "velocity_lag_ms = 0";
  for (std::size_t at = machine.find(lag); at != std::string::npos; at = machine.find(lag)) {
    machine.replace(at, lag.size(), "");
  }
  const json answer =
      answer_of("cut " + kArcs + " --machine " + scratch.file("open.toml", machine));
  EXPECT_THAT(answer["not_possible"].dump(),
              AllOf(HasSubstr("velocity-loop lag of X, Y"), HasSubstr("from-log fits it")));
}

TEST(CutBest, ASettingLeavesWhatTheMachineWithItDoes) {
  const Scratch scratch;
  const json answer = answer_of("cut " + kArcs + " --machine " + kArcsMill);
  const json& setting = answer["best"]["setting"];
  ASSERT_THAT(setting["get"].get<std::string>(), StartsWith("PID FF1 = 1 of the joints of X, Y"));
  std::string machine = text_of_file(project_file(kArcsMill));
  const std::string gain = "servo_gain_1_s = 20\n";
  std::size_t axes = 0;
  for (std::size_t at = machine.find(gain); at != std::string::npos;
       at = machine.find(gain, at + gain.size()), ++axes) {
    machine.insert(at + gain.size(), "feed_forward = 1\n");
  }
  ASSERT_EQ(axes, 3U);
  const json cut =
      answer_of("cut " + kArcs + " --quick --machine " + scratch.file("set.toml", machine));
  EXPECT_EQ(way_of(answer, "setting"), cut["without"]);
}

TEST(CutBest, TheFirstLinesAreNowBestAndCommand) {
  const Finished finished = run_line("cut " + kArcs + " --machine " + kArcsMill);
  ASSERT_EQ(finished.code, 0) << finished.err;
  std::vector<std::string> lines;
  for (std::size_t at = 0; lines.size() < 3;) {
    const std::size_t end = finished.out.find('\n', at);
    ASSERT_NE(end, std::string::npos);
    lines.push_back(finished.out.substr(at, end - at));
    at = end + 1;
  }
  EXPECT_THAT(lines[0], AllOf(StartsWith("as programmed"), HasSubstr("µm largest")));
  EXPECT_THAT(lines[1], AllOf(StartsWith("best, same time"), HasSubstr("µm largest")));
  EXPECT_THAT(lines[2], AllOf(StartsWith("  write it"), HasSubstr("steadyrest program correct")));
}

// Each line over the limit has its reason; written into the program, the cure keeps the limit.
TEST(CutBest, ACureCutsWithinTheLimitAtItsPrice) {
  const Scratch scratch;
  const auto program = [](const std::string& dwell) {
    return "G21 G90 G17 G94 G61\nM3 S1000\nG0 X0 Y0 Z0\nG0 X60\n" + dwell + "G1 Y[40] F900\nM2\n";
  };
  const std::string part = scratch.file("part.ngc", program(""));
  const json now = answer_of("cut " + part + " --quick --machine " + kArcsMill)["without"];
  ASSERT_GT(now["contour_error_max_mm"].get<double>(), 0.1);
  const json answer = answer_of("program predistort " + part + " --machine " + kArcsMill +
                                " --max-error-mm 0.01 -o " + scratch.at("text.ngc"));
  ASSERT_EQ(answer["remaining"].size(), 1U);
  const json& left = answer["remaining"][0];
  EXPECT_EQ(left["line"], 5);
  EXPECT_THAT(left["reason"].get<std::string>(),
              AllOf(HasSubstr("the rapid before it"), HasSubstr("unchanged, because its words")));
  const json& cure = left["cures"][0];
  const std::string what = cure["what"];
  const std::string before = " before line 5";
  ASSERT_THAT(what, AllOf(StartsWith("G4 P"), testing::EndsWith(before)));
  const std::string cured =
      scratch.file("cured.ngc", program(what.substr(0, what.size() - before.size()) + "\n"));
  const json then = answer_of("cut " + cured + " --quick --machine " + kArcsMill)["without"];
  EXPECT_LE(then["contour_error_max_mm"].get<double>(), 0.0105);
  EXPECT_NEAR(then["cycle_time_s"].get<double>() - now["cycle_time_s"].get<double>(),
              cure["seconds"].get<double>(), 0.03);
}

// Full circles that grow: no corrected path turns fast enough, lower feeds hold the limit.
TEST(CutBest, ALimitThatAnyWayHoldsIsHeld) {
  const Scratch scratch;
  const std::string part = scratch.file(
      "part.ngc",
      "G21 G90 G17 G94 G61\nM3 S1000\nG0 X3 Y0 Z0\nG4 P0.5\nG1 F2400\nG3 X-3.8 Y0 I-3.4 J0\n"
      "G3 X4.6 Y0 I4.2 J0\nG3 X-5.4 Y0 I-5 J0\nG4 P0.5\nM2\n");
  const std::string text = scratch.at("held.ngc");
  const json answer = answer_of("program correct " + part + " --machine " + kArcsMill +
                                " --max-error-mm 0.01 --hold-limit -o " + text);
  EXPECT_TRUE(answer["path"]["remaining"].empty()) << answer["path"]["by"];
  const json cut = answer_of("cut " + text + " --against " + part + " --machine " + kArcsMill);
  EXPECT_EQ(cut["without"]["samples_over_limit"], 0);
}

TEST(CutBest, AReportHoldsTheBestWayAndItsRun) {
  const Scratch scratch;
  answer_of("cut " + kArcs + " --machine " + kArcsMill + " --report " + scratch.at("out"));
  const json report = json::parse(text_of_file(scratch.at("out/report.json")));
  const json& best = report["best"]["same_time"];
  EXPECT_EQ(best["contour_error_max_mm"], report["best_run"]["figures"]["contour_error_max_mm"]);
  EXPECT_GT(report["best_run"]["trace"]["time_s"].size(), 100U);
  for (const json& over : report["over_limit"]) {
    EXPECT_NE(over["reason"], "");
    EXPECT_GT(over["error_um"].get<double>(), 10.0);
  }
}

TEST(CutBest, WhatCannotBeCorrectedIsSaid) {
  const Scratch scratch;
  const std::string slower = scratch.at("slower.ngc");
  answer_of("program feeds " + kArcs + " --machine " + kArcsMill + " --max-error-mm 0.1 -o " +
            slower);
  const Finished finished = run_line("cut " + slower + " --machine " + kArcsMill);
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("not possible: no text can be corrected: "));
  EXPECT_THAT(finished.err, HasSubstr("have been replaced already"));
}

}  // namespace
}  // namespace steadyrest::test
