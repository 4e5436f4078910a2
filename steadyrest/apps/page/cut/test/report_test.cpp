// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/apps/page/cut/test/sample.hpp>
#include <steadyrest/apps/page/shared/write_files.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::apps::page {
namespace {

using trial::cut::ReportData;

namespace fs = std::filesystem;
using kernel::file::testing::text_of_file;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Report : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }

  kernel::file::testing::OwnFolder folder_;
};

std::string text(const ReportData& data) {
  return text_of(to_page(data));
}

auto write(std::size_t points, const fs::path& folder) {
  const std::string json = text(sample_report(points));
  return write_files(to_html(json), json, folder);
}

/// What the browser will parse: the text between the element's tags.
std::string data_element(const std::string& html) {
  const std::string open = R"(id="report-data" type="application/json">)";
  const std::size_t begin = html.find(open) + open.size();
  return html.substr(begin, html.find("</script>", begin) - begin);
}

// One value of each part of the report, compared as parsed JSON.
TEST_F(Report, JsonSaysWhatTheDataSay) {
  const ReportData data = sample_report(50);
  const auto json = nlohmann::json::parse(text(data));
  EXPECT_EQ(json["schema"], "steadyrest-report/1");
  EXPECT_EQ(json["program"], data.program);
  EXPECT_EQ(json["limit_um"], 10.0);
  EXPECT_EQ(json["without"]["figures"]["contour_error_max_mm"], 0.0877);
  EXPECT_EQ(json["with"]["figures"]["samples"], 50);
  EXPECT_EQ(json["with"]["reasons"][0]["reason"], "contour_within_limit");
  EXPECT_EQ(json["worst_lines"][0]["with_um"], 9.5);
  EXPECT_EQ(json["worst_lines"][0]["feed_with_mm_min"], 1320.0);
  EXPECT_EQ(json["worst_lines"][0]["hold_feed_mm_min"], 1354.2);
  EXPECT_EQ(json["worst_lines"][0]["held_by"], "closed form");
  EXPECT_EQ(json["override_table"][2]["code"], 3);
  EXPECT_EQ(json["motion"][0]["axis"], "X");
  EXPECT_EQ(json["motion"][0]["velocity_rms_mm_s"], 0.0031);
  EXPECT_EQ(json["motion"][0]["difference_acceleration_rms_mm_s2"], 707.0);
  EXPECT_EQ(json["motion"][0]["velocity_coverage_ratio"], 1.0);
  EXPECT_TRUE(json["motion"][0]["acceleration_coverage_ratio"].is_null()) << "no bound";
  EXPECT_EQ(json["probes"][0]["innovation_um"], 2.94);
  EXPECT_EQ(json["probes"][0]["reason"], "thermal_reading_taken");
  EXPECT_EQ(json["ways"][1]["way"], "feed_override");
  EXPECT_EQ(json["ways"][1]["contour_error_max_mm"], data.with.figures.contour_error_max_mm);
  EXPECT_EQ(json["curve"][1]["limit_um"], 50.0);
  EXPECT_EQ(json["curve"][1]["samples_over_limit"], data.without.figures.samples_over_limit);
  EXPECT_FALSE(json.contains("against"));
}

// The names are public.
TEST_F(Report, EveryWayHasItsName) {
  using trial::cut::Way;
  const std::pair<Way, const char*> names[] = {
      {Way::alone, "alone"},
      {Way::feed_override, "feed_override"},
      {Way::path_offsets, "path_offsets"},
      {Way::changed, "changed"},
      {Way::changed_feed_override, "changed_feed_override"},
      {Way::changed_path_offsets, "changed_path_offsets"}};
  ReportData data = sample_report(1);
  data.against = "original.mpf";
  data.ways.clear();
  for (const auto& [way, name] : names) {
    data.ways.push_back({.way = way, .figures = {}});
  }
  const auto json = nlohmann::json::parse(text(data));
  EXPECT_EQ(json["against"], "original.mpf");
  for (std::size_t i = 0; i < data.ways.size(); ++i) {
    EXPECT_EQ(json["ways"][i]["way"], names[i].second);
  }
}

