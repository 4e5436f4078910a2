// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <regex>
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using testing::HasSubstr;

const std::string kPredistortPart = "examples/programs/circle-r10.mpf";

// What it predicts is what the simulated machine cuts; strip restores the program to the byte.
TEST(ProgramPredistort, CutsWithoutTheErrorInTheSameTime) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.mpf");
  const auto answer =
      answer_of("program predistort " + kPredistortPart + kOnVmc + " -o " + changed);
  EXPECT_FALSE(answer["unchanged"].get<bool>());
  // The closed form, and half of the backlash.
  EXPECT_NEAR(answer["predicted_error_max_before_mm"].get<double>(), 0.0877 + 0.001, 5e-4);
  EXPECT_LT(answer["predicted_error_max_mm"].get<double>(), 0.003);
  EXPECT_LT(answer["uncertain"]["error_max_mm"].get<double>(),
            answer["uncertain"]["error_max_before_mm"].get<double>());
  EXPECT_NEAR(answer["seconds_after"].get<double>(), answer["seconds_before"].get<double>(), 0.05);
  const auto cut = answer_of("cut " + changed + " --against " + kPredistortPart + kOnVmc);
  EXPECT_LT(cut["without"]["contour_error_rms_mm"].get<double>(),
            0.02 * cut["original"]["contour_error_rms_mm"].get<double>());
  EXPECT_NEAR(cut["without"]["contour_error_max_mm"].get<double>(),
              answer["predicted_error_max_mm"].get<double>(), 0.003);
  const auto removed = answer_of("program strip " + changed + " -o " + scratch.at("back.mpf"));
  EXPECT_GT(removed["removed_lines"].get<int>(), 3);
  EXPECT_EQ(text_of_file(scratch.at("back.mpf")), text_of_file(project_file(kPredistortPart)));
}

TEST(ProgramPredistort, SaysWhatItLeaves) {
  const Scratch scratch;
  std::ofstream(scratch.at("part.mpf"))
      << "N10 G17 G71 G90 G94 G64\nN20 G0 X0 Y0\nN30 G1 X20 F3000\n"
         "N40 G93 G1 X30 F10\nN50 G94 G1 Y20 F3000\nN60 M30\n";
  const auto answer = answer_of("program predistort " + scratch.at("part.mpf") + kOnVmc +
                                " --max-error-mm 0.001 -o " + scratch.at("changed.mpf"));
  EXPECT_GE(answer["kept"].size(), 1U);
  ASSERT_GE(answer["remaining"].size(), 1U);
  // The worst first.
  EXPECT_NEAR(answer["remaining"][0]["predicted_error_mm"].get<double>(),
              answer["predicted_error_max_mm"].get<double>(), 1e-6);
}

// The program ends 1 mm behind a sharp corner, and the tool is 2.5 mm behind: it passes the corner
// when the command has ended.
TEST(ProgramPredistort, MakesNoCornerWorseAtTheEnd) {
  const Scratch scratch;
  const std::string on_linuxcnc = " --machine examples/machines/linuxcnc-mill.toml";
  const std::string part = scratch.at("part.ngc");
  for (const std::string mode : {"G61", "G64"}) {
    std::ofstream(part) << "G21 G90 G17\n"
                        << mode << "\nF3000\nG0 X0 Y0 Z0\nG1 X10 Y1\nG3 X10 Y21 J10 I0\n"
                        << "G1 X0\nG2 Y1 J-10 I0\nG1 X0 Y0\nM2\n";
    const std::string changed = scratch.at("changed.ngc");
    const auto answer =
        answer_of("program predistort " + part + on_linuxcnc + " --max-shift-mm 0.5 -o " + changed);
    const auto cut = answer_of("cut " + changed + " --against " + part + on_linuxcnc);
    const double was_mm = cut["original"]["contour_error_max_mm"].get<double>();
    const double is_mm = cut["without"]["contour_error_max_mm"].get<double>();
    EXPECT_LE(is_mm, 1.01 * was_mm) << mode;
    EXPECT_NEAR(answer["predicted_error_max_before_mm"].get<double>(), was_mm, 0.01 * was_mm);
    EXPECT_NEAR(answer["predicted_error_max_mm"].get<double>(), is_mm, 0.01 * is_mm);
    EXPECT_LT(cut["without"]["contour_error_rms_mm"].get<double>(),
              0.8 * cut["original"]["contour_error_rms_mm"].get<double>());
  }
}

