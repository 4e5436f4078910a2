// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/stream.hpp>
#include <steadyrest/apps/live_page/test/page_desk.hpp>

namespace steadyrest::apps::live_page {
namespace {

using test::PageDesk;
using testing::ElementsAre;
using testing::HasSubstr;
using web::Role;

const std::string kModulation = "/api/v1/modulation";
const std::string kMeasured = "/api/v1/thermal/measured";
const std::string kSine =
    R"({"law":"sine","amplitude_ratio":0.07,"period_s":1.5,"mean_ratio":0.93})";

/// All rooms are on, and the loop runs in its own thread.
class WishDesk : public testing::Test {
 protected:
  WishDesk() {
    web::Accounts accounts;
    for (const auto& [name, role] :
         {std::pair("vera", Role::viewer), {"otto", Role::operating}, {"anna", Role::engineer}}) {
      EXPECT_TRUE(accounts.set_user(name, "secret of " + std::string(name), role));
    }
    EXPECT_TRUE(accounts.write(file));
  }
  ~WishDesk() override { stop(); }
  void stop() {
    desk.loop().ask_stop();
    if (thread.joinable()) {
      thread.join();
    }
  }
  void log_in(const std::string& name) {
    desk.log_in(Json{{"name", name}, {"password", "secret of " + name}}.dump());
  }
  Json hello() { return Json::parse(StreamText(desk.desk()).hello()); }
  /// The words of a refusal.
  std::string refused(const std::string& path, const std::string& body, unsigned status = 422) {
    const auto got = desk.ask("POST", path, body);
    EXPECT_EQ(got.status, status) << got.body;
    const Json json = Json::parse(got.body);
    return json.contains("error") ? json["error"]["what"].get<std::string>() : "";
  }
  void two_cycles() {
    const std::uint64_t beats = desk.loop().beats();
    while (desk.loop().beats() < beats + 2) {
      std::this_thread::yield();
    }
  }

  kernel::file::testing::OwnFolder folder;
  std::string file = folder.at("users.json");
  PageDesk desk{file, PageDesk::Of::rooms};
  std::thread thread{[this] { desk.loop().run(); }};
};

TEST_F(WishDesk, AnOperatorSetsTheModulationAtOnceAndTheFileStays) {
  two_cycles();
  EXPECT_EQ(hello()["modulation"]["law"], "triangle") << "the machine file's";
  log_in("otto");
  const auto got = desk.ask("POST", kModulation, kSine);
  EXPECT_EQ(got.status, 200U) << got.body;
  EXPECT_EQ(Json::parse(got.body)["modulation"], Json::parse(kSine));
  two_cycles();
  EXPECT_EQ(hello()["modulation"], Json::parse(kSine)) << "what is in force";
  EXPECT_EQ(desk.json("GET", "/api/v1/status")["status"]["modulation"], Json::parse(kSine));
  stop();
  EXPECT_THAT(desk.wishes,
              ElementsAre("modulate sine 0.07 0 1.5 0.93 1 taken page: otto (operator)"));
}

TEST_F(WishDesk, AnOperatorEntersAMeasuredSize) {
  EXPECT_EQ(hello()["measures"], true);
  log_in("otto");
  const auto enter = [&](const char* um) {
    return desk.json("POST", kMeasured,
                     std::string(R"({"axis":"Z","sd_um":1,"displacement_um":)") + um + "}");
  };
  EXPECT_EQ(enter("0.5")["verdict"]["taken"], true);
  const Json outlier = enter("5000")["verdict"];
  EXPECT_EQ(outlier["taken"], false);
  EXPECT_EQ(outlier["reason"], "thermal_reading_outlier");
  EXPECT_THAT(outlier["sentence"].get<std::string>(), HasSubstr("rejected"));
  const Json kept = desk.json("GET", "/api/v1/thermal")["thermal"]["readings"];
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0]["axis"], "Z");
  EXPECT_EQ(kept[0]["displacement_um"], 0.5);
  EXPECT_EQ(kept[0]["taken"], true);
  EXPECT_EQ(kept[1]["reason"], "thermal_reading_outlier");
  EXPECT_EQ(kept[1]["author"], "otto (operator)");
  stop();
  EXPECT_THAT(desk.wishes, ElementsAre("measure 2 Z 5e-04 0.001 taken page: otto (operator)",
                                       "measure 2 Z 5 0.001 rejected page: otto (operator)"));
}