// The page draws column against column; a short one would shift everything behind it.
TEST_F(Report, ColumnsOfATraceAreEquallyLong) {
  const auto json = nlohmann::json::parse(text(sample_report(37)));
  for (const char* run : {"without", "with"}) {
    ASSERT_EQ(json[run]["trace"].size(), 11U);
    for (const auto& column : json[run]["trace"]) {
      EXPECT_EQ(column.size(), 37U);
    }
  }
}

// Byte for byte: archives and tests compare reports by hash.
TEST_F(Report, TheSameDataGiveTheSameBytes) {
  EXPECT_EQ(to_html(text(sample_report(50))), to_html(text(sample_report(50))));
}

// JSON has no NaN; a parser would stop at it.
TEST_F(Report, ValuesThatAreNotFiniteBecomeNull) {
  ReportData data = sample_report(2);
  data.with.trace[1].contour_error_um = std::numeric_limits<double>::quiet_NaN();
  data.worst_lines[0].with_um = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(text(data));
  EXPECT_TRUE(json["with"]["trace"]["contour_error_um"][1].is_null());
  EXPECT_TRUE(json["worst_lines"][0]["with_um"].is_null());
}

// ä in Latin-1, as old programs have it, is no UTF-8.
TEST_F(Report, BytesThatAreNotUtf8AreReplaced) {
  ReportData data = sample_report(1);
  data.worst_lines[0].text = "( fr\xE4sen )";
  const auto json = nlohmann::json::parse(text(data));
  EXPECT_EQ(json["worst_lines"][0]["text"], "( fr\xEF\xBF\xBDsen )");
}

// No `<` at all in the data: then no text can end the element, whatever it says.
TEST_F(Report, NoTextLeavesTheScriptElement) {
  const std::string html = to_html(text(sample_report(3)));
  EXPECT_THAT(html, StartsWith("<!doctype html>"));
  EXPECT_THAT(html, EndsWith("</html>\n"));
  EXPECT_THAT(data_element(html), Not(HasSubstr("<")));
  EXPECT_EQ(nlohmann::json::parse(data_element(html)),
            nlohmann::json::parse(text(sample_report(3))));
}

// From disk, without a network: no script and no style from elsewhere.
TEST_F(Report, ThePageNeedsNothingFromOutside) {
  const std::string html = to_html("{}");
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
  EXPECT_THAT(html, Not(HasSubstr("<link rel=\"stylesheet\"")));
  EXPECT_THAT(html, Not(HasSubstr("@STEADYREST_REPORT_DATA@")));
}

// The folder is made, two files appear, and no temporary stays behind.
TEST_F(Report, WritesBothFilesAndLeavesNothingElse) {
  const auto written = write(20, at("a") / "b");
  ASSERT_TRUE(written.has_value());
  EXPECT_EQ(text_of_file(written->json), text(sample_report(20)) + "\n");
  EXPECT_EQ(text_of_file(written->html), to_html(text(sample_report(20))));
  const auto count = std::distance(fs::directory_iterator(at("a") / "b"), fs::directory_iterator{});
  EXPECT_EQ(count, 2);
}

TEST_F(Report, ReplacesAnOlderReport) {
  ASSERT_TRUE(write(20, folder_.path()).has_value());
  ASSERT_TRUE(write(3, folder_.path()).has_value());
  EXPECT_EQ(text_of_file(at("report.json")), text(sample_report(3)) + "\n");
}

// A file where the folder should be, at the end and in the middle of the path.
TEST_F(Report, RefusesAFileInPlaceOfTheDirectory) {
  std::ofstream(at("taken")) << "x";
  for (const fs::path& directory : {at("taken"), at("taken") / "below"}) {
    const auto written = write(2, directory);
    ASSERT_FALSE(written.has_value());
    EXPECT_EQ(written.error().kind, kernel::outcome::Kind::bad_input);
    EXPECT_EQ(written.error().file, directory.string());
    EXPECT_THAT(kernel::outcome::text(written.error()), HasSubstr("--report"));
  }
}

// A folder in the place of report.json: the rename fails, and report.html must not be left alone.
TEST_F(Report, RefusesWhenAFileCannotBeReplacedAndLeavesNoPart) {
  fs::create_directories(at("report.json") / "in-the-way");
  const auto written = write(2, folder_.path());
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator{}), 1);
}

}  // namespace
}  // namespace steadyrest::apps::page
