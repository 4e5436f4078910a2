// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/record/keep_last.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/run_folder.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

/// Ten transactions of a sample each, a second apart; the record stays open.
std::unique_ptr<RecordWriter> ten_seconds(const test::Folder& folder) {
  auto writer = RecordWriter::make({.file = folder.file("run.sqlite"),
                                    .info = {.cycle_s = 1.0},
                                    .commit_s = 3600.0,
                                    .drain_s = 3600.0,
                                    .keep_last_s = 3.0})
                    .value();
  const std::vector<kernel::signal::PathSegment> path(2);
  for (int i = 0; i < 10; ++i) {
    Sample sample;
    sample.frame.cycle = static_cast<std::uint64_t>(100 + i);
    test::add(*writer, sample, path);
    writer->flush();
  }
  return writer;
}

std::vector<std::uint64_t> numbers(const std::string& file) {
  auto reader = RecordReader::open(file).value();
  std::vector<std::uint64_t> all;
  Sample sample;
  while (reader.next(sample).value()) {
    EXPECT_EQ(sample.frame.cycle, 100 + sample.number);
    EXPECT_EQ(sample.frame.path.size(), 2U);
    all.push_back(sample.number);
  }
  EXPECT_EQ(reader.totals().samples, all.size());
  EXPECT_TRUE(reader.totals().closed);
  return all;
}

TEST(KeepLast, CopiesTheEndOfARunThatIsBeingWritten) {
  const test::Folder folder;
  const auto writer = ten_seconds(folder);
  ASSERT_TRUE(keep_last(folder.file("run.sqlite"), folder.file("a.sqlite"), 3.0));
  EXPECT_EQ(numbers(folder.file("a.sqlite")), (std::vector<std::uint64_t>{7, 8, 9}));
  ASSERT_TRUE(keep_last(folder.file("run.sqlite"), folder.file("b.sqlite"), 2.5));
  EXPECT_EQ(numbers(folder.file("b.sqlite")), (std::vector<std::uint64_t>{7, 8, 9}));
  ASSERT_TRUE(keep_last(folder.file("run.sqlite"), folder.file("c.sqlite"), 100.0));
  EXPECT_EQ(numbers(folder.file("c.sqlite")).size(), 10U);
  EXPECT_FALSE(keep_last(folder.file("run.sqlite"), folder.file("a.sqlite"), 3.0));
}

TEST(KeepLast, AFaultLeavesAFileThatRotationDoesNotRemove) {
  const test::Folder folder;
  const auto writer = ten_seconds(folder);
  writer->keep("servo fault");
  writer->flush();
  EXPECT_FALSE(writer->failed());
  rotate(folder.file("run.sqlite"), 1);
  const auto files = run_files(folder.path()).value();
  const auto kept = std::ranges::find_if(
      files, [](const RunFile& file) { return file.file.find("/fault-") != std::string::npos; });
  ASSERT_NE(kept, files.end());
  EXPECT_FALSE(kept->rotates);
  EXPECT_EQ(numbers(kept->file), (std::vector<std::uint64_t>{7, 8, 9}));
  const auto reader = RecordReader::open(kept->file).value();
  ASSERT_EQ(reader.events().size(), 1U);
  EXPECT_EQ(reader.events()[0].text, "servo fault");
}

TEST(KeepLast, TwoFaultsInASecondAreBothKept) {
  const test::Folder folder;
  const auto writer = ten_seconds(folder);
  for (int i = 0; i < 3; ++i) {
    writer->keep("again");
    writer->flush();
  }
  const auto files = run_files(folder.path()).value();
  EXPECT_EQ(std::ranges::count_if(
                files,
                [](const RunFile& file) { return file.file.find("/fault-") != std::string::npos; }),
            3);
}

}  // namespace
}  // namespace steadyrest::record
