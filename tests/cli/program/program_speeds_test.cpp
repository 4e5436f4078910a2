// SPDX-License-Identifier: Apache-2.0
#include <fstream>
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

const std::string kSlotPart = "examples/programs/slot.mpf";
const std::string kWithSlotProcess = " --process examples/processes/slot-922hz.toml";

// The depth that the solver finds stable at the written speed, and the cut in time, agree.
TEST(ProgramSpeeds, WritesASpeedAtWhichTheSlotIsStable) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.mpf");
  const auto answer = answer_of("program speeds " + kSlotPart + kOnVmc + kWithSlotProcess +
                                " --depth-mm 1 -o " + changed);
  ASSERT_EQ(answer["cuts"].size(), 1U);
  const auto& cut = answer["cuts"][0];
  EXPECT_EQ(cut["speed_rpm_before"], 5000.0);
  EXPECT_EQ(cut["decision"], "constant");
  const double ratio = cut["feed_ratio"].get<double>();
  EXPECT_NEAR(cut["speed_rpm_after"].get<double>(), 5000.0 * ratio, 1e-9);
  const auto stable = [](double speed_rpm) {
    return answer_of("chatter radius examples/processes/slot-922hz.toml --depth-mm 1 --speed-rpm " +
                     std::to_string(speed_rpm))["stable"]
        .get<bool>();
  };
  EXPECT_FALSE(stable(5000.0));
  EXPECT_TRUE(stable(cut["speed_rpm_after"].get<double>()));
  EXPECT_GT(cut["limit_depth_mm"].get<double>(), 1.0);
  // The feed per tooth is kept: the cut is shorter by the ratio, give or take its ramps.
  const std::string of_cut = kOnVmc + kWithSlotProcess + " --depth-mm 1 --chatter machine";
  const auto before = answer_of("cut " + kSlotPart + of_cut)["without"];
  const auto after = answer_of("cut " + changed + of_cut)["without"];
  EXPECT_LT(after["unforced_rms_um"].get<double>(), 0.2 * before["unforced_rms_um"].get<double>());
  EXPECT_NEAR(after["cutting_time_s"].get<double>() * ratio, before["cutting_time_s"].get<double>(),
              0.15);
  answer_of("program strip " + changed + " -o " + scratch.at("back.mpf"));
  EXPECT_EQ(text_of_file(scratch.at("back.mpf")), text_of_file(project_file(kSlotPart)));
}

TEST(ProgramSpeeds, NamesCutsUnderG96AndOfOtherToolsAndLeavesThem) {
  const Scratch scratch;
  const std::string program = scratch.at("part.ngc");
  std::ofstream(program) << "G21 G90 G94 G17 G61\nT1 M6\nS5000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F500\nX50\n"
                            "G0 Z5\nT2 M6\nS5000 M3\nG1 Z-1 F500\nG0 Z5\n"
                            "G96 D3000 S100 M3\nG1 X10 F500\nM2\n";
  const std::string mill = " --machine examples/machines/linuxcnc-mill.toml";
  const auto cuts = answer_of("program speeds " + program + mill + kWithSlotProcess +
                              " --depth-mm 1 --tool 1 -o " + scratch.at("out.ngc"))["cuts"];
  ASSERT_EQ(cuts.size(), 3U);
  EXPECT_EQ(cuts[0]["decision"], "constant");
  EXPECT_EQ(cuts[1]["decision"], "stays");
  EXPECT_THAT(cuts[1]["reason"].get<std::string>(), HasSubstr("tool 1"));
  EXPECT_EQ(cuts[2]["decision"], "stays");
  EXPECT_THAT(cuts[2]["reason"].get<std::string>(), HasSubstr("G96"));
  EXPECT_EQ(cuts[2]["feed_ratio"], 1.0);
}

TEST(ProgramSpeeds, LeavesASpeedThatIsStable) {
  const Scratch scratch;
  const auto answer = answer_of("program speeds " + kSlotPart + kOnVmc + kWithSlotProcess +
                                " --depth-mm 0.2 -o " + scratch.at("out.mpf"));
  EXPECT_EQ(answer["cuts"][0]["decision"], "keep");
  EXPECT_TRUE(answer["unchanged"].get<bool>());
  EXPECT_EQ(text_of_file(scratch.at("out.mpf")), text_of_file(project_file(kSlotPart)));
}

TEST(ProgramSpeeds, SaysSoWhereNoSpeedHelps) {
  const Scratch scratch;
  const auto answer = answer_of("program speeds " + kSlotPart + kOnVmc + kWithSlotProcess +
                                " --depth-mm 20 -o " + scratch.at("out.mpf"));
  EXPECT_EQ(answer["cuts"][0]["decision"], "nothing");
  EXPECT_THAT(answer["cuts"][0]["reason"].get<std::string>(), HasSubstr("likely to be stable"));
}

TEST(ProgramSpeeds, RefusesWhatItCannotDo) {
  const Scratch scratch;
  const std::string to = " -o " + scratch.at("out.mpf");
  const std::string depth = " --depth-mm 1";
  const std::string twice = scratch.at("twice.mpf");
  answer_of("program speeds " + kSlotPart + kOnVmc + kWithSlotProcess + depth + " -o " + twice);
  expect_refused("program speeds " + twice + kOnVmc + kWithSlotProcess + depth + to,
                 "replaced already");
  expect_all_refused(
      {"program speeds " + kSlotPart + kOnVmc + kWithSlotProcess + to,
       "program speeds " + kSlotPart + kOnVmc + depth + to,
       "program speeds " + kSlotPart + kWithSlotProcess + depth + to,
       "program speeds " + kSlotPart + kOnVmc + kWithSlotProcess + depth,
       "program speeds " + kSlotPart + kOnVmc + kWithSlotProcess + " --depth-mm 0" + to,
       "program speeds " + kSlotPart + kOnVmc + " --process " + kSlotPart + depth + to});
}

}  // namespace
}  // namespace steadyrest::test
