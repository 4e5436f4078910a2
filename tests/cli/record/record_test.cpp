// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <steadyrest/kernel/outcome/reason.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;

const std::string kRecord = project_file("examples/records/circle-start.sqlite");
constexpr int kCycles = 7200;
constexpr int kLeadIn = 10;  ///< line of circle-r10.mpf

/// The record's own machine file with another line.
std::string own_machine_with(const Scratch& scratch, const std::string& line,
                             const std::string& instead) {
  std::string text = text_of_file(project_file("examples/machines/ideal-k50.toml"));
  const std::size_t at = text.find(line);
  EXPECT_NE(at, std::string::npos);
  text.replace(at, line.size(), instead);
  return scratch.file("machine.toml", text);
}

TEST(RecordList, ShowsTheRunsOfAFolder) {
  const json answer = answer_of("record list " + project_file("examples/records"));
  ASSERT_EQ(answer["records"].size(), 1U);
  const json& record = answer["records"][0];
  EXPECT_EQ(record["file"], kRecord);
  EXPECT_EQ(record["start_utc"], "2026-11-26T08:00:00Z");
  EXPECT_EQ(record["program"], "circle-r10.mpf");
  EXPECT_EQ(record["samples"], kCycles);
  EXPECT_EQ(record["dropped"], 0);
  EXPECT_TRUE(record["closed"]);
}

TEST(RecordList, AFileThatIsNoRecordDoesNotHideTheOthers) {
  const Scratch scratch;
  scratch.file("a.sqlite", "not a record");
  scratch.file("b.sqlite", text_of_file(kRecord));
  const Finished finished = run({"record", "list", scratch.at("")});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, testing::HasSubstr("b.sqlite"));
  EXPECT_THAT(finished.err, testing::HasSubstr("a.sqlite: is no record of a run"));
}

TEST(RecordShow, CountsEachReason) {
  const json answer = answer_of("record show " + kRecord);
  int cycles = 0;
  for (const json& count : answer["feed_reasons"]) {
    cycles += count.get<int>();
  }
  EXPECT_EQ(cycles, kCycles);
  EXPECT_EQ(answer["cycle_ms"], 1.0);
  EXPECT_GT(answer["feed_reasons"]["contour_within_limit"], 0);
  ASSERT_EQ(answer["events"].size(), 1U);
  EXPECT_EQ(answer["events"][0]["kind"], "mode");
  EXPECT_EQ(answer["events"][0]["text"], "act");
}

#if STEADYREST_HAS_HDF5
// The library's own test reads it back (record/hdf5).
TEST(RecordExport, WritesHdf5ByTheEndingOrTheFormat) {
  const Scratch scratch;
  const std::string head = "\x89HDF\r\n\x1a\n";
  for (const std::string& line :
       {scratch.at("a.h5"), scratch.at("b.hdf5"), scratch.at("c.data") + " --format hdf5"}) {
    EXPECT_EQ(answer_of("record export " + kRecord + " -o " + line)["samples"], kCycles);
    EXPECT_EQ(text_of_file(line.substr(0, line.find(' '))).substr(0, head.size()), head);
  }
  EXPECT_EQ(answer_of("record export " + kRecord + " -o " + scratch.at("a.h5"))["samples"], kCycles)
      << "an older one is replaced";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 3)
      << "and nothing is left beside them";
  scratch.file("d.h5", "of somebody else");
  expect_refused("record export " + kRecord + " -o " + scratch.at("d.h5"));
}
#endif

TEST(RecordExport, RefusesHdf5OnStdout) {
  expect_refused("record export " + kRecord + " --format hdf5", "no text for stdout");
  expect_refused("record export " + kRecord + " --format xls", "--format");
}

TEST(RecordExport, WritesARowForEachCycle) {
  const Finished finished = run({"record", "export", kRecord});
  EXPECT_EQ(finished.code, 0);
  std::istringstream lines(finished.out);
  std::string line;
  std::getline(lines, line);
  const auto commas = std::ranges::count(line, ',');
  int rows = 0;
  std::string last;
  while (std::getline(lines, line)) {
    ++rows;
    ASSERT_EQ(std::ranges::count(line, ','), commas);
    last = line;
  }
  EXPECT_EQ(rows, kCycles);
  EXPECT_THAT(last, testing::StartsWith("7199,1,0,7.2"));
}

/// A table's rows by the names of its columns.
struct Table {
  std::map<std::string, std::size_t> column;
  std::vector<std::vector<std::string>> rows;

  explicit Table(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    for (const std::string& name : cells(line)) {
      column.emplace(name, column.size());
    }
    while (std::getline(lines, line)) {
      rows.push_back(cells(line));
    }
  }
  static std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> out;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) {
      out.push_back(cell);
    }
    return out;
  }
  [[nodiscard]] const std::string& text(std::size_t row, const std::string& name) const {
    return rows.at(row).at(column.at(name));
  }
  [[nodiscard]] double number(std::size_t row, const std::string& name) const {
    return std::stod(text(row, name));
  }
};

// The record ends on the line that leads up to the circle, X10 from Y-12: there the contour error
// is the distance from it, left of the direction of travel positive.
TEST(RecordExport, HasTheContourErrorAndTheNamesOfReasons) {
  const Table table(run({"record", "export", kRecord}).out);
  ASSERT_EQ(table.rows.size(), std::size_t{kCycles});
  int on_line = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double x = table.number(row, "axis.actual_mm.0");
    const double y = table.number(row, "axis.actual_mm.1");
    if (table.number(row, "program_line") == kLeadIn && y > -11.0) {
      EXPECT_NEAR(table.number(row, "contour_error_mm"), 10.0 - x, 1e-9);
      ++on_line;
    }
    EXPECT_EQ(table.text(row, "command.feed_reason_name"),
              kernel::outcome::name(kernel::outcome::Reason{
                  static_cast<std::uint16_t>(table.number(row, "command.feed_reason"))}));
  }
  EXPECT_GT(on_line, 100);
}

TEST(RecordReplay, ComparesEveryCycle) {
  const Scratch scratch;
  const std::string other = own_machine_with(scratch, "limit_um = 10", "limit_um = 20");
  const json answer = answer_of("record replay " + kRecord + " --machine " + other);
  EXPECT_EQ(answer["cycles"], kCycles);
  const json& first = answer["first_difference"];
  ASSERT_TRUE(first.is_object());
  EXPECT_GT(first["cycle"], 5000);
  EXPECT_GE(first["decided"]["feed_percent"], first["recorded"]["feed_percent"]);
  EXPECT_THAT(first["fields"].dump(), testing::HasSubstr("command.feed"));
}

// The record's own decisions were made by an older layer, so they may differ; a record of today's
// layer is compared bit for bit in trial/replay.
TEST(RecordReplay, TakesTheMachineFromTheRecord) {
  const json own = answer_of("record replay " + kRecord);
  const json given = answer_of("record replay " + kRecord + " --machine " +
                               project_file("examples/machines/ideal-k50.toml"));
  EXPECT_EQ(own, given);
  EXPECT_EQ(own["cycles"], kCycles);
  EXPECT_TRUE(own.contains("first_difference"));
  EXPECT_TRUE(own["gap_after"].is_null());
}

TEST(Record, RefusesWhatIsNoRecord) {
  const std::string machine = project_file("examples/machines/ideal-k50.toml");
  for (const char* const verb : {"record show ", "record export ", "record replay "}) {
    expect_refused(verb + machine, "is no record of a run");
    expect_refused(std::string(verb) + "none.sqlite", "no such file");
  }
  expect_refused("record list none", "is no folder");
}

}  // namespace
}  // namespace steadyrest::test
