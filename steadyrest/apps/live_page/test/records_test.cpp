// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/test/page_desk.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/record/record_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/record_writer.hpp>

namespace steadyrest::apps::live_page {
namespace {

using test::PageDesk;
using testing::HasSubstr;
using testing::SizeIs;

class RecordsOnPage : public testing::Test {
 protected:
  RecordsOnPage() {
    desk.desk().records = STEADYREST_SOURCE_DIR "/examples/records";
    desk.log_in();
  }
  PageDesk desk;
};

TEST_F(RecordsOnPage, AreListedAndSearched) {
  const auto found = [this](const std::string& words) {
    auto request = PageDesk::request("GET", "/api/v1/records");
    request.query["search"] = words;
    return Json::parse(desk.ask(request).body)["records"];
  };
  EXPECT_THAT(found(""), SizeIs(1));
  EXPECT_THAT(found("CIRCLE"), SizeIs(1));
  EXPECT_THAT(found("nothing like it"), SizeIs(0));
  EXPECT_EQ(found("")[0]["name"], "circle-start.sqlite");
}

TEST_F(RecordsOnPage, AreShownWithTheirEventsAndCourse) {
  const Json record = desk.json("GET", "/api/v1/records/circle-start.sqlite")["record"];
  EXPECT_GT(record["totals"]["samples"], 100);
  EXPECT_EQ(record["events"][0]["kind"], "mode");
  auto request = PageDesk::request("GET", "/api/v1/records/circle-start.sqlite/data");
  request.query["points"] = "20";
  const Json course = Json::parse(desk.ask(request).body);
  ASSERT_EQ(course["t_s"].size(), 20U);
  const Json& speed = course["columns"]["path_speed_mm_min"];
  EXPECT_EQ(speed["max"].size(), 20U);
  double most = 0.0;
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_LE(speed["min"][i].get<double>(), speed["max"][i].get<double>());
    most = std::max(most, speed["max"][i].get<double>());
  }
  EXPECT_GT(most, 1000.0);
}

// Told apart from one that another run is just beginning by the time alone.
TEST_F(RecordsOnPage, AreListedWhereTheyCannotBeRead) {
  const kernel::file::testing::OwnFolder folder;
  desk.desk().records = folder.path();
  const std::string whole = STEADYREST_SOURCE_DIR "/examples/records/circle-start.sqlite";
  std::filesystem::copy_file(whole, folder.at("a-whole.sqlite"));
  std::filesystem::copy_file(whole, folder.at("b-cut.sqlite"));
  std::filesystem::resize_file(folder.at("b-cut.sqlite"), 20'000);
  std::ofstream(folder.at("c-text.sqlite")) << std::string(5000, 'x');
  std::ofstream(folder.at("d-begun.sqlite")) << "";
  for (const std::string name : {"a-whole.sqlite", "b-cut.sqlite", "c-text.sqlite"}) {
    std::filesystem::last_write_time(
        folder.at(name), std::filesystem::file_time_type::clock::now() - std::chrono::minutes(1));
  }
  const Json list = desk.json("GET", "/api/v1/records")["records"];
  ASSERT_THAT(list, SizeIs(3));
  EXPECT_EQ(
      list[0],
      (Json{{"name", "c-text.sqlite"}, {"bytes", 5000}, {"damaged", "is no record of a run"}}));
  EXPECT_EQ(list[1]["name"], "b-cut.sqlite");
  EXPECT_THAT(list[1]["damaged"].get<std::string>(), HasSubstr("is damaged"));
  EXPECT_FALSE(list[2].contains("damaged"));
  auto request = PageDesk::request("GET", "/api/v1/records");
  request.query["search"] = "B-CUT";
  EXPECT_THAT(Json::parse(desk.ask(request).body)["records"], SizeIs(1));
}

TEST_F(RecordsOnPage, AreNotAnEmptyListWhereTheirFolderIsGone) {
  desk.desk().records = "/none";
  EXPECT_EQ(desk.ask("GET", "/api/v1/records").status, 422U);
}

TEST_F(RecordsOnPage, HaveNoCourseOfAnOddStretch) {
  const auto status = [this](const std::vector<std::pair<std::string, std::string>>& query) {
    auto request = PageDesk::request("GET", "/api/v1/records/circle-start.sqlite/data");
    for (const auto& [key, value] : query) {
      request.query[key] = value;
    }
    const auto got = desk.ask(request);
    EXPECT_EQ(got.body.contains("allowed: "), got.status == 400) << got.body;
    return got.status;
  };
  for (const char* const key : {"from_s", "to_s", "points"}) {
    for (const char* const odd : {"nan", "inf", "-1", "", "x", "1x", " 1", "1e300", "1e999"}) {
      EXPECT_EQ(status({{key, odd}}), 400U) << key << odd;
    }
  }
  for (const char* const odd : {"0", "4001", "1.5"}) {
    EXPECT_EQ(status({{"points", odd}}), 400U) << odd;
  }
  EXPECT_EQ(status({{"from_s", "2"}, {"to_s", "1"}}), 400U);
  EXPECT_EQ(status({{"from_s", "1"}, {"to_s", "1"}}), 400U);
  EXPECT_EQ(status({{"to_s", "0"}}), 400U);
  EXPECT_EQ(status({}), 200U);
  EXPECT_EQ(status({{"from_s", "0"}, {"to_s", "0.05"}, {"points", "4000"}}), 200U);
  EXPECT_EQ(status({{"from_s", "1e-7"}, {"to_s", "1e6"}, {"points", "1"}}), 200U);
}

TEST_F(RecordsOnPage, AreDecidedAgain) {
  const Json got = desk.json("POST", "/api/v1/records/circle-start.sqlite/replay", "{}");
  EXPECT_GT(got["cycles"], 100) << got;
  EXPECT_TRUE(got["first_difference"].is_null()) << got;
}

TEST_F(RecordsOnPage, AreDownloadedWhole) {
  const Json record = desk.json("GET", "/api/v1/records/circle-start.sqlite")["record"];
  auto request = PageDesk::request("GET", "/api/v1/records/circle-start.sqlite/export");
  for (const std::string format : record["formats"]) {
    request.query["format"] = format;
    const auto got = desk.ask(request);
    EXPECT_EQ(got.status, 200U) << format << got.body;
    EXPECT_GT(std::filesystem::file_size(got.file), 10'000U) << format;
  }
  const auto itself = desk.ask("GET", "/api/v1/records/circle-start.sqlite/export");
  const auto copy = record::RecordReader::open(itself.file);
  ASSERT_TRUE(copy.has_value());
  EXPECT_EQ(copy->totals().samples, record["totals"]["samples"]);
}

// The record of a run that was killed is as open as the one that is being written.
TEST_F(RecordsOnPage, SayWhetherTheyAreBeingWritten) {
  const kernel::file::testing::OwnFolder folder;
  desk.desk().records = folder.path();
  const auto writer = record::RecordWriter::make({.file = folder.at("own.sqlite")}).value();
  writer->flush();
  ASSERT_TRUE(record::copy_record(folder.at("own.sqlite"), folder.at("killed.sqlite")));
  const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::minutes(1);
  for (const std::string name : {"own.sqlite", "own.sqlite-wal", "killed.sqlite"}) {
    std::filesystem::last_write_time(folder.at(name), long_ago);
  }
  const auto writing = [this](const std::string& name) {
    const Json record = desk.json("GET", "/api/v1/records/" + name)["record"]["totals"];
    EXPECT_EQ(record["closed"], false) << name;
    const Json all = desk.json("GET", "/api/v1/records");
    for (const Json& row : all["records"]) {
      if (row["name"] == name) {
        EXPECT_EQ(row["writing"], record["writing"]) << name;
      }
    }
    return record["writing"].get<bool>();
  };
  EXPECT_FALSE(writing("own.sqlite")) << "this run writes none";
  desk.desk().writing = [] { return "own.sqlite"; };
  EXPECT_TRUE(writing("own.sqlite"));
  EXPECT_FALSE(writing("killed.sqlite"));
  std::filesystem::last_write_time(folder.at("killed.sqlite"),
                                   std::filesystem::file_time_type::clock::now());
  EXPECT_TRUE(writing("killed.sqlite")) << "by another program";
}

TEST_F(RecordsOnPage, HaveNoOtherNames) {
  for (const std::string name :
       {"none.sqlite", "..", "../records/circle-start.sqlite", "make_circle.py", ".",
        "circle-start.sqlite/none", "/etc/passwd", "circle-start.sqlite/../circle-start.sqlite"}) {
    EXPECT_EQ(desk.ask("GET", "/api/v1/records/" + name).status, 404U) << name;
  }
}

}  // namespace
}  // namespace steadyrest::apps::live_page
