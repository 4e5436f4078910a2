// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <gmock/gmock.h>

#include <steadyrest/record/database.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

/// A record of two samples, changed by SQL.
std::string record(const test::Folder& folder) {
  const std::string file = folder.file("a.sqlite");
  test::Random random(6);
  const auto writer = test::quiet_writer(file);
  const std::vector<kernel::signal::PathSegment> path(3);
  test::add(*writer, test::any_sample(random), path);
  test::add(*writer, test::any_sample(random), path);
  return file;
}

/// The first refusal when all of it is read; empty if there is none.
std::string refusal(const std::string& file) {
  auto reader = RecordReader::open(file);
  if (!reader) {
    return kernel::outcome::text(reader.error());
  }
  Sample sample;
  for (;;) {
    const auto more = reader->next(sample);
    if (!more) {
      return kernel::outcome::text(more.error());
    }
    if (!*more) {
      return "";
    }
  }
}

void change(const std::string& file, const std::string& sql) {
  const std::string command = "PRAGMA ignore_check_constraints = 1; " + sql;
  auto database = Database::open_to_change(file);
  ASSERT_TRUE(database);
  ASSERT_TRUE(database->run(command.c_str()));
}

TEST(RefusedRecord, WholeOnesAreNot) {
  const test::Folder folder;
  EXPECT_EQ(refusal(record(folder)), "");
}

TEST(RefusedRecord, WhatIsNoRecordSaysSo) {
  const test::Folder folder;
  EXPECT_THAT(refusal(folder.file("none.sqlite")), testing::HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder.path()), testing::HasSubstr("is not a file"));
  std::ofstream(folder.file("text.sqlite")) << std::string(5000, 'x');
  EXPECT_THAT(refusal(folder.file("text.sqlite")), testing::HasSubstr("is no record of a run"));
  std::ofstream(folder.file("empty.sqlite")).flush();
  EXPECT_THAT(refusal(folder.file("empty.sqlite")), testing::HasSubstr("holds nothing"));
}

// As layers of older versions left it when they were killed as they started.
TEST(RefusedRecord, OneThatWasOnlyBegunHoldsNothing) {
  const std::string clear = "DELETE FROM run; DELETE FROM chunk; DELETE FROM chunk_column; ";
  for (const std::string& left :
       {clear, clear + "DROP TABLE event", clear + "DROP TABLE chunk; DROP TABLE event",
        std::string("DROP TABLE run; DROP TABLE totals; DROP TABLE chunk; DROP TABLE "
                    "chunk_column; DROP TABLE path; DROP TABLE path_part; DROP TABLE event")}) {
    const test::Folder folder;
    const std::string file = record(folder);
    change(file, left);
    EXPECT_THAT(refusal(file), testing::HasSubstr("holds nothing")) << left;
  }
}

TEST(RefusedRecord, ADatabaseOfAnotherProgram) {
  const test::Folder folder;
  const std::string file = record(folder);
  change(file, "PRAGMA application_id = 7");
  EXPECT_THAT(refusal(file), testing::HasSubstr("is no record of a run"));
}

TEST(RefusedRecord, AnotherFormatNamesBoth) {
  const test::Folder folder;
  const std::string file = record(folder);
  for (const std::string format : {"1", "6"}) {
    change(file, "PRAGMA user_version = " + format);
    EXPECT_THAT(refusal(file),
                testing::HasSubstr("has format " + format + "; this program reads formats 2 to 5"));
  }
}

// A real one of the oldest format has its path, and no original.
TEST(RefusedRecord, TheFormatsBeforeAreNot) {
  const test::Folder folder;
  const std::string file = record(folder);
  // None had an original, nor the three columns of it that a segment has.
  change(file,
         "DELETE FROM path_part; DELETE FROM path; DELETE FROM chunk_column WHERE name IN "
         "('original', 'original_unknown', 'heat_in_text')");
  change(file, "PRAGMA user_version = 4");
  EXPECT_EQ(refusal(file), "");
  change(file, "ALTER TABLE run DROP COLUMN listener");
  for (const std::string format : {"2", "3"}) {
    change(file, "PRAGMA user_version = " + format);
    EXPECT_EQ(refusal(file), "");
    EXPECT_EQ(RecordReader::open(file).value().run().listener, "");
  }
  const std::string oldest = STEADYREST_SOURCE_DIR "/examples/records/circle-start.sqlite";
  EXPECT_EQ(refusal(oldest), "");
  auto reader = RecordReader::open(oldest).value();
  Sample sample;
  ASSERT_TRUE(reader.next(sample).value());
  EXPECT_EQ(sample.frame.path.size(), 5U);
  EXPECT_TRUE(sample.frame.original.empty());
}

TEST(RefusedRecord, DamageNamesThePlace) {
  const std::pair<const char*, const char*> cases[] = {
      {"UPDATE chunk_column SET data = x'00' WHERE name = 'cycle'", "column cycle of chunk 1"},
      {"DELETE FROM chunk_column WHERE name = 'motion'", "a column of chunk 1 is missing"},
      {"DELETE FROM chunk_column WHERE name = 'vibration'", "a column of chunk 1 is missing"},
      {"UPDATE chunk_column SET name = 'other' WHERE name = 'time_s'", "column other of chunk 1"},
      {"UPDATE chunk_column SET data = (SELECT data FROM chunk_column WHERE name = 'time_s') "
       "WHERE name = 'motion'",
       "impossible value"},
      {"UPDATE chunk SET samples = 0", "chunk 1 has no samples"},
      {"UPDATE chunk SET samples = 3", "of chunk 1"},
      {"UPDATE chunk SET samples = 1000000000000", "chunk 1"},
      {"UPDATE path_part SET data = x''", "path 1"},
      {"UPDATE path_part SET first = 1", "path 1"},
      {"DELETE FROM path_part", "path 1"},
      {"DELETE FROM run", "does not say what was recorded"},
      {"INSERT INTO event VALUES (1, 0, 0, 99, '')", "an event of an unknown kind"},
      {"DROP TABLE event", "no such table"},
  };
  for (const auto& [sql, says] : cases) {
    const test::Folder folder;
    const std::string file = record(folder);
    change(file, sql);
    EXPECT_THAT(refusal(file), testing::HasSubstr(says)) << sql;
  }
}

// A copy that broke off anywhere is refused or whole, and never brings the reader down.
TEST(RefusedRecord, AFileThatIsCutOff) {
  const test::Folder folder;
  const std::string file = record(folder);
  const auto whole = std::filesystem::file_size(file);
  for (std::uintmax_t bytes = whole - 1000; bytes > 4096; bytes -= 3000) {
    std::filesystem::resize_file(file, bytes);
    EXPECT_NE(refusal(file), "") << bytes;
  }
}

TEST(FullDisk, IsSaidWithWhatHelps) {
  const test::Folder folder;
  auto database = Database::create(folder.file("full.sqlite")).value();
  ASSERT_TRUE(database.run("PRAGMA max_page_count = 2; CREATE TABLE t (x)"));
  const auto full = database.run("INSERT INTO t VALUES (zeroblob(100000))");
  ASSERT_FALSE(full.has_value());
  EXPECT_EQ(full.error().what, "the disk is full");
  EXPECT_EQ(full.error().to_do, "free space, or name a folder on another disk with --record");
}

}  // namespace
}  // namespace steadyrest::record
