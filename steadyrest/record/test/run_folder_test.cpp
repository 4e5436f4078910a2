// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include <steadyrest/record/run_folder.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

void put(const std::string& file, std::size_t bytes) {
  std::ofstream(file) << std::string(bytes, 'x');
}

std::vector<std::string> names(const std::string& folder) {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    all.push_back(entry.path().filename().string());
  }
  return all;
}

TEST(RunFolder, ARunIsNamedByItsStart) {
  EXPECT_EQ(run_name("2026-11-26T12:49:34Z"), "run-20261126T124934Z.sqlite");
  EXPECT_THAT(run_name(utc_now()), testing::MatchesRegex("run-........T......Z.sqlite"));
}

// A layer that is killed and started again at once.
TEST(RunFolder, ASecondRunInASecondHasANumberAndIsLater) {
  EXPECT_EQ(run_name("2026-11-26T12:49:34Z", 2), "run-20261126T124934Z-2.sqlite");
  const test::Folder folder;
  for (const char* name : {"run-20260101T000000Z-2.sqlite", "run-20260101T000000Z.sqlite",
                           "run-20260101T000000Z-.sqlite", "run-20260101T000000Z-x.sqlite"}) {
    put(folder.file(name), 10);
  }
  const auto files = run_files(folder.path()).value();
  ASSERT_EQ(files.size(), 4U);
  EXPECT_EQ(files[0].file, folder.file("run-20260101T000000Z.sqlite"));
  const auto rotates = std::ranges::count(files, true, &RunFile::rotates);
  EXPECT_EQ(rotates, 2);
  rotate(folder.file("run-20260101T000000Z-2.sqlite"), 1);
  EXPECT_FALSE(std::filesystem::exists(folder.file("run-20260101T000000Z.sqlite")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("run-20260101T000000Z-2.sqlite")));
}

TEST(RunFolder, ARecordIsWrittenToWhileItOrItsLogChanges) {
  const test::Folder folder;
  const std::string file = folder.file("a.sqlite");
  EXPECT_FALSE(written_lately(file)) << "there is none";
  put(file, 1);
  EXPECT_TRUE(written_lately(file));
  const auto shift = [&](int seconds) {
    std::filesystem::last_write_time(
        file, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(seconds));
  };
  shift(-60);
  EXPECT_FALSE(written_lately(file));
  shift(60);
  EXPECT_FALSE(written_lately(file)) << "the clock was set back since";
  put(file + "-wal", 1);
  EXPECT_TRUE(written_lately(file));
}

TEST(RunFolder, ListsRecordsByName) {
  const test::Folder folder;
  put(folder.file("run-20260102T000000Z.sqlite"), 10);
  put(folder.file("run-20260101T000000Z.sqlite"), 20);
  put(folder.file("run-20260101T000000Z.sqlite-wal"), 5);
  put(folder.file("kept.sqlite"), 1);
  put(folder.file("part.csv"), 1);
  const auto files = run_files(folder.path()).value();
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].file, folder.file("kept.sqlite"));
  EXPECT_FALSE(files[0].rotates);
  EXPECT_EQ(files[1].bytes, 25U);
  EXPECT_TRUE(files[1].rotates);
  EXPECT_FALSE(run_files(folder.file("none")));
}

TEST(RunFolder, RotationRemovesTheOldestRunsAlone) {
  const test::Folder folder;
  put(folder.file("kept.sqlite"), 100);
  put(folder.file("run-1.sqlite"), 100);
  put(folder.file("run-20260101T000000Z.sqlite"), 100);
  put(folder.file("run-20260101T000000Z.sqlite-wal"), 100);
  put(folder.file("run-20260102T000000Z.sqlite"), 100);
  put(folder.file("run-20260103T000000Z.sqlite"), 100);
  rotate(folder.file("run-20260103T000000Z.sqlite"), 400);
  EXPECT_THAT(names(folder.path()), testing::UnorderedElementsAre("kept.sqlite", "run-1.sqlite",
                                                                  "run-20260102T000000Z.sqlite",
                                                                  "run-20260103T000000Z.sqlite"));
  rotate(folder.file("run-20260103T000000Z.sqlite"), 1);
  EXPECT_THAT(names(folder.path()), testing::UnorderedElementsAre("kept.sqlite", "run-1.sqlite",
                                                                  "run-20260103T000000Z.sqlite"));
}

TEST(RunFolder, ANewRunMakesRoomForItself) {
  const test::Folder folder;
  put(folder.file("run-20260101T000000Z.sqlite"), 1'000'000);
  const auto writer = RecordWriter::make(
      {.file = folder.file("run-20260102T000000Z.sqlite"), .max_bytes = 900'000});
  ASSERT_TRUE(writer);
  EXPECT_FALSE(std::filesystem::exists(folder.file("run-20260101T000000Z.sqlite")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("run-20260102T000000Z.sqlite")));
}

}  // namespace
}  // namespace steadyrest::record
