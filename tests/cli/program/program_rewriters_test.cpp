// SPDX-License-Identifier: Apache-2.0
// What a verb that rewrites a program writes, `program verify` accepts; at worst a block stays.
#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::test {
namespace {

const std::string kOnMill = " --machine examples/machines/linuxcnc-mill.toml";
constexpr std::array<std::string_view, 3> kPathAndFeeds = {"predistort", "feeds", "correct"};

/// Writes by each of the verbs and proves it; the replaced lines of each. `shaping`: options of
/// predistort alone.
std::vector<int> written_and_proved(const std::string& program, const std::string& options,
                                    const std::string& shaping = "") {
  const Scratch scratch;
  const std::string original = scratch.file("p.ngc", program);
  std::vector<int> replaced;
  for (const std::string_view verb : kPathAndFeeds) {
    const std::string changed = scratch.at("changed.ngc");
    const auto made = answer_of("program " + std::string(verb) + " " + original + options +
                                (verb == "predistort" ? shaping : "") +
                                " --max-error-mm 0.01 --force -o " + changed);
    const auto proof = answer_of("program verify " + original + " " + changed + options);
    EXPECT_EQ(proof["replaced_lines"], made["replaced_lines"]) << verb << "\n" << program;
    answer_of("program strip " + changed + " --force -o " + scratch.at("back.ngc"));
    EXPECT_EQ(text_of_file(scratch.at("back.ngc")), program) << verb;
    replaced.push_back(made["replaced_lines"].get<int>());
  }
  return replaced;
}

// LinuxCNC ignores G52 and G92 when G10 changes the rotation under them, so the next cut begins
// elsewhere than the control counts from.
TEST(ProgramRewriters, WriteNothingThatVerifyRejectsAfterARotationUnderAShift) {
  const Scratch scratch;
  std::string offsets = "5220\t1\n";
  for (int number = 5161; number <= 5390; ++number) {
    offsets += number == 5220 ? "" : std::to_string(number) + "\t0\n";
  }
  const std::string known = kOnMill + " --variables " + scratch.file("mill.var", offsets);
  for (const char* const shift :
       kernel::testing::cases({"G52 Y3", "G92 Y2", "G92 X9 Y1\nG92.2\nG92.3", "G55\nG52 X1 Y3"})) {
    for (const char* const turn : kernel::testing::cases(
             {"G10 L2 P0 X2 R71", "G10 L2 P0 R-30", "G10 L2 P0 R20\nG10 L2 P0 R71",
              "G10 L2 P0 R71\nG43.1 Z1", "G10 L2 P0 R71\nG10 L20 P0 X3"},
             2)) {
      const auto replaced = written_and_proved(
          std::string("G21 G90 G17 G54\nS1000 M3\nG0 X10 Y5 Z1\n") + shift + "\n" + turn +
              "\nG1 Y20 F2000\nG1 X30\nG1 Y40\nG3 X40 Y50 I10 J0\nG1 X80\nG0 Z5\nM2\n",
          known);
      EXPECT_GT(replaced[0], 0) << shift << ' ' << turn;
    }
  }
}

// A block with another G word leans on the motion in force before it.
TEST(ProgramRewriters, PutTheMotionWordBackBeforeABlockThatLeansOnIt) {
  for (const char* const next : kernel::testing::cases(
           {"G91 X-5\nG90", "G90 X145", "G40 X145", "G64 P0.01 X145", "G54 X145", "G9 X145",
            "G53 X145", "G43.1 Z0 X145", "G61 X145\nG64 P0.01", "M8\nX145", "G91 X0\nG90\nX145",
            "X145 M8", "M70\nG91\nM72\nX145", "G4 P1\nX145"},
           4)) {
    const std::string text = std::string("G21 G90 G17 G54 G64 P0.01\nS1000 M3\nG0 X100 Y100 Z5\n") +
                             "G1 Z0 F2000\nX150\nG3 X160 Y110 I0 J10\nG1 Y150\n" + next +
                             "\nG0 Z5\nM2\n";
    if (std::string_view(next).starts_with("G9 ")) {
      continue;  // not a word of linuxcnc
    }
    EXPECT_GT(written_and_proved(text, kOnMill)[0], 0) << next;
  }
  for (const std::string dialect : {"fanuc", "sinumerik"}) {
    for (const char* const next : {"G91 X-5.\nG90", "G40 X145.", "G64 X145.", "G54 X145.",
                                   "G9 X145.", "G90 X145.", "X145. M8"}) {
      const std::string text = std::string(dialect == "fanuc" ? "O0011\n" : "") + "G90 G17 G54\n" +
                               (dialect == "fanuc" ? "G21\n" : "G71\n") +
                               "S1000 M3\nG0 X100. Y100. Z5.\nG1 Z0. F3000.\nX150.\nG3 X160. Y110. "
                               "I0. J10.\nG1 Y150.\n" +
                               next + "\nG0 Z5.\nM30\n";
      EXPECT_GT(
          written_and_proved(text, kOnVmc + " --dialect " + dialect, " --max-time-percent 0.5")[0],
          0)
          << dialect << ' ' << next;
    }
  }
}

TEST(ProgramRewriters, ProveAnUnchangedProgramByTheOptionsThatItWasMadeWith) {
  const Scratch scratch;
  const std::string program = scratch.file(
      "p.nc", "O0012\nG21 G90 G17 G54\nS1000 M3\nG0 X0 Y0 Z5.\nG1 Z0 F6.\nX10.\nG0 Z5.\nM30\n");
  const std::string changed = scratch.at("changed.nc");
  const std::string options = kOnVmc + " --dialect fanuc";
  const auto made =
      answer_of("program predistort " + program + options + " --max-error-mm 0.01 -o " + changed);
  EXPECT_EQ(made["replaced_lines"], 0);
  EXPECT_EQ(text_of_file(changed), text_of_file(program));
  const auto proof = answer_of("program verify " + program + " " + changed + options);
  EXPECT_TRUE(proof["proved"].get<bool>());
  EXPECT_EQ(proof["replaced_lines"], 0);
  EXPECT_GT(proof["moves"].get<int>(), 0);
  // Another text is not proved by that.
  const std::string other = scratch.file("other.nc", text_of_file(program) + "\n");
  expect_refused("program verify " + program + " " + other + options);
}

// The drive turns no faster than max_rpm, whatever S asks for; the wait for its speed ends.
TEST(ProgramRewriters, TakeASpeedAboveTheSpindles) {
  const Scratch scratch;
  const std::string machine =
      scratch.file("m.toml", text_of_file(project_file("examples/machines/linuxcnc-mill.toml")));
  for (const char* const speed : {"S99000 M3", "S99000 M4", "G95 S99000 M3\nF0.05"}) {
    const std::string program = scratch.file(
        "p.ngc", std::string("G21 G90 G17 G94 F2000\n") + speed +
                     "\nG0 X0 Y0 Z1\nG1 Z0\nG1 X40\nG3 X50 Y10 I0 J10\nG1 Y40\nG0 Z5\nM2\n");
    for (const std::string_view verb : kPathAndFeeds) {
      const auto made =
          answer_of("program " + std::string(verb) + " " + program + " --machine " + machine +
                    " --max-error-mm 0.01 --force -o " + scratch.at("changed.ngc"));
      EXPECT_GE(made["replaced_lines"].get<int>(), 0) << speed;
    }
    const auto time = answer_of("program time " + program + " --machine " + machine);
    EXPECT_LT(time["spindle_wait_s"].get<double>(), 60.0) << speed;
  }
}

TEST(ProgramRewriters, TimeWeeksInASecond) {
  const Scratch scratch;
  const std::string program =
      scratch.file("slow.ngc", "G21 G90 F1000\nG1 X9999999\nG1 X-9999999\nG4 P86400\nM2\n");
  const auto begin = std::chrono::steady_clock::now();
  const auto time = answer_of("program time " + program + kOnMill);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_NEAR(time["seconds"].get<double>(), 3.0 * 9999999 / (1000.0 / 60.0) + 86400.0, 1.0);
  EXPECT_LT(took.count(), 20.0) << "even sanitized, on a busy machine";
}

TEST(ThermalPlan, RefusesAProgramThatTakesNoTime) {
  const Scratch scratch;
  const std::string program = scratch.file("p.ngc", "G21 G90\nG0 X0\nM2\n");
  const std::string on = " --machine examples/thermal-batch/machine.toml --program " + program;
  expect_refused("thermal plan" + on + " --tolerance-um 0.3 -o " + scratch.at("plan.json"),
                 "takes no time");
  expect_refused("thermal forecast" + on + " -o " + scratch.at("f.csv"), "takes no time");
}

}  // namespace
}  // namespace steadyrest::test
