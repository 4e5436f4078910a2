// SPDX-License-Identifier: Apache-2.0
// Everything at once: the result is what the single verbs make one after the other, and verify
// proves it by its mark.
#include <fstream>
#include <regex>
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

const std::string kCorrectPart = "examples/programs/rib-pocket.mpf";
const std::string kSlotSpeeds = " --process " + kSlotProcess + " --depth-mm 1";

// The path alone leaves a few corners above the limit; the feed falls there and nowhere else.
TEST(ProgramCorrect, HoldsTheLimitInHardlyMoreTime) {
  const Scratch scratch;
  const std::string on_vmc =
      " --machine " +
      scratch.file("vmc.toml",
                   std::regex_replace(text_of_file(project_file("examples/machines/vmc-840d.toml")),
                                      std::regex("block_time_ms = 4 "), "block_time_ms = 0 "));
  const std::string changed = scratch.at("changed.mpf");
  const auto answer = answer_of("program correct " + kCorrectPart + on_vmc +
                                " --max-error-mm 0.010 --hold-limit -o " + changed);
  const auto& path = answer["path"];
  EXPECT_LT(path["predicted_error_max_mm"].get<double>(), 0.020);
  EXPECT_LT(path["seconds_after"].get<double>(), 1.03 * path["seconds_before"].get<double>());
  EXPECT_GT(path["share_over_limit_before"].get<double>(), 0.5);
  EXPECT_LT(path["share_over_limit"].get<double>(), 0.001);

  const auto cut = answer_of("cut " + changed + " --against " + kCorrectPart + on_vmc)["without"];
  EXPECT_LE(cut["samples_over_limit"].get<double>(), 0.001 * cut["samples"].get<double>());
  EXPECT_LT(cut["contour_error_rms_mm"].get<double>(), 0.002);
  const auto proof = answer_of("program verify " + kCorrectPart + " " + changed);
  EXPECT_EQ(proof["farthest_mm"], answer["farthest_mm"]);
  EXPECT_EQ(proof["new_lines"], answer["new_lines"]);
}

// A control that takes 4 ms for a block cannot follow as many.
TEST(ProgramCorrect, HoldsTheLimitAtFourMillisecondsABlock) {
  const Scratch scratch;
  const auto path =
      answer_of("program correct " + kCorrectPart + kOnVmc +
                " --max-error-mm 0.010 --hold-limit -o " + scratch.at("changed.mpf"))["path"];
  EXPECT_LT(path["seconds_after"].get<double>(), 1.1 * path["seconds_before"].get<double>());
  EXPECT_EQ(path["share_over_limit"].get<double>(), 0.0);
}

TEST(ProgramCorrect, WritesSpeedsPathAndHeatIntoOneProgram) {
  const Scratch scratch;
  std::ofstream(scratch.at("part.ngc"))
      << "G21 G90 G94 G17 G64 G54\nT1 M6\nG43 H1\nS5000 M3\nG0 X0 Y0 Z2\nG1 Z-1 F500\nG4 P0.2\n"
         "G1 X30 F2000\nG3 X50 Y20 I0 J20\nG1 Y60\nG0 Z20\nG0 X0 Y0\nG0 Z2\nG1 Z-1 F500\nG4 P0.2\n"
         "G1 X30 F2000\nM5\nM2\n";
  std::ofstream(scratch.at("plan.json"))
      << R"({"transitions": [{"n": 2, "t_min": [0.05, 0.05], "delta_um": [0, 20]}]})";
  const std::string part = scratch.at("part.ngc");
  const std::string mill = " --machine examples/machines/linuxcnc-mill.toml";
  const std::string plan = " --plan " + scratch.at("plan.json");
  const std::string changed = scratch.at("changed.ngc");
  const auto answer = answer_of("program correct " + part + mill + plan + kSlotSpeeds +
                                " --max-error-mm 0.01 -o " + changed);
  EXPECT_GE(answer["speeds"]["cuts"].size(), 1U);
  EXPECT_LT(answer["path"]["predicted_error_rms_mm"].get<double>(),
            0.2 * answer["path"]["predicted_error_rms_before_mm"].get<double>());
  EXPECT_EQ(answer["plan"]["insertions"].size(), 1U);
  answer_of("program verify " + part + " " + changed + plan + mill);

  // Step by step it is the same text, but for the marks.
  const auto removed = answer_of("program strip " + changed + " -o " + scratch.at("back.ngc"));
  EXPECT_GT(removed["removed_lines"].get<int>(), 0);
  EXPECT_EQ(text_of_file(scratch.at("back.ngc")), text_of_file(part));
}

// The block before is left as it is and the control rounds its corner: the new blocks begin at the
// corner, not where the rounding would end.
TEST(ProgramCorrect, BeginsAtTheCornerBehindABlockThatStays) {
  const Scratch scratch;
  std::ofstream(scratch.at("part.ngc"))
      << "G21 G90 G94 G17 G64 G54\nT1 M6\nS3000 M3\nG0 X0 Y0 Z2\nG0 X50 Y50\nG91\nG1 X5 F1000\n"
         "G1 Y5\nG2 X5 Y5 I5 J0\nG90\nG0 Z20\nM5\nM2\n";
  const std::string part = scratch.at("part.ngc");
  const auto answer = answer_of(
      "program correct " + part + " --machine examples/machines/linuxcnc-mill.toml" +
      " --max-error-mm 0.01 --max-shift-mm 0.5 --hold-limit -o " + scratch.at("changed.ngc"));
  EXPECT_EQ(answer["path"]["too_far"], (nlohmann::json{7}));
  // Before the block that stays the tool waits for the end of the rapid.
  EXPECT_EQ(answer["path"]["dwells"].get<int>(), 1);
  EXPECT_NE(text_of_file(scratch.at("changed.ngc")).find("\nG1 X5 F1000 ;STEADYREST new"),
            std::string::npos);
  EXPECT_EQ(answer["replaced_lines"].get<int>(), 3);
  answer_of("program verify " + part + " " + scratch.at("changed.ngc"));
}

TEST(ProgramCorrect, RefusesWhatItIsNotAskedFor) {
  const Scratch scratch;
  const std::string line =
      "program correct " + kCorrectPart + kOnVmc + " -o " + scratch.at("changed.mpf");
  expect_refused(line, "nothing is asked for");
  expect_all_refused({line + " --process " + kSlotProcess, line + " --depth-mm 1",
                      line + " --max-error-mm 0", line + " --max-error-mm 0.01 --depth-mm 1"});
}

}  // namespace
}  // namespace steadyrest::test
