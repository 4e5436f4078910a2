// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string>

#include "expectations.hpp"
#include "live/live_layer.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Real time passes here, and nothing is said of how much: a busy computer is late.
namespace steadyrest::test {
namespace {

using ::testing::HasSubstr;

const std::string kOnMill = "run --machine examples/machines/vmc-840d.toml";
const std::string kCutting = kOnMill + " --program examples/programs/circle-r10.mpf";

TEST(Run, TellsWhatARunHasShown) {
  const auto answer = answer_of(kCutting + " --for-s 0.4 --mode act --socket s");
  EXPECT_GE(answer["cycles"].get<int>(), 100);
  EXPECT_GT(answer["work_p50_us"].get<double>(), 0.0);
  EXPECT_GE(answer["work_p999_us"].get<double>(), answer["work_p50_us"].get<double>());
  EXPECT_GE(answer["lateness_p999_us"].get<double>(), 0.0);
  EXPECT_EQ(answer["over_limit_s"], 0.0);
  EXPECT_EQ(answer["port"], "sim");
  EXPECT_EQ(answer["handed_back"], true);
  EXPECT_GT(answer["reasons"]["not_cutting"].get<int>(), 0);
}

TEST(Run, IsRecordedAndDecidedAgain) {
  const Scratch scratch;
  const auto answer =
      answer_of(kCutting + " --for-s 0.4 --mode act --socket s --record " + scratch.at("runs"));
  EXPECT_EQ(answer["record"]["dropped"], 0);
  EXPECT_TRUE(answer["record"]["fault"].is_null());
  const auto again = answer_of("record replay " + answer["record"]["file"].get<std::string>());
  EXPECT_EQ(again["cycles"], answer["cycles"]);
  EXPECT_TRUE(again["first_difference"].is_null());
}

TEST(Run, IsRefusedWhereItCannotRun) {
  expect_refused(kOnMill + " --socket s", "nothing to cut");
  expect_refused(kCutting + " --socket s --mode fast", "--mode");
  expect_refused(kCutting + " --socket s --for-s 0", "--for-s");
  expect_refused(kCutting + " --socket none/s", "the socket cannot be made");
  expect_refused("run --program examples/programs/circle-r10.mpf", "--machine");
}

TEST(Run, IsAskedAndToldOverItsSocket) {
  LiveLayer layer;
  const auto status = answer_of("status");
  EXPECT_EQ(status["mode_wanted"], "observe");
  EXPECT_EQ(status["port"], "sim");
  EXPECT_EQ(status["reasons"].size(), 4U);
  EXPECT_EQ(answer_of("mode act")["mode_wanted"], "act");
  EXPECT_EQ(answer_of("status")["mode_wanted"], "act");
  expect_refused("mode fast", "MODE");
  expect_refused(kCutting + " --for-s 1", "another layer answers on this socket");
  layer.process().send(SIGTERM);
  EXPECT_EQ(layer.process().wait(), 0) << layer.process().err();
  const Finished after = run_line("status");
  EXPECT_EQ(after.code, 1);
  EXPECT_THAT(after.err, HasSubstr("no layer answers on"));
}

}  // namespace
}  // namespace steadyrest::test
