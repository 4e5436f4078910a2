// SPDX-License-Identifier: Apache-2.0
// Learning from the part before, as a user does it: cut and record a part, then write the next one.
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

const std::string kLearnPart = "examples/programs/circle-r10.mpf";

/// The machine as it is: every servo gain 5 % below its file. Returns the option.
std::string softer_machine(const Scratch& scratch) {
  const std::string file = text_of_file(project_file("examples/machines/vmc-840d.toml"));
  const std::string softer =
      std::regex_replace(file, std::regex("servo_gain_m_min_mm = 3"), "servo_gain_m_min_mm = 2.85");
  std::ofstream(scratch.at("softer.toml")) << softer;
  return " --machine " + scratch.at("softer.toml");
}

// One part as the file has the machine, one that has learnt from it.
TEST(ProgramLearns, TakesAwayWhatTheFirstPartHasShown) {
  const Scratch scratch;
  const std::string softer = softer_machine(scratch);
  const std::string against = " --against " + kLearnPart;
  const std::string first = scratch.at("first.mpf");
  answer_of("program predistort " + kLearnPart + kOnVmc + " -o " + first);
  const auto before =
      answer_of("cut " + first + against + softer + " --record " + scratch.at("part.csv"));

  const std::string second = scratch.at("second.mpf");
  const auto answer =
      answer_of("program predistort " + kLearnPart + kOnVmc + " --from-record " +
                scratch.at("part.csv") + " --cut-program " + first + " -o " + second);
  const auto& learnt = answer["learnt"];
  EXPECT_EQ(answer["kept_part"], nullptr);
  ASSERT_EQ(learnt.size(), 1U);
  EXPECT_GT(learnt[0]["learns_s"].get<double>(), 0.9 * learnt[0]["cut_s"].get<double>());
  EXPECT_LT(learnt[0]["convergence"].get<double>(), 0.5);
  // The encoders see what the true tool has, up to the backlash.
  const double was_mm = before["without"]["contour_error_rms_mm"].get<double>();
  EXPECT_NEAR(learnt[0]["measured_rms_mm"].get<double>(), was_mm, 0.0015);

  const auto after = answer_of("cut " + second + against + softer);
  const double is_mm = after["without"]["contour_error_rms_mm"].get<double>();
  EXPECT_GT(was_mm, 0.006);
  EXPECT_LT(is_mm, 0.25 * was_mm);
  EXPECT_NEAR(after["without"]["cycle_time_s"].get<double>(),
              before["without"]["cycle_time_s"].get<double>(), 0.1);
}

// The record of a good part on axes that are not as the file says: whatever follows is as good.
TEST(ProgramLearns, NoPartIsWorseThanTheOneBefore) {
  const Scratch scratch;
  const std::string softer = softer_machine(scratch);
  std::string program = kLearnPart;
  double before_mm = 1.0;
  for (int part = 1; part <= 3; ++part) {
    const std::string record = scratch.at("part" + std::to_string(part) + ".csv");
    const std::string next = scratch.at("part" + std::to_string(part) + ".mpf");
    const auto cut =
        answer_of("cut " + program + " --against " + kLearnPart + softer + " --record " + record);
    const double is_mm = cut["without"]["contour_error_rms_mm"].get<double>();
    EXPECT_LT(is_mm, before_mm + 2e-4) << part;
    before_mm = is_mm;
    ASSERT_EQ(std::system(("gzip " + record).c_str()), 0);  // NOLINT(cert-env33-c)
    answer_of("program predistort " + kLearnPart + kOnVmc + " --from-record " + record +
              ".gz --cut-program " + program + " -o " + next);
    program = next;
  }
  EXPECT_LT(before_mm, 0.002);
}

