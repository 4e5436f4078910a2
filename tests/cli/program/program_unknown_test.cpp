// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// What the control decides when a program runs: said by the verbs that plan, left alone by those
// that rewrite.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kWithMill = " --machine examples/machines/linuxcnc-mill.toml";
const std::string kHead = "G21 G90 G54 G17 G64 P0.01\nS1000 M3\nG0 X0 Y0 Z0\n";
const std::string kCuts = "G1 X30 F2000\nG1 X30 Y30\nG1 X60 Y0\nG1 X10 Y10\nG0 Z5\nM2\n";
const std::string kInput = "M66 P0 L0\no1 if [#5399 EQ 1]\nG91\no1 endif\n";

TEST(ProgramUnknown, EachPlanningVerbNamesWhatItAssumed) {
  const Scratch scratch;
  const std::string program = scratch.file("input.ngc", kHead + kInput + kCuts);
  for (const std::string& line :
       {"program check " + program + " --dialect linuxcnc", "program time " + program + kWithMill,
        "program moves " + program + " --dialect linuxcnc -o " + scratch.at("moves.csv"),
        "cut " + program + kWithMill + " --quick"}) {
    const json answer = answer_of(line);
    ASSERT_EQ(answer["assumed"].size(), 1U) << line;
    EXPECT_EQ(answer["assumed"][0]["line"], 5) << line;
    EXPECT_EQ(answer["assumed"][0]["name"], "#5399") << line;
    EXPECT_EQ(answer["assumed"][0]["value"], 0.0) << line;
  }
  const Finished moves = run_line("program moves " + program + " --dialect linuxcnc");
  EXPECT_EQ(moves.code, 0);
  EXPECT_THAT(moves.err, HasSubstr("assumed: line 5: #5399 = 0, which the control decides"));
  EXPECT_THAT(moves.out, Not(HasSubstr("assumed")));
}

TEST(ProgramUnknown, WithAMachineTheTaskIsOne) {
  const Scratch scratch;
  const std::string program = scratch.file(
      "preview.ngc", kHead + "o1 if [#<_task> EQ 0]\nM2\no1 endif\nG1 X2000 F2000\nM2\n");
  const json with = answer_of("program check " + program + kWithMill);
  EXPECT_EQ(with["moves"], 2);
  EXPECT_THAT(with["assumed"], IsEmpty());
  const json without = answer_of("program check " + program + " --dialect linuxcnc");
  EXPECT_EQ(without["moves"], 1);
  EXPECT_EQ(without["assumed"][0]["name"], "#<_task>");
}

TEST(ProgramUnknown, BlocksBehindAnUnknownModeStayUntilTheTextSetsIt) {
  const Scratch scratch;
  const std::string out = scratch.at("out.ngc");
  for (const std::string& guard :
       {kInput, std::string("o1 if [#<_task> EQ 1]\nG91\no1 endif\n"),
        std::string("o1 if [#100 EQ 1]\nG18\no1 endif\n"),
        std::string("#1=#101\no1 if [EXISTS[#<_rough>]]\nG20\no1 endif\n")}) {
    const std::string behind = scratch.file("behind.ngc", kHead + guard + kCuts);
    for (const std::string verb : {"predistort", "feeds"}) {
      const json answer = answer_of("program " + verb + " " + behind + kWithMill +
                                    " --max-error-mm 0.01 --force -o " + out);
      // The feed of a straight line does not depend on the plane.
      if (verb == "feeds" && guard.find("G18") != std::string::npos) {
        EXPECT_TRUE(answer_of("program verify " + behind + " " + out + kWithMill)["proved"]);
        continue;
      }
      EXPECT_EQ(answer["replaced_lines"], 0) << verb << "\n" << guard;
      EXPECT_EQ(text_of_file(out), text_of_file(behind)) << verb << "\n" << guard;
    }
    const std::string again =
        scratch.file("again.ngc", kHead + guard + "G21 G90 G17\nG0 X0 Y0 Z0\n" + kCuts);
    const json answer = answer_of("program predistort " + again + kWithMill +
                                  " --max-error-mm 0.01 --force -o " + out);
    EXPECT_GT(answer["replaced_lines"], 0) << guard;
    EXPECT_TRUE(answer_of("program verify " + again + " " + out + kWithMill)["proved"]) << guard;
    const Finished said = run_line("program verify " + again + " " + out + kWithMill);
    // With a machine file the task is known, and nothing is assumed.
    if (guard.find("_task") == std::string::npos) {
      EXPECT_THAT(said.out, Not(HasSubstr("everything else is the same"))) << guard;
    }
  }
}

TEST(ProgramUnknown, WhatMovesNothingKeepsNoBlockFromBeingCorrected) {
  const Scratch scratch;
  const std::string out = scratch.at("out.ngc");
  const std::string program = scratch.file(
      "door.ngc", kHead +
                      "M66 P0 L0\no1 if [#5399 EQ 1]\n(MSG,door open)\nG4 P1\no1 endif\n"
                      "G4 P[#100*0.1]\nS[1000+#101]\n" +
                      kCuts);
  const json answer =
      answer_of("program predistort " + program + kWithMill + " --max-error-mm 0.01 -o " + out);
  EXPECT_GT(answer["replaced_lines"], 0);
  EXPECT_EQ(answer["assumed"].size(), 3U);
  EXPECT_TRUE(answer_of("program verify " + program + " " + out + kWithMill)["proved"]);
}

TEST(ProgramUnknown, CommentsThatLinuxCncExecutesAreRefusedWithTheirMessage) {
  const Scratch scratch;
  const std::string aborts = scratch.file(
      "abort.ngc", kHead + "o1 if [1]\n(abort, deeper than this tool)\no1 endif\n" + kCuts);
  const Finished aborted = run_line("program check " + aborts + " --dialect linuxcnc");
  EXPECT_EQ(aborted.code, 2);
  EXPECT_THAT(aborted.err, HasSubstr("deeper than this tool"));
  const std::string python = scratch.file("py.ngc", kHead + ";py,this.params[5]=45\n" + kCuts);
  const Finished executed = run_line("program check " + python + " --dialect linuxcnc");
  EXPECT_EQ(executed.code, 2);
  EXPECT_THAT(executed.err, HasSubstr("executes as Python"));
}

}  // namespace
}  // namespace steadyrest::test
