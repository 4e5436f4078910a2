// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using testing::HasSubstr;

const std::string kProgram = "examples/programs/rib-pocket.ngc";
const std::string kWithPlan =
    " --plan examples/plans/rib-pocket.json --machine examples/machines/linuxcnc-mill.toml";

// The example's compensated program is stored; compensate must reproduce it, verify prove it, strip
// restore the original.
TEST(ProgramCompensate, TellsEveryInsertionAndStripRestoresTheProgram) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.ngc");
  const auto answer = answer_of("program compensate " + kProgram + kWithPlan + " -o " + changed);
  ASSERT_EQ(answer["insertions"].size(), 3U);
  for (const auto& one : answer["insertions"]) {
    EXPECT_NEAR(one["time_s"].get<double>(), one["planned_s"].get<double>(), 60.0);
    EXPECT_GT(one["line"].get<int>(), 0);
  }
  EXPECT_NEAR(answer["insertions"][0]["delta_um"].get<double>(), -10.0, 1e-9);
  EXPECT_EQ(text_of_file(changed),
            text_of_file(project_file("examples/plans/rib-pocket-compensated.ngc")));
  const auto proof = answer_of("program verify " + kProgram + " " + changed + kWithPlan);
  EXPECT_TRUE(proof["proved"].get<bool>());
  EXPECT_EQ(proof["inserted_lines"], answer["inserted_lines"]);
  expect_refused("program strip " + changed + " -o " + changed, "is the input file itself");
  const auto removed = answer_of("program strip " + changed + " --force -o " + changed);
  EXPECT_EQ(removed["removed_lines"], answer["inserted_lines"]);
  EXPECT_EQ(text_of_file(changed), text_of_file(project_file(kProgram)));
}

// A window too small for any safe place, a control without a method, a program already corrected.
TEST(ProgramCompensate, RefusesWhatItCannotDoRight) {
  const Scratch scratch;
  const std::string to = " -o " + scratch.at("changed.ngc");
  expect_refused("program compensate " + kProgram + kWithPlan + to + " --window-s 0.5",
                 "no safe place");
  const auto unwritten =
      run_line("program compensate " + kProgram + kWithPlan + " -o " + scratch.at("none/x.ngc"));
  EXPECT_EQ(unwritten.code, 1);
  EXPECT_THAT(unwritten.err, HasSubstr("not writable"));
  expect_refused(
      "program compensate examples/programs/rib-pocket.mpf --dialect sinumerik" + kWithPlan + to,
      "--r-parameter");
  expect_refused("program compensate examples/plans/rib-pocket-compensated.ngc" + kWithPlan + to,
                 "program strip");
  expect_refused("program verify " + kProgram + " " + kProgram + kWithPlan, "head");
  expect_refused("program verify " + kProgram + " " + kProgram + kWithPlan, "has no corrections");
  EXPECT_FALSE(std::filesystem::exists(scratch.at("changed.ngc")));
}

// The mark in the program supplies --window-s; 45.0 agrees with 45, 60 does not.
TEST(ProgramVerify, KnowsFromTheMarkWhatTheProgramWasMadeWith) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.ngc");
  const std::string files = kProgram + " " + changed + kWithPlan;
  answer_of("program compensate " + kProgram + kWithPlan + " -o " + changed +
            " --window-s 45 --data-units mm");
  EXPECT_THAT(
      text_of_file(changed),
      HasSubstr("(STEADYREST head told --dialect linuxcnc --window-s 45 --data-units mm --sum "));
  EXPECT_TRUE(answer_of("program verify " + files)["proved"].get<bool>());
  EXPECT_TRUE(answer_of("program verify " + files + " --window-s 45.0")["proved"].get<bool>());
  expect_refused("program verify " + files + " --window-s 60",
                 "was made with --window-s 45, not 60");
  expect_refused("program verify " + files + " --block-delete", "was made without --block-delete");
  const std::string stripped = scratch.at("stripped.ngc");
  answer_of("program strip " + changed + " -o " + stripped);
  EXPECT_EQ(text_of_file(stripped), text_of_file(project_file(kProgram)));
}

}  // namespace
}  // namespace steadyrest::test
