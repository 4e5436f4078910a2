// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <steadyrest/apps/live_page/test/page_desk.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/reloader.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::file::testing::text_of_file;
using steadyrest::live::Successor;
using test::PageDesk;
using testing::Contains;
using testing::HasSubstr;

class MachineOnPage : public testing::Test {
 protected:
  MachineOnPage() { desk.log_in(); }
  PageDesk desk;

  std::string apply(const std::string& changes) {
    const Json checked =
        desk.json("POST", "/api/v1/machine/check", R"({"changes":)" + changes + "}");
    return Json{{"changes", Json::parse(changes)}, {"sha256_before", checked["sha256_before"]}}
        .dump();
  }
};

TEST_F(MachineOnPage, IsShownWithItsKeys) {
  const Json machine = desk.json("GET", "/api/v1/machine")["machine"];
  EXPECT_EQ(machine["name"], "VMC with SINUMERIK 840D");
  for (const Json& section : machine["sections"]) {
    for (const Json& key : section["keys"]) {
      EXPECT_FALSE(key["explanation"].get<std::string>().empty()) << key;
      if (key["key"] == "contour.limit_um") {
        EXPECT_EQ(key["value"], 10);
        EXPECT_EQ(key["unit"], "µm");
        EXPECT_FALSE(key["default"]);
      }
      if (key["key"] == "contour.strategy") {
        EXPECT_EQ(key["range"], "contour_priority | feed_priority | combined");
      }
      if (key["key"] == "contour.weight_feed") {
        EXPECT_EQ(key["value"], 0.75);
        EXPECT_TRUE(key["default"]);
      }
    }
  }
}

TEST_F(MachineOnPage, AChangeIsShownBeforeItIsMade) {
  const std::string before = text_of_file(desk.desk().machine_file);
  const Json checked =
      desk.json("POST", "/api/v1/machine/check",
                R"({"changes":{"contour.limit_um":12,"contour.strategy":"combined"}})");
  EXPECT_THAT(checked["diff"], HasSubstr("-limit_um = 10\n"));
  EXPECT_THAT(checked["diff"], HasSubstr("+limit_um = 12\n"));
  EXPECT_THAT(checked["diff"], HasSubstr("+strategy = \"combined\"\n"));
  EXPECT_TRUE(checked["fits_running"]);
  EXPECT_EQ(text_of_file(desk.desk().machine_file), before);
}

TEST_F(MachineOnPage, AWrongChangeIsRefusedByName) {
  const auto refused = [this](const std::string& changes) {
    const Json checked =
        desk.json("POST", "/api/v1/machine/check", R"({"changes":)" + changes + "}");
    EXPECT_FALSE(checked["fits_running"]) << changes;
    return checked["refusals"].dump() + checked["why_not"].dump();
  };
  EXPECT_THAT(refused(R"({"contour.limit_um":-1})"), HasSubstr("limit_um"));
  EXPECT_THAT(refused(R"({"contour.limit_mm":1})"), HasSubstr("limit_mm"));
  EXPECT_THAT(refused(R"({"contour.limit_um":"x\ny = 1"})"), HasSubstr("limit_um"));
  EXPECT_THAT(refused(R"({"limit_um":1})"), HasSubstr("names no key"));
  EXPECT_THAT(refused(R"({"control.servo_period_ms":1})"), HasSubstr("differs"));
}

TEST_F(MachineOnPage, IsAppliedByTheRunningLoop) {
  steadyrest::live::Reloader reloader(
      desk.loop(),
      {.running = desk.desk().machine,
       .make = [this](const auto& running) -> kernel::outcome::Result<std::unique_ptr<Successor>> {
         auto machine = passport::read(desk.desk().machine_file).value();
         const auto kept = supervisor::kept(running, machine);
         auto layer = supervisor::Supervisor::make(machine, {}).value();
         return std::make_unique<Successor>(
             Successor{.machine = std::move(machine), .layer = std::move(layer), .kept = kept});
       }});
  desk.desk().asked.reloader = &reloader;
  std::atomic<bool> applied{false};
  std::thread cycles([this, &applied] {
    while (!applied.load()) {
      desk.loop().run();
    }
  });
  const auto got = desk.ask("POST", "/api/v1/machine/apply", apply(R"({"contour.limit_um":12})"));
  applied.store(true);
  cycles.join();
  desk.desk().asked.reloader = nullptr;
  ASSERT_EQ(got.status, 200U) << got.body;
  EXPECT_EQ(Json::parse(got.body)["reload"]["outcome"], "taken");
  EXPECT_THAT(text_of_file(desk.desk().machine_file), HasSubstr("limit_um = 12\n"));
  EXPECT_THAT(desk.notes, Contains(HasSubstr("page: local (engineer) applied the machine file")));
}

TEST_F(MachineOnPage, IsPutBackWhereTheLayerDoesNotTakeIt) {
  steadyrest::live::Reloader reloader(
      desk.loop(),
      {.running = desk.desk().machine,
       .make = [](const auto& /*running*/) -> kernel::outcome::Result<std::unique_ptr<Successor>> {
         return kernel::outcome::refuse("the port does not like it", "leave it");
       }});
  desk.desk().asked.reloader = &reloader;
  const std::string before = text_of_file(desk.desk().machine_file);
  const auto got = desk.ask("POST", "/api/v1/machine/apply", apply(R"({"contour.limit_um":12})"));
  desk.desk().asked.reloader = nullptr;
  EXPECT_EQ(got.status, 422U);
  EXPECT_THAT(got.body, HasSubstr("the port does not like it"));
  EXPECT_EQ(text_of_file(desk.desk().machine_file), before);
}

TEST_F(MachineOnPage, WhatIsNoFileAnyMoreKeepsNobodyWaiting) {
  std::filesystem::remove(desk.desk().machine_file);
  ASSERT_EQ(::mkfifo(desk.desk().machine_file.c_str(), 0600), 0);
  EXPECT_EQ(desk.ask("GET", "/api/v1/machine").status, 500U);
  EXPECT_EQ(desk.ask("POST", "/api/v1/machine/check", R"({"changes":{}})").status, 500U);
}

TEST_F(MachineOnPage, AFileThatHasChangedMeanwhileStays) {
  steadyrest::live::Reloader reloader(desk.loop(), {.running = desk.desk().machine, .make = {}});
  desk.desk().asked.reloader = &reloader;
  const std::string asked = apply(R"({"contour.limit_um":12})");
  std::ofstream(desk.desk().machine_file, std::ios::app) << "# by hand\n";
  const std::string before = text_of_file(desk.desk().machine_file);
  EXPECT_EQ(desk.ask("POST", "/api/v1/machine/apply", asked).status, 409U);
  desk.desk().asked.reloader = nullptr;
  EXPECT_EQ(text_of_file(desk.desk().machine_file), before);
}

}  // namespace
}  // namespace steadyrest::apps::live_page
