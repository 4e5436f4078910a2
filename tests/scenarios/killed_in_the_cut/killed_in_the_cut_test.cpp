// SPDX-License-Identifier: Apache-2.0
// kill -9 while the layer holds the feed down in the cut: the next one starts on the same socket,
// and the record shows the run up to its last second. What the machine does then is its watchdog's
// affair: OverrideInput.LostHeartbeatReturnsToThePanelWithoutAJump, tests/linuxcnc.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tests/cli/shared/process.hpp>
#include <tests/cli/shared/program.hpp>
#include <tests/cli/shared/scratch.hpp>
#include <unistd.h>

#include <steadyrest/record/testing/run_records.hpp>

namespace steadyrest::test {
namespace {

constexpr const char* kCircles =
    "G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=50 F4000\nM30\n";

nlohmann::json status_at(const std::string& socket) {
  const Finished answer = run_line("status --json --socket " + socket);
  return answer.code == 0 ? nlohmann::json::parse(answer.out) : nlohmann::json();
}

/// Until the layer slows the cut: that may take long on a busy computer.
bool wait_for_the_cut(const std::string& socket) {
  for (int i = 0; i < 600; ++i) {
    const auto status = status_at(socket);
    if (status.is_object() && status["cutting"] == true && status["feed_percent"] < 60.0 &&
        status["cycles"] > 600) {
      return true;
    }
    ::usleep(50'000);
  }
  return false;
}

TEST(KilledInTheCut, TheNextLayerStartsAndTheRecordIsWhole) {
  const Scratch scratch;
  const std::string socket = scratch.at("s");
  const std::vector<std::string> arguments{"run",
                                           "--machine",
                                           project_file("examples/machines/vmc-840d.toml"),
                                           "--program",
                                           scratch.file("circles.mpf", kCircles),
                                           "--mode",
                                           "act",
                                           "--socket",
                                           socket,
                                           "--record",
                                           scratch.at("runs")};
  {
    Process layer(arguments, scratch.at(""));
    ASSERT_TRUE(wait_for_the_cut(socket));
    layer.send(SIGKILL);
    EXPECT_EQ(layer.wait(), -SIGKILL);
  }
  EXPECT_TRUE(std::filesystem::exists(socket)) << "it could not take it along";
  EXPECT_EQ(run_line("status --socket " + socket).code, 1);
  const std::vector<std::string> records = record::testing::run_records(scratch.at("runs"));
  ASSERT_EQ(records.size(), 1U);
  const Finished shown = run_line("record show --json " + records.front());
  ASSERT_EQ(shown.code, 0) << shown.err;
  EXPECT_GT(nlohmann::json::parse(shown.out)["samples"].get<int>(), 100);
  Process next(arguments, scratch.at(""));
  EXPECT_TRUE(wait_for_the_cut(socket)) << "the next layer answers on the same socket";
}

}  // namespace
}  // namespace steadyrest::test
