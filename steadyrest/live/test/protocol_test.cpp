// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/live/status_json.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::live {
namespace {

using kernel::machine::Mode;
using ::testing::HasSubstr;

/// A layer that has observed for 500 cycles: it is in the circle.
class Protocol : public ::testing::Test {
 protected:
  Protocol() { loop.run(); }
  [[nodiscard]] Json ask(const std::string& line) {
    return Json::parse(answer({.loop = loop, .port = "sim"}, line));
  }
  test::Desk desk;
  Loop loop{*desk.port,
            *desk.layer,
            desk.pace,
            {.period_s = 0.004, .contour_limit_mm = 0.01, .most_cycles = 200}};
};

TEST_F(Protocol, TellsTheStatus) {
  const Json status = ask(R"({"version":1,"ask":"status"})")["status"];
  EXPECT_EQ(status["mode"], "observe");
  EXPECT_EQ(status["port"], "sim");
  EXPECT_EQ(status["cycles"], 200);
  EXPECT_EQ(status["cutting"], true);
  EXPECT_NEAR(status["contour_error_um"].get<double>(), 88.0, 3.0);
  EXPECT_DOUBLE_EQ(status["contour_limit_um"].get<double>(), 10.0);
  EXPECT_DOUBLE_EQ(status["feed_percent"].get<double>(), 100.0);
  EXPECT_EQ(status["reasons"].size(), 4U);
  EXPECT_TRUE(status["port_fault"].is_null());
}

TEST(StatusJson, TellsTheLineItsOrderAndMode) {
  LiveStatus status;
  EXPECT_TRUE(status_json(status)["chatter"].is_null());
  LiveChatter& chatter = status.chatter;
  chatter.listens = true;
  const Json quiet = status_json(status)["chatter"];
  EXPECT_TRUE(quiet["line"].is_null());
  EXPECT_TRUE(quiet["nearest_mode"].is_null());
  EXPECT_TRUE(quiet["confidence"].is_null());
  EXPECT_TRUE(quiet["spindle_rpm"].is_null());
  EXPECT_TRUE(quiet["spindle_sd_rpm"].is_null());
  EXPECT_EQ(quiet["clips"], false);
  chatter.chatters = true;
  chatter.line = {
      .order = 15.0, .folded = true, .frequency_hz = 1234.0, .off_hz = -3.5, .sd_hz = 0.5};
  chatter.mode_hz = 1230.0;
  chatter.confidence = 0.97;
  chatter.speed_rev_s = 50.0;
  chatter.speed_sd = 2e-4;
  const Json heard = status_json(status)["chatter"];
  EXPECT_EQ(heard["line"], Json::parse(R"({"frequency_hz":1234.0,"nearest_order":15,
      "order_folded":true,"from_order_hz":-3.5,"from_order_sd_hz":0.5,"forced":false})"));
  EXPECT_EQ(heard["nearest_mode"], Json::parse(R"({"frequency_hz":1230.0,"off_hz":4.0})"));
  EXPECT_EQ(heard["confidence"], 0.97);
  EXPECT_DOUBLE_EQ(heard["spindle_rpm"].get<double>(), 3000.0);
  EXPECT_DOUBLE_EQ(heard["spindle_sd_rpm"].get<double>(), 0.6);
  chatter.chatters = false;
  chatter.forced = true;
  chatter.line.order = 0.0;
  const Json forced = status_json(status)["chatter"];
  EXPECT_EQ(forced["line"]["forced"], true);
  EXPECT_TRUE(forced["line"]["nearest_order"].is_null());
  EXPECT_TRUE(forced["confidence"].is_null());
}

TEST_F(Protocol, TakesAMode) {
  EXPECT_EQ(ask(R"({"version":1,"ask":"mode","mode":"act"})")["mode_wanted"], "act");
}

TEST_F(Protocol, TakesAReloadWhereTheFileCanBeReadAgain) {
  const std::string reload = R"({"version":1,"ask":"reload"})";
  EXPECT_TRUE(ask(reload).contains("error"));
  Reloader reloader(
      loop, {.running = desk.machine,
             .make = [](const auto&) -> kernel::outcome::Result<std::unique_ptr<Successor>> {
               return kernel::outcome::refuse("no", "yes");
             }});
  const Asked of{.loop = loop, .port = "sim", .reloader = &reloader};
  const Json status = Json::parse(answer(of, R"({"version":1,"ask":"status"})"))["status"];
  EXPECT_TRUE(status["reload"].is_null());
  EXPECT_EQ(Json::parse(answer(of, reload))["reload_asked"], 1);
  EXPECT_EQ(Json::parse(answer(of, reload))["reload_asked"], 2);
  const Json done = reload_json({.number = 2, .utc = "t", .taken = false, .words = "no; yes"});
  EXPECT_EQ(done["outcome"], "refused");
  EXPECT_EQ(done["words"], "no; yes");
  EXPECT_EQ(done["number"], 2);
}

TEST_F(Protocol, RefusesWhatItDoesNotSpeak) {
  const auto what = [&](const std::string& line) {
    return ask(line)["error"]["what"].get<std::string>();
  };
  EXPECT_THAT(what("nonsense"), HasSubstr("no JSON object"));
  EXPECT_THAT(what("[1]"), HasSubstr("no JSON object"));
  EXPECT_THAT(what(R"({"ask":"status"})"),
              HasSubstr("version null is not spoken here; allowed: 1"));
  EXPECT_THAT(what(R"({"version":2,"ask":"status"})"), HasSubstr("version 2"));
  EXPECT_THAT(what(R"({"version":1,"ask":"stop"})"), HasSubstr("allowed: status, mode"));
  EXPECT_THAT(what(R"({"version":1,"ask":"mode","mode":"fast"})"),
              HasSubstr("allowed: observe, advise, act"));
  EXPECT_THAT(what(R"({"version":1,"ask":"mode","mode":["act"]})"), HasSubstr("not known"));
}

TEST_F(Protocol, AnswersAnyBytesWithOneObject) {
  for (const std::string& line :
       {std::string("\xff\xfe{\"version\":1}"), std::string(4000, '['),
        std::string("{\"version\":"),
        std::string(R"({"version":1,"ask":")") + std::string(3000, 'x') + "\"}",
        std::string(R"({"version":1,"ask":"\ud800"})")}) {
    const std::string text = answer({.loop = loop, .port = "sim"}, line);
    EXPECT_TRUE(Json::parse(text).contains("error")) << line.substr(0, 30);
    EXPECT_LT(text.size(), 400U);
    EXPECT_EQ(text.find('\n'), std::string::npos);
  }
}

/// A link that is lost with these words.
class LostPort final : public kernel::port::Port {
 public:
  [[nodiscard]] kernel::port::Capability capability() const noexcept override { return {}; }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override {
    return std::unexpected(kernel::outcome::Refusal{
        .kind = kernel::outcome::Kind::unavailable, .file = {}, .what = words, .to_do = {}});
  }
  kernel::outcome::Result<void> write(const kernel::signal::Command&) noexcept override {
    return {};
  }
  std::string words;
};

// The words are cut to the status's room, here within a character of three bytes.
TEST(ProtocolOfALostPort, TellsItsWordsAsUtf8) {
  test::Desk desk;
  LostPort port;
  port.words = "a";
  for (int i = 0; i < 100; ++i) {
    port.words += "…";
  }
  Loop loop(port, *desk.layer, desk.pace, {.period_s = 0.004, .most_cycles = 3});
  loop.run();
  const Json status = Json::parse(
      answer({.loop = loop, .port = "sim"}, R"({"version":1,"ask":"status"})"))["status"];
  EXPECT_THAT(status["port_fault"].get<std::string>(), ::testing::StartsWith("a……"));
}

TEST(StatusJson, KnowsItsModes) {
  for (const Mode mode : {Mode::observe, Mode::advise, Mode::act}) {
    EXPECT_EQ(mode_of(word(mode)), mode);
  }
  EXPECT_FALSE(mode_of("Act"));
}

}  // namespace
}  // namespace steadyrest::live
