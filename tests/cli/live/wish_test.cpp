// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <string>

#include "expectations.hpp"
#include "live/live_layer.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/live/control_socket.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using ::testing::EndsWith;
using ::testing::HasSubstr;

const std::string kContour = "[contour]\nstrategy = \"feed_priority\"\nlimit_um = 10\n";
const std::string kModulates = "[chatter]\nenabled = true\nm_code_on = 0\nm_code_off = 0\n";

/// A layer whose file does not modulate at first.
struct Modulating {
  [[nodiscard]] json ask(const json& request) const {
    const auto answer = live::ask(layer.at("steadyrest.sock"), request.dump(), 60.0);
    return answer ? json::parse(*answer) : json{{"error", {{"what", answer.error().what}}}};
  }
  [[nodiscard]] json modulate(const std::string& law) const {
    return ask({{"version", 1},
                {"ask", "modulate"},
                {"author", "night shift"},
                {"law", law},
                {"amplitude_ratio", 0.1 / 3.0},
                {"period_s", 1.5},
                {"mean_ratio", 0.9}});
  }
  /// The status once the file is this one.
  json reload(const std::string& limit_um, const std::string& chatter) {
    layer.change(kContour, chatter + "[contour]\nstrategy = \"feed_priority\"\nlimit_um = " +
                               limit_um + "\n");
    layer.process().send(SIGHUP);
    json status = LiveLayer::after_reload(++reloads);
    EXPECT_EQ(status["reload"]["outcome"], "taken") << status["reload"]["words"];
    // The cycle after it has the rooms' figures.
    const auto cycles = status["cycles"].get<std::uint64_t>();
    EXPECT_TRUE(LiveLayer::until([&] {
      status = LiveLayer::status();
      return status["cycles"].get<std::uint64_t>() > cycles + 2;
    }));
    return status;
  }
  LiveLayer layer{"act", {"--record", "runs"}};
  int reloads = 0;
};

TEST(Wish, AModulationIsInTheRecordOutlivesAReloadAndIsDecidedAgain) {
  Modulating run;
  EXPECT_THAT(run.modulate("sine")["error"]["what"].get<std::string>(),
              HasSubstr("the chatter room is off"));
  EXPECT_EQ(run.reload("11", kModulates)["modulation"]["law"], "triangle");
  EXPECT_EQ(run.modulate("sine")["modulation"]["law"], "sine");
  EXPECT_EQ(
      run.reload("12", kModulates + "feed_per_tooth_max_percent = 130\n")["modulation"]["law"],
      "sine")
      << "the file's own modulation is the same";
  EXPECT_EQ(run.reload("12", kModulates + "law = \"square\"\n")["modulation"]["law"], "square");
  EXPECT_EQ(run.modulate("pulse")["modulation"]["law"], "pulse");
  const auto cycles = LiveLayer::status()["cycles"].get<std::uint64_t>();
  EXPECT_TRUE(LiveLayer::until(
      [&] { return LiveLayer::status()["cycles"].get<std::uint64_t>() > cycles + 100; }));
  run.layer.process().send(SIGTERM);
  EXPECT_EQ(run.layer.process().wait(), 0) << run.layer.process().err();

  const json list = answer_of("record list " + run.layer.at("runs"));
  const auto record = std::ranges::find_if(
      list["records"], [](const json& one) { return one["rotates"].get<bool>(); });
  ASSERT_NE(record, list["records"].end());
  const std::string file = (*record)["file"];
  const json again = answer_of("record replay " + file);
  EXPECT_EQ(again["reloads"], 3);
  EXPECT_EQ(again["wishes"], 2);
  EXPECT_EQ(again["cycles"], (*record)["samples"]);
  EXPECT_TRUE(again["first_difference"].is_null()) << again["first_difference"];
  EXPECT_THAT(run_line("record show " + file).out,
              HasSubstr("wish: socket: night shift set the modulation: sine, ±3.333 %"));
  const json shown = answer_of("record show " + file);
  const auto wish =
      std::ranges::find_if(shown["events"], [](const json& one) { return one["kind"] == "wish"; });
  ASSERT_NE(wish, shown["events"].end());
  EXPECT_THAT((*wish)["text"].get<std::string>(), EndsWith("1.5 0.9 1 taken socket: night shift"));
}

}  // namespace
}  // namespace steadyrest::test