TEST_F(WishDesk, InActNothingIsSetWithoutAConfirmation) {
  log_in("otto");
  desk.loop().ask_mode(kernel::machine::Mode::act);
  two_cycles();
  EXPECT_THAT(refused(kModulation, kSine), HasSubstr("in mode act"));
  EXPECT_THAT(refused(kMeasured, R"({"axis":"Z","displacement_um":0.5,"sd_um":1})"),
              HasSubstr("in mode act"));
  Json sine = Json::parse(kSine);
  sine["confirm"] = true;
  EXPECT_EQ(desk.ask("POST", kModulation, sine.dump()).status, 200U);
  stop();
  EXPECT_THAT(desk.wishes,
              ElementsAre("modulate sine 0.07 0 1.5 0.93 1 taken page: otto (operator)"));
}

TEST_F(WishDesk, SaysThatSizesWhichDoNotFitHaveSwitchedTheCorrectionOff) {
  log_in("otto");
  const auto shown = [this] {
    two_cycles();
    StreamText stream(desk.desk());
    const Json streamed = Json::parse("{" + stream.frame())["thermal"];
    const Json answered = desk.json("GET", "/api/v1/thermal")["thermal"];
    for (const char* const key : {"switched_off", "reason", "sentence"}) {
      EXPECT_EQ(streamed[key], answered[key]) << key;
    }
    return streamed;
  };
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(shown()["switched_off"], false) << i;
    EXPECT_EQ(shown()["reason"], nullptr);
    const std::string size = R"({"axis":"Z","sd_um":1,"displacement_um":5000})";
    EXPECT_EQ(desk.json("POST", kMeasured, size)["verdict"]["taken"], false);
  }
  EXPECT_EQ(shown()["switched_off"], true);
  EXPECT_EQ(shown()["reason"], "thermal_model_unfit");
  EXPECT_THAT(shown()["sentence"].get<std::string>(), HasSubstr("no longer fit"));
}

TEST_F(WishDesk, AViewerMayNeither) {
  log_in("vera");
  EXPECT_THAT(refused(kModulation, kSine, 403), HasSubstr("this takes the role operator"));
  EXPECT_THAT(refused(kMeasured, "{}", 403), HasSubstr("this takes the role operator"));
  stop();
  EXPECT_THAT(desk.wishes, ElementsAre());
}

TEST_F(WishDesk, RefusesWhatIsNoWish) {
  log_in("otto");
  for (const std::string& path : {kModulation, kMeasured}) {
    for (const std::string& body :
         {std::string("[]"), std::string("null"), std::string("{\"law\":NaN}"),
          std::string(R"({"axis":"Z","displacement_um":1e999,"sd_um":1})"),
          std::string(R"({"law":"sine","amplitude_ratio":1e999,"period_s":2,"mean_ratio":1})"),
          std::string(60000, '['), std::string("\xff\xfe")}) {
      EXPECT_THAT(refused(path, body, 400), HasSubstr("the body is not a JSON object"));
    }
  }
  EXPECT_THAT(refused(kModulation, "{}"), HasSubstr("allowed: constant, square"));
  EXPECT_THAT(
      refused(kModulation, R"({"law":"sine","amplitude_ratio":2,"period_s":2,"mean_ratio":1})"),
      HasSubstr("`amplitude_ratio` 2 is out of range; allowed: 0 … 0.9"));
  EXPECT_LT(refused(kModulation, R"({"law":")" + std::string(60000, 'x') + "\"}").size(), 300U);
  for (const char* const axis : {"X", "A", "", "Z "}) {
    EXPECT_THAT(
        refused(kMeasured, Json{{"axis", axis}, {"displacement_um", 1}, {"sd_um", 1}}.dump()),
        HasSubstr("has no thermal model; allowed: Z"));
  }
  EXPECT_THAT(refused(kMeasured, R"({"axis":"Z","displacement_um":20000,"sd_um":1})"),
              HasSubstr("allowed: -10000 … 10000"));
  stop();
  EXPECT_THAT(desk.wishes, ElementsAre()) << "none of them reached the cycle";
  EXPECT_THAT(refused(kModulation, kSine), HasSubstr("the loop does not cycle"));
}

TEST(WishDeskWithoutRooms, SaysThatTheyAreOff) {
  PageDesk desk;
  desk.log_in();
  const auto got = desk.ask("POST", kModulation, kSine);
  EXPECT_EQ(got.status, 422U);
  EXPECT_THAT(got.body, HasSubstr("the chatter room is off in the machine file"));
  EXPECT_THAT(desk.ask("POST", kMeasured, "{}").body,
              HasSubstr("the thermal room is off in the machine file"));
  const Json hello = Json::parse(StreamText(desk.desk()).hello());
  EXPECT_TRUE(hello["modulation"].is_null());
  EXPECT_EQ(hello["measures"], false);
}

}  // namespace
}  // namespace steadyrest::apps::live_page