// A feed override in the middle of the part: there it teaches nothing, and that is said.
TEST(ProgramLearns, LeavesOutWhatWasOverridden) {
  const Scratch scratch;
  std::ofstream(scratch.at("slow.mpf")) << [] {
    std::string text = text_of_file(project_file(kLearnPart));
    const std::size_t feed = text.rfind("F4000");
    return text.replace(feed, 5, "F3000");
  }();
  answer_of("cut " + scratch.at("slow.mpf") + kOnVmc + " --record " + scratch.at("part.csv"));
  const std::string line = "program predistort " + kLearnPart + kOnVmc + " --from-record " +
                           scratch.at("part.csv") + " -o " + scratch.at("changed.mpf");
  expect_refused(line, "part.csv");
  const Finished said = run_line(line);
  EXPECT_THAT(said.err, testing::HasSubstr("another feed than planned"));
}

// Two names in the head of the record, exchanged.
TEST(ProgramLearns, RefusesColumnsThatAreSwapped) {
  const Scratch scratch;
  answer_of("cut " + kLearnPart + kOnVmc + " --record " + scratch.at("part.csv"));
  const std::string record = text_of_file(scratch.at("part.csv"));
  const std::string line = "program predistort " + kLearnPart + kOnVmc + " -o " +
                           scratch.at("changed.mpf") + " --from-record " +
                           scratch.at("swapped.csv");
  const auto refused_with = [&](const std::string& head, const std::string& why) {
    std::ofstream(scratch.at("swapped.csv")) << head << record.substr(record.find('\n'));
    expect_refused(line, why);
  };
  refused_with("t_s,x_act_mm,y_act_mm,z_act_mm,x_cmd_mm,y_cmd_mm,z_cmd_mm",
               "x_cmd_mm with x_act_mm");
  refused_with("t_s,x_cmd_mm,y_cmd_mm,z_cmd_mm,y_act_mm,x_act_mm,z_act_mm",
               "x_act_mm and y_act_mm");
  refused_with("t_s,y_cmd_mm,x_cmd_mm,z_cmd_mm,x_act_mm,y_act_mm,z_act_mm",
               "x_cmd_mm and y_cmd_mm");
}

// A line of equal axes has nothing to learn, and nothing is promised for it.
TEST(ProgramLearns, PromisesNothingForAProgramThatStays) {
  const Scratch scratch;
  std::ofstream(scratch.at("line.mpf")) << "G17 G71 G90 G94 G64\nG0 X0 Y0\nG1 X80 Y60 F1000\n"
                                           "G0 Z5\nM30\n";
  answer_of("cut " + scratch.at("line.mpf") + kOnVmc + " --record " + scratch.at("line.csv"));
  const Finished said =
      run_line("program predistort " + scratch.at("line.mpf") + kOnVmc + " --from-record " +
               scratch.at("line.csv") + " -o " + scratch.at("changed.mpf"));
  EXPECT_THAT(said.out, testing::HasSubstr("learnt from"));
  EXPECT_THAT(said.out, testing::Not(testing::HasSubstr("the next part")));
  EXPECT_EQ(text_of_file(scratch.at("changed.mpf")), text_of_file(scratch.at("line.mpf")));
}

TEST(ProgramLearns, RefusesRecordsThatDoNotFit) {
  const Scratch scratch;
  const std::string line = "program predistort " + kLearnPart + kOnVmc + " -o " +
                           scratch.at("changed.mpf") + " --from-record ";
  std::ofstream(scratch.at("short.csv")) << "t_s,x_cmd_mm\n0,1\n";
  expect_refused(line + scratch.at("short.csv"), "y_cmd_mm");
  expect_refused(line + scratch.at("absent.csv"), "absent.csv");
  expect_refused(line + scratch.at("short.csv") + " --cut-program " + kLearnPart +
                     " --cut-program " + kLearnPart,
                 "2 times");
  expect_all_refused({"program predistort " + kLearnPart + kOnVmc + " -o " +
                      scratch.at("changed.mpf") + " --cut-program " + kLearnPart});
}

}  // namespace
}  // namespace steadyrest::test
