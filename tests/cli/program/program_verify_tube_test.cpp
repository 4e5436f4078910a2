// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

const std::string kTubeCircle = "examples/programs/circle-r10.mpf";
const std::string kTubePocket = "examples/programs/rib-pocket.ngc";
const std::string kTubeMill = " --machine examples/machines/linuxcnc-mill.toml";

// The mark in the program says what is to be proved, and how the program is read.
TEST(ProgramVerify, ProvesAPredistortedProgramByWhatItSaysOfItself) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.mpf");
  const auto made = answer_of("program predistort " + kTubeCircle + kOnVmc + " -o " + changed);
  const auto proof = answer_of("program verify " + kTubeCircle + " " + changed);
  EXPECT_TRUE(proof["proved"].get<bool>());
  EXPECT_EQ(proof["replaced_lines"], made["replaced_lines"]);
  EXPECT_EQ(proof["new_lines"], made["new_lines"]);
  EXPECT_DOUBLE_EQ(proof["tube_mm"].get<double>(), 0.5);
  // On the circle the command is as far outside as the error would have been inside.
  EXPECT_NEAR(proof["farthest_mm"].get<double>(), made["largest_shift_mm"].get<double>(), 0.003);
  EXPECT_EQ(proof["inserted_lines"], 0);
  answer_of("program verify " + kTubeCircle + " " + changed + kOnVmc + " --tube-mm 0.1");
  expect_refused("program verify " + kTubeCircle + " " + changed + " --tube-mm 0.05",
                 "the tube is 0.05 mm");
  expect_refused("program verify " + kTubeCircle + " " + changed + " --dialect linuxcnc",
                 "was made with --dialect sinumerik");
}

TEST(ProgramVerify, ProvesATextThatHadNotToBeChanged) {
  const auto proof = answer_of("program verify " + kTubePocket + " " + kTubePocket + kTubeMill);
  EXPECT_TRUE(proof["proved"].get<bool>());
  EXPECT_EQ(proof["replaced_lines"], 0);
  EXPECT_GT(proof["moves"].get<int>(), 0);
}

TEST(ProgramVerify, NamesTheLowestFeed) {
  const Scratch scratch;
  const std::string feeds = scratch.at("feeds.ngc");
  answer_of("program feeds " + kTubePocket + kTubeMill + " --max-error-mm 0.02 -o " + feeds);
  const auto proof = answer_of("program verify " + kTubePocket + " " + feeds + kTubeMill);
  EXPECT_GT(proof["least_feed_ratio"].get<double>(), 0.0);
  EXPECT_LT(proof["least_feed_ratio"].get<double>(), 1.0);
  EXPECT_GT(proof["slowest_line"].get<int>(), 0);
}

/// Writes the text with `what` put in at a place; the number of its line.
std::ptrdiff_t put_in(const std::string& file, std::string text, std::size_t at,
                      const std::string& what) {
  EXPECT_NE(at, std::string::npos);
  const auto line = 1 + std::ranges::count(std::string_view(text).substr(0, at), '\n');
  std::ofstream(file, std::ios::binary) << text.insert(at, what);
  return line;
}

TEST(ProgramVerify, RefusesAReplacedBlockChangedByHandWithItsLine) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.mpf");
  answer_of("program predistort " + kTubeCircle + kOnVmc + " -o " + changed);
  const std::string text = text_of_file(changed);
  // Ten times the feed and more.
  const std::size_t feed = text.rfind(" F", text.find(" ;STEADYREST new"));
  const auto line = put_in(changed, text, feed + 2, "9");
  expect_refused("program verify " + kTubeCircle + " " + changed,
                 "changed.mpf:" + std::to_string(line) + ": has a feed of");
}

TEST(ProgramVerify, ProvesFeedsAndSpeedsOnTheSamePath) {
  const Scratch scratch;
  const std::string feeds = scratch.at("feeds.ngc");
  answer_of("program feeds " + kTubePocket + kTubeMill + " --max-error-mm 0.02 -o " + feeds);
  const auto proof = answer_of("program verify " + kTubePocket + " " + feeds + kTubeMill);
  EXPECT_LT(proof["farthest_mm"].get<double>(), 0.001);
  EXPECT_GT(proof["replaced_lines"].get<int>(), 100);
  const std::string slot = "examples/programs/slot.mpf";
  const std::string speeds = scratch.at("speeds.mpf");
  answer_of("program speeds " + slot + kOnVmc +
            " --process examples/processes/slot-922hz.toml --depth-mm 1 -o " + speeds);
  EXPECT_GT(
      answer_of("program verify " + slot + " " + speeds + kOnVmc)["replaced_lines"].get<int>(), 0);
}

// Both marks: the plan's corrections are proved in the program with its blocks put back, the blocks
// against that.
TEST(ProgramVerify, ProvesCorrectionsAndReplacedBlocksInOneProgram) {
  const Scratch scratch;
  const std::string plan = " --plan examples/plans/rib-pocket.json";
  const std::string changed = scratch.at("both.ngc");
  answer_of("program predistort examples/plans/rib-pocket-compensated.ngc" + kTubeMill + " -o " +
            changed);
  const std::string verify = "program verify " + kTubePocket + " " + changed + kTubeMill;
  expect_refused(verify, "give the plan with --plan PLAN.json");
  const auto proof = answer_of(verify + plan);
  EXPECT_GT(proof["inserted_lines"].get<int>(), 0);
  EXPECT_GT(proof["corrected_moves"].get<int>(), 0);
  EXPECT_GT(proof["replaced_lines"].get<int>(), 0);
  // Another last correction shows at the end, the line after it; its number is the changed
  // program's.
  const std::string text = text_of_file(changed);
  const auto line = put_in(changed, text, text.find(']', text.rfind("G10 L20")), "+1");
  expect_refused(verify + plan, "both.ngc:" + std::to_string(line + 1));
}

TEST(ProgramVerify, RefusesAnotherProgramWithoutMarks) {
  const Scratch scratch;
  const std::string other = scratch.at("other.ngc");
  std::ofstream(other, std::ios::binary) << text_of_file(kTubePocket) << "\n";
  expect_refused("program verify " + kTubePocket + " " + other + kTubeMill,
                 "has neither corrections inserted nor blocks replaced");
  expect_all_refused(
      {"program verify " + kTubePocket + " " + kTubePocket + kTubeMill + " --tube-mm 0",
       "program verify " + kTubePocket + kTubeMill});
}

}  // namespace
}  // namespace steadyrest::test
