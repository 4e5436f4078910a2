// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string>
#include <vector>

#include "expectations.hpp"
#include "live/live_layer.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

// The slot of docs/chatter-slot.md, in real time: it chatters, and 90 % of the speed helps.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kSlotProgram = "examples/programs/slot.mpf";
const std::string kSlotProcess = "examples/processes/slot-922hz.toml";
const std::string kSlotRun =
    "run --machine examples/machines/vmc-840d.toml --program " + kSlotProgram + " --socket s ";

TEST(RunChatter, HearsItTakesABetterStepAndIsDecidedAgain) {
  const Scratch scratch;
  const json answer = answer_of(kSlotRun + "--mode act --for-s 4 --process " + kSlotProcess +
                                " --depth-mm 0.6 --record " + scratch.at("runs"));
  EXPECT_GE(answer["chatter_events"], 1);
  EXPECT_GT(answer["chatter_s"].get<double>(), 0.0);
  EXPECT_LT(answer["chatter_s"].get<double>(), 1.5);
  EXPECT_GT(answer["reasons"]["chatter_modulating"].get<int>(), 100);
  const json again = answer_of("record replay " + answer["record"]["file"].get<std::string>());
  EXPECT_EQ(again["cycles"], answer["cycles"]);
  EXPECT_TRUE(again["first_difference"].is_null()) << again;
}

// The process comes from a measured response: the record has what was fitted, not the file's name
// alone.
TEST(RunChatter, ARecordNeedsNeitherProcessNorResponse) {
  const Scratch scratch;
  scratch.file("tap-922hz.csv", text_of_file(project_file("examples/processes/tap-922hz.csv")));
  const std::string process =
      scratch.file("slot.toml", text_of_file(project_file("examples/processes/slot-tapped.toml")));
  const json answer = answer_of(kSlotRun + "--mode act --for-s 3 --process " + process +
                                " --depth-mm 0.6 --record " + scratch.at("runs"));
  EXPECT_GE(answer["chatter_events"], 1);
  scratch.file("tap-922hz.csv", "");
  scratch.file("slot.toml", "");
  const json again = answer_of("record replay " + answer["record"]["file"].get<std::string>());
  EXPECT_EQ(again["cycles"], answer["cycles"]);
  EXPECT_TRUE(again["first_difference"].is_null()) << again;
}

TEST(RunChatter, GoesOnListeningWithAnotherMachineFile) {
  LiveLayer layer("act",
                  {"--process", project_file(kSlotProcess), "--depth-mm", "0.6", "--repeat",
                   "--record", "runs"},
                  kSlotProgram);
  const auto chatter = [] { return LiveLayer::status()["chatter"]; };
  EXPECT_TRUE(LiveLayer::until([&] { return !chatter()["before"].is_null(); }));
  EXPECT_THAT(run_line("status").out, HasSubstr("better step: 90 %"));
  layer.change("limit_um = 10\n", "limit_um = 20\n");
  layer.process().send(SIGHUP);
  json status = LiveLayer::after_reload(1);
  EXPECT_EQ(status["reload"]["outcome"], "taken");
  EXPECT_EQ(status["chatter"]["better_spindle_percent"], 90.0);
  // Other settings of the spindle's room: it starts over, the step stays.
  layer.change("max_feed_percent = 120", "max_feed_percent = 110");
  layer.process().send(SIGHUP);
  status = LiveLayer::after_reload(2);
  EXPECT_EQ(status["reload"]["outcome"], "taken");
  EXPECT_EQ(status["chatter"]["better_spindle_percent"], 90.0);
  EXPECT_TRUE(LiveLayer::until([&] { return LiveLayer::status()["cutting"] == true; }));
  layer.process().send(SIGTERM);
  EXPECT_EQ(layer.process().wait(), 0) << layer.process().err();
  const json listed = answer_of("record list " + layer.at("runs"));
  const json again = answer_of("record replay " + listed["records"][0]["file"].get<std::string>());
  EXPECT_EQ(again["reloads"], 2);
  EXPECT_TRUE(again["first_difference"].is_null()) << again;
}

TEST(RunChatter, OnlyTellsWhereItIsToldTo) {
  const json answer = answer_of(kSlotRun + "--mode act --for-s 4 --process " + kSlotProcess +
                                " --depth-mm 0.6 --chatter machine");
  EXPECT_GE(answer["chatter_events"], 1);
  EXPECT_GT(answer["chatter_s"].get<double>(), 1.0);
  EXPECT_FALSE(answer["reasons"].contains("chatter_modulating"));
}

TEST(RunChatter, WithoutAProcessNothingIsHeard) {
  const json answer = answer_of(kSlotRun + "--for-s 0.1");
  EXPECT_FALSE(answer.contains("chatter_s"));
}

TEST(RunChatter, RefusesWhatMakesNoSense) {
  const std::string process = "--process " + kSlotProcess;
  expect_refused(kSlotRun + process, "--process without --depth-mm");
  expect_refused(kSlotRun + process + " --depth-mm 0", "not above 0");
  expect_refused(kSlotRun + "--depth-mm 1", "--process");
  expect_refused(kSlotRun + "--chatter machine", "--process");
  expect_refused(kSlotRun + process + " --depth-mm 1 --chatter plan", "plan");
  expect_refused(kSlotRun + "--process none.toml --depth-mm 1", "none.toml");
  expect_refused("run --machine examples/machines/ideal-k50.toml --program " + kSlotProgram +
                     " --socket s " + process + " --depth-mm 1",
                 "no spindle override");
}

}  // namespace
}  // namespace steadyrest::test
