// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "expectations.hpp"
#include "live/live_layer.hpp"
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/live/control_socket.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kLimit = "limit_um = 10\n";

TEST(Reload, ASignalPutsTheNewFileInForceAndARefusedOneChangesNothing) {
  LiveLayer layer("act");
  EXPECT_TRUE(LiveLayer::status()["reload"].is_null());
  layer.change(kLimit, "limit_um = 20\n");
  layer.process().send(SIGHUP);
  json status = LiveLayer::after_reload(1);
  EXPECT_EQ(status["reload"]["outcome"], "taken");
  EXPECT_EQ(status["contour_limit_um"], 20.0);
  EXPECT_EQ(status["mode_wanted"], "act") << "the mode is not the file's any more";

  layer.change(kLimit, "limit_um = -1\n");
  layer.process().send(SIGHUP);
  status = LiveLayer::after_reload(2);
  EXPECT_EQ(status["reload"]["outcome"], "refused");
  EXPECT_THAT(status["reload"]["words"].get<std::string>(), HasSubstr("limit_um = -1"));

  layer.change("servo_period_ms = 2", "servo_period_ms = 1");
  layer.process().send(SIGHUP);
  status = LiveLayer::after_reload(3);
  EXPECT_EQ(status["reload"]["outcome"], "refused");
  EXPECT_THAT(status["reload"]["words"].get<std::string>(),
              HasSubstr("servo_period_ms differs from the running layer's"));

  // What doctor calls an error.
  layer.change("max_feed_percent = 120", "max_feed_percent = 90");
  layer.process().send(SIGHUP);
  status = LiveLayer::after_reload(4);
  EXPECT_EQ(status["reload"]["outcome"], "refused");
  EXPECT_THAT(status["reload"]["words"].get<std::string>(), HasSubstr("100 % feed"));
  EXPECT_EQ(status["contour_limit_um"], 20.0);

  layer.process().send(SIGTERM);
  EXPECT_EQ(layer.process().wait(), 0);
  EXPECT_THAT(layer.process().err(), HasSubstr("read again and is in force"));
  EXPECT_THAT(layer.process().err(), HasSubstr("not taken: "));
}

TEST(Reload, IsAskedForOverTheSocket) {
  LiveLayer layer;
  layer.change(kLimit, "limit_um = 20\n");
  const auto answer =
      live::ask(layer.at("steadyrest.sock"), R"({"version":1,"ask":"reload"})", 60.0);
  ASSERT_TRUE(answer.has_value()) << answer.error().what;
  EXPECT_EQ(json::parse(*answer)["reload_asked"], 1);
  EXPECT_EQ(LiveLayer::after_reload(1)["contour_limit_um"], 20.0);
  EXPECT_THAT(run_line("status").out, HasSubstr("machine file read again 20"));
}

TEST(Reload, IsInTheRecordAndDecidedAgain) {
  LiveLayer layer("act", {"--record", "runs"});
  layer.change(kLimit, "limit_um = 3\n");
  layer.process().send(SIGHUP);
  const json status = LiveLayer::after_reload(1);
  EXPECT_EQ(status["reload"]["outcome"], "taken") << status["reload"]["words"];
  const auto cycles = status["cycles"].get<std::uint64_t>();
  EXPECT_TRUE(LiveLayer::until(
      [&] { return LiveLayer::status()["cycles"].get<std::uint64_t>() > cycles + 100; }));
  layer.process().send(SIGTERM);
  EXPECT_EQ(layer.process().wait(), 0) << layer.process().err();

  const json list = answer_of("record list " + layer.at("runs"));
  const auto run = std::ranges::find_if(
      list["records"], [](const json& record) { return record["rotates"].get<bool>(); });
  ASSERT_NE(run, list["records"].end());
  const std::string file = (*run)["file"];
  const json again = answer_of("record replay " + file);
  EXPECT_EQ(again["reloads"], 1);
  EXPECT_GT(again["cycles"], cycles);
  EXPECT_TRUE(again["first_difference"].is_null()) << again["first_difference"];
  EXPECT_EQ(again["cycles"], (*run)["samples"]);
  // By the first file alone it decides otherwise, from the reload on or not at all.
  EXPECT_EQ(answer_of("record replay " + file + " --machine " +
                      project_file("examples/machines/vmc-840d.toml"))["reloads"],
            1);
  const json shown = answer_of("record show " + file);
  EXPECT_TRUE(std::ranges::any_of(shown["events"], [](const json& event) {
    return event["kind"] == "reload" &&
           event["text"].get<std::string>().find("limit_um = 3") != std::string::npos;
  }));
}

/// A layer with its own terminal; returns its process.
pid_t on_terminal(int master, const std::string& socket) {
  const std::string machine = project_file("examples/machines/vmc-840d.toml");
  const std::string program = project_file("examples/programs/rib-pocket.mpf");
  const std::string terminal = ::ptsname(master);
  const pid_t child = ::fork();
  if (child == 0) {
    ::setsid();
    const int slave = ::open(terminal.c_str(), O_RDWR);  // becomes the session's terminal
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(slave, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(slave, STDERR_FILENO);  // so that it has the thread that draws progress
    ::close(slave);
    ::close(master);
    ::execl(STEADYREST_PROGRAM, "steadyrest", "run", "--machine", machine.c_str(), "--program",
            program.c_str(), "--socket", socket.c_str(), nullptr);
    ::_exit(127);
  }
  return child;
}

TEST(Reload, ATerminalThatHasGoneEndsTheRun) {
  const Scratch scratch;
  const std::string socket = scratch.at("s");
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_EQ(::grantpt(master), 0);
  ASSERT_EQ(::unlockpt(master), 0);
  const pid_t layer = on_terminal(master, socket);
  EXPECT_TRUE(LiveLayer::until([&] { return ::access(socket.c_str(), F_OK) == 0; }));
  ::kill(layer, SIGHUP);  // with its terminal there it is a reload
  EXPECT_TRUE(LiveLayer::until([&] { return LiveLayer::status(socket)["reload"].is_object(); }));
  ::close(master);
  int status = 0;
  EXPECT_EQ(::waitpid(layer, &status, 0), layer);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace steadyrest::test