// A command leaves the path by as much as the tool would.
TEST(ProgramPredistort, PermitsTheShiftThatASlowServoNeeds) {
  const Scratch scratch;
  const std::string part = scratch.file("part.ngc",
                                        "G21 G90 G17 G61\nF3000\nG0 X0 Y0 Z0\nG4 P0.5\nG1 X20\nG3 "
                                        "X20 Y4 J2\nG1 X0\nG4 P0.5\nM2\n");
  const std::string changed = scratch.at("changed.ngc");
  const std::string command = "program predistort " + part +
                              " --machine examples/machines/linuxcnc-mill.toml -o " + changed;
  const auto answer = answer_of(command);
  EXPECT_GT(answer["predicted_error_max_before_mm"].get<double>(), 0.25);
  EXPECT_EQ(answer["too_far"], nlohmann::json::array());
  EXPECT_GT(answer["largest_shift_mm"].get<double>(), 0.5);
  EXPECT_THAT(text_of_file(changed), testing::HasSubstr("--tube-mm 2"));
  answer_of("program verify " + part + " " + changed);
  // What is asked for counts.
  const auto bounded = answer_of(command + " --max-shift-mm 0.5");
  EXPECT_EQ(bounded["too_far"], nlohmann::json({6}));
}

// A lag of half of 1 / servo gain leaves no error on an arc: where the file does not exclude it,
// arcs stay, and the answer says why and what to do.
TEST(ProgramPredistort, LeavesArcsWhereALagIsNotKnown) {
  const Scratch scratch;
  const std::string machine =
      scratch.file("machine.toml",
                   std::regex_replace(text_of_file(project_file("examples/machines/vmc-840d.toml")),
                                      std::regex("velocity_lag_ms = 0\n"), ""));
  const std::string command = "program predistort " + kPredistortPart + " --machine " + machine +
                              " -o " + scratch.at("changed.mpf");
  const auto answer = answer_of(command);
  EXPECT_TRUE(answer["unchanged"].get<bool>());
  EXPECT_EQ(answer["uncertain"]["lag_percent"], 50.0);
  EXPECT_EQ(answer["uncertain"]["lag_unknown"], nlohmann::json({"X", "Y", "Z"}));
  EXPECT_GE(answer["not_better"].size(), 1U);
  const Finished finished = run_line(command);
  EXPECT_THAT(finished.out, HasSubstr("the lag of the velocity loop of X, Y, Z is not known"));
  EXPECT_THAT(finished.out, HasSubstr("machine from-log fits it"));
  const auto daring = answer_of(command + " --lag-uncertainty-percent 0");
  EXPECT_FALSE(daring["unchanged"].get<bool>());
  EXPECT_EQ(daring["uncertain"]["lag_unknown"], nlohmann::json({"X", "Y", "Z"}));
  EXPECT_THAT(text_of_file(scratch.at("changed.mpf")), HasSubstr("--lag-uncertainty-percent 0"));
}

TEST(ProgramPredistort, RefusesWhatItCannotDo) {
  const Scratch scratch;
  const std::string to = " -o " + scratch.at("changed.mpf");
  const std::string changed = scratch.at("twice.mpf");
  answer_of("program predistort " + kPredistortPart + kOnVmc + " -o " + changed);
  expect_refused("program predistort " + changed + kOnVmc + to, "replaced already");
  expect_all_refused(
      {"program predistort " + kPredistortPart + to,
       "program predistort " + kPredistortPart + kOnVmc,
       "program predistort " + kPredistortPart + kOnVmc + to + " --max-shift-mm 9",
       "program predistort " + kPredistortPart + kOnVmc + to + " --max-error-mm 0",
       "program predistort " + kPredistortPart + kOnVmc + to + " --gain-uncertainty-percent 50",
       "program predistort " + kPredistortPart + kOnVmc + to + " --lag-uncertainty-percent 51",
       "program predistort examples/programs/slot.toml" + kOnVmc + to});
}

}  // namespace
}  // namespace steadyrest::test
