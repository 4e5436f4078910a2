// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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

bool has(const nlohmann::json& shown, const std::string& kind, const std::string& text) {
  return std::ranges::any_of(shown["events"], [&](const auto& event) {
    return event["kind"] == kind &&
           event["text"].template get<std::string>().find(text) != std::string::npos;
  });
}

TEST(Run, AFaultLeavesTheLastSecondsApart) {
  const Scratch scratch;
  const auto answer =
      answer_of(kCutting + " --for-s 1 --lose-link-at-s 0.3 --mode act --socket s " + "--record " +
                scratch.at("runs"));
  EXPECT_GT(answer["port_faults"].get<int>(), 10);
  const auto list = answer_of("record list " + scratch.at("runs"));
  // A busy computer may add one for a burst of overruns.
  const auto kept = std::ranges::find_if(list["records"], [](const auto& record) {
    const auto shown = answer_of("record show " + record["file"].template get<std::string>());
    return has(shown, "note", "kept: the port could not be read or written") &&
           record["file"].template get<std::string>().find("/fault-") != std::string::npos;
  });
  ASSERT_NE(kept, list["records"].end());
  EXPECT_FALSE((*kept)["rotates"].get<bool>());
  EXPECT_TRUE((*kept)["closed"].get<bool>());
  EXPECT_GE((*kept)["samples"], 70) << "until the loss: 75 cycles of 4 ms";
  EXPECT_TRUE(has(answer_of("record show " + (*kept)["file"].get<std::string>()), "unread",
                  "link is lost"));
  const auto again = answer_of("record replay " + answer["record"]["file"].get<std::string>());
  EXPECT_TRUE(again["first_difference"].is_null()) << again["first_difference"];
}

TEST(Run, IsRefusedWhereItCannotRun) {
  expect_refused(kOnMill + " --socket s", "nothing to cut");
  expect_refused(kCutting + " --socket s --mode fast", "--mode");
  expect_refused(kCutting + " --socket s --for-s 0", "--for-s");
  expect_refused(kCutting + " --socket none/s", "the socket cannot be made");
  expect_refused("run --program examples/programs/circle-r10.mpf", "--machine");
}

TEST(Run, RefusesToStartWhereDoctorFindsAnErrorAndShowsWarnings) {
  const Scratch scratch;
  std::string text = text_of_file(project_file("examples/machines/vmc-840d.toml"));
  const auto with = [&](const std::string& line, const std::string& instead) {
    std::string changed = text;
    changed.replace(changed.find(line), line.size(), instead);
    return " --machine " + scratch.file("machine.toml", changed) +
           " --program examples/programs/circle-r10.mpf --for-s 0.1 --socket s --json";
  };
  const Finished refused =
      run_line("run" + with("max_feed_percent = 120", "max_feed_percent = 90"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("[envelope] does not allow 100 % feed"));

  const Finished warned = run_line("run" + with("max_percent = 120", "max_percent = 115"));
  EXPECT_EQ(warned.code, 0) << warned.err;
  EXPECT_THAT(warned.err,
              HasSubstr("steadyrest: warning: [override.feed] has steps above its max_percent"));
  const auto answer = nlohmann::json::parse(warned.out);
  EXPECT_TRUE(std::ranges::any_of(answer["findings"], [](const auto& finding) {
    return finding["severity"] == "warning" && finding["check"] == "override_max";
  }));
}

TEST(Run, ASecondLayerIsRefusedBeforeItRecords) {
  LiveLayer layer;
  EXPECT_EQ(run_line(kCutting + " --for-s 1 --record " + layer.at("second")).code, 2);
  EXPECT_NE(::access(layer.at("second").c_str(), F_OK), 0);
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
