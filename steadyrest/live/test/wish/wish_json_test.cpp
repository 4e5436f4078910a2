// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/live/test/wish/rooms_desk.hpp>
#include <steadyrest/live/wish/wish_json.hpp>

namespace steadyrest::live {
namespace {

using ::testing::HasSubstr;

const kernel::machine::Machine& machine() {
  static const auto kMachine = test::RoomsDesk().machine;
  return kMachine;
}

std::string refused_modulation(const std::string& keys, const auto& of) {
  const auto wish = modulation_wish(Json::parse(keys), of, "otto");
  return wish ? "" : kernel::outcome::text(wish.error());
}
std::string refused_modulation(const std::string& keys) {
  return refused_modulation(keys, machine());
}
std::string refused_reading(const std::string& keys) {
  const auto wish = measured_wish(Json::parse(keys), machine(), "otto");
  return wish ? "" : kernel::outcome::text(wish.error());
}

TEST(WishJson, TakesAModulationWithTheFilesSeed) {
  auto seeded = machine();
  seeded.chatter.seed = 77;
  seeded.chatter.amplitude_rev_s = 3.0;
  const Json keys =
      Json::parse(R"({"law":"random","amplitude_ratio":0.25,"period_s":0.02,"mean_ratio":2})");
  const auto wish = modulation_wish(keys, seeded, "otto").value();
  const auto& modulation = std::get<chatter::online::Modulation>(wish.what);
  EXPECT_EQ(modulation_json(modulation), keys);
  EXPECT_EQ(modulation.seed, 77U);
  EXPECT_EQ(modulation.amplitude_rev_s, 0.0) << "the ratio counts";
  EXPECT_EQ(wish.author.view(), "otto");
}

TEST(WishJson, NamesWhatIsWrongWithAModulation) {
  EXPECT_THAT(refused_modulation("{}"), HasSubstr("allowed: constant, square, pulse, triangle"));
  EXPECT_THAT(refused_modulation(R"({"law":7})"), HasSubstr("the law 7 is not known"));
  EXPECT_THAT(refused_modulation(R"({"law":")" + std::string(5000, 'x') + "\"}"),
              ::testing::AllOf(HasSubstr("xxx…"), ::testing::SizeIs(::testing::Lt(300U))));
  EXPECT_THAT(refused_modulation(R"({"law":"sine","period_s":2,"mean_ratio":1})"),
              HasSubstr("`amplitude_ratio` is missing; allowed: 0 … 0.9"));
  EXPECT_THAT(
      refused_modulation(R"({"law":"sine","amplitude_ratio":"0.1","period_s":2,"mean_ratio":1})"),
      HasSubstr("is no number"));
  EXPECT_THAT(
      refused_modulation(R"({"law":"sine","amplitude_ratio":null,"period_s":2,"mean_ratio":1})"),
      HasSubstr("null is no number"));
  EXPECT_THAT(
      refused_modulation(R"({"law":"sine","amplitude_ratio":0.91,"period_s":2,"mean_ratio":1})"),
      HasSubstr("`amplitude_ratio` 0.91 is out of range; allowed: 0 … 0.9"));
  EXPECT_THAT(
      refused_modulation(R"({"law":"sine","amplitude_ratio":0.1,"period_s":1e308,"mean_ratio":1})"),
      HasSubstr("`period_s` 1e+308 is out of range; allowed: 0.02 … 600"));
  EXPECT_THAT(
      refused_modulation(R"({"law":"sine","amplitude_ratio":0.1,"period_s":2,"mean_ratio":-1})"),
      HasSubstr("`mean_ratio` -1 is out of range; allowed: 0.1 … 2"));
  auto off = machine();
  off.chatter.enabled = false;
  EXPECT_THAT(refused_modulation("{}", off), HasSubstr("the chatter room is off"));
}

TEST(WishJson, NamesWhatIsWrongWithAReading) {
  EXPECT_THAT(refused_reading("{}"), HasSubstr("the axis null has no thermal model; allowed: Z"));
  EXPECT_THAT(refused_reading(R"({"axis":"X","displacement_um":1,"sd_um":1})"),
              HasSubstr("the axis \"X\" has no thermal model; allowed: Z"));
  EXPECT_THAT(refused_reading(R"({"axis":["Z"],"displacement_um":1,"sd_um":1})"),
              HasSubstr("has no thermal model"));
  EXPECT_THAT(refused_reading(R"({"axis":"Z","displacement_um":1e5,"sd_um":1})"),
              HasSubstr("`displacement_um` 100000.0 is out of range; allowed: -10000 … 10000"));
  EXPECT_THAT(refused_reading(R"({"axis":"Z","displacement_um":1,"sd_um":-1})"),
              HasSubstr("`sd_um` -1 is out of range; allowed: 0 … 1000"));
  EXPECT_THAT(refused_reading(R"({"axis":"Z","displacement_um":1})"), HasSubstr("is missing"));
  auto off = machine();
  off.thermal.enabled = false;
  EXPECT_FALSE(measured_wish(Json::object(), off, ""));
}

TEST(WishJson, TakesAReadingInMillimetres) {
  const auto wish =
      measured_wish(Json::parse(R"({"axis":"Z","displacement_um":-4.5,"sd_um":0})"), machine(), "x")
          .value();
  const auto& measured = std::get<supervisor::Measured>(wish.what);
  EXPECT_EQ(measured.axis, 2U);
  EXPECT_EQ(measured.name.view(), "Z");
  EXPECT_DOUBLE_EQ(measured.displacement_mm, -0.0045);
  EXPECT_EQ(measured.sd_mm, 0.0);
}

TEST(WishJson, AnAuthorIsOneLine) {
  const Json keys = Json::parse(R"({"axis":"Z","displacement_um":0,"sd_um":1})");
  const auto wish = measured_wish(keys, machine(), "a\nb\x1b[2J" + std::string(5000, 'x')).value();
  EXPECT_EQ(wish.author.view().substr(0, 7), "a?b?[2J");
  EXPECT_EQ(wish.author.size, 64U);
}

/// The socket's side, with a loop that runs in its own thread.
class SocketWish : public ::testing::Test {
 protected:
  SocketWish() : thread([this] { loop.run(); }) {}
  ~SocketWish() override { stop(); }
  void stop() {
    loop.ask_stop();
    if (thread.joinable()) {
      thread.join();
    }
  }
  Json ask(const std::string& line) {
    return Json::parse(answer({.loop = loop, .port = "sim", .reloader = &reloader}, line));
  }
  test::RoomsDesk desk;
  std::string author;
  Loop loop{*desk.port, *desk.layer, desk.pace,
            Loop::Config{.period_s = 0.004, .on_wish = [this](const auto& wish, auto) {
                           author = wish.author.view();
                         }}};
  Reloader reloader{
      loop,
      {.running = desk.machine,
       .make = [](const auto&) -> kernel::outcome::Result<std::unique_ptr<Successor>> {
         return kernel::outcome::refuse("no", "yes");
       }}};
  std::thread thread;
};

TEST_F(SocketWish, SetsTheModulation) {
  const Json got = ask(R"({"version":1,"ask":"modulate","author":"night shift","law":"square",)"
                       R"("amplitude_ratio":0.05,"period_s":3,"mean_ratio":0.9})");
  EXPECT_EQ(got["modulation"]["law"], "square") << got;
  const std::uint64_t beats = loop.beats();
  while (loop.beats() < beats + 2) {
    std::this_thread::yield();
  }
  EXPECT_EQ(ask(R"({"version":1,"ask":"status"})")["status"]["modulation"], got["modulation"]);
  stop();
  EXPECT_EQ(author, "socket: night shift");
}

TEST_F(SocketWish, EntersAReading) {
  const std::string of = R"({"version":1,"ask":"measured","axis":"Z","sd_um":1,"displacement_um":)";
  EXPECT_EQ(ask(of + "0.5}")["verdict"]["reason"], "thermal_reading_taken");
  const Json outlier = ask(of + "5000}")["verdict"];
  EXPECT_EQ(outlier["taken"], false);
  EXPECT_EQ(outlier["reason"], "thermal_reading_outlier");
  EXPECT_THAT(outlier["sentence"].get<std::string>(), HasSubstr("rejected"));
  EXPECT_THAT(ask(of + "1e999}")["error"]["what"].get<std::string>(), HasSubstr("no JSON object"));
  EXPECT_THAT(ask(of + "NaN}")["error"]["what"].get<std::string>(), HasSubstr("no JSON object"));
  stop();
  EXPECT_EQ(author, "socket");
  EXPECT_THAT(ask(of + "0.5}")["error"]["what"].get<std::string>(),
              HasSubstr("the loop does not cycle: nothing was changed"));
}

}  // namespace
}  // namespace steadyrest::live
