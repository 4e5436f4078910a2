// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

TEST(RecordWriter, AllocatesNothingInTheCycle) {
  const test::Folder folder;
  test::Random random(3);
  const Sample sample = test::any_sample(random);
  const std::vector<kernel::signal::PathSegment> path(1000);
  const auto writer = test::quiet_writer(folder.file("a.sqlite"));
  const kernel::rt::testing::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    test::add(*writer, sample, path);
    writer->event(EventKind::note, "nothing");
  }
}

TEST(RecordWriter, CountsWhatAFullRingLoses) {
  const test::Folder folder;
  {
    const auto writer = test::quiet_writer(folder.file("a.sqlite"));
    for (std::size_t i = 0; i < RecordWriter::kRing + 10; ++i) {
      test::add(*writer, {});
    }
    EXPECT_EQ(writer->dropped(), 10U);
    writer->flush();
    test::add(*writer, {});
  }
  auto reader = RecordReader::open(folder.file("a.sqlite")).value();
  EXPECT_EQ(reader.totals().dropped, 10U);
  EXPECT_EQ(reader.totals().samples, RecordWriter::kRing + 1);
  Sample sample;
  while (reader.next(sample).value()) {
  }
  EXPECT_EQ(sample.number, RecordWriter::kRing + 10);
}

TEST(RecordWriter, AFrameWithTooMuchVibrationIsCountedAsLost) {
  const test::Folder folder;
  const auto writer = test::quiet_writer(folder.file("a.sqlite"));
  const std::vector<double> readings(kMaxVibration + 1);
  kernel::signal::Frame frame;
  frame.vibration = readings;
  writer->add(frame, {});
  EXPECT_EQ(writer->dropped(), 1U);
}

TEST(RecordWriter, ARunIsReadWhileItIsWritten) {
  const test::Folder folder;
  const auto writer = test::quiet_writer(folder.file("a.sqlite"));
  test::add(*writer, {});
  writer->flush();
  auto reader = RecordReader::open(folder.file("a.sqlite")).value();
  EXPECT_FALSE(reader.totals().closed);
  Sample sample;
  EXPECT_TRUE(reader.next(sample).value());
  EXPECT_FALSE(reader.next(sample).value());
}

// SQLite goes on writing a file that has no name any more.
TEST(RecordWriter, SaysThatItsFileWasRemovedAndCountsWhatThatCosts) {
  for (const char* const removed : {"a.sqlite", "a.sqlite-wal", ""}) {
    test::Folder folder;
    int told = 0;
    const auto writer =
        RecordWriter::make({.file = folder.file("a.sqlite"),
                            .on_fault = [&told](const kernel::outcome::Refusal&) { ++told; }})
            .value();
    for (int i = 0; i < 5; ++i) {
      test::add(*writer, {});
    }
    writer->flush();
    EXPECT_EQ(writer->dropped(), 0U);
    std::filesystem::remove_all(*removed == '\0' ? folder.path() : folder.file(removed));
    test::add(*writer, {});
    writer->flush();
    test::add(*writer, {});
    ASSERT_TRUE(writer->failed()) << removed;
    EXPECT_NE(writer->fault()->what.find("removed"), std::string::npos);
    EXPECT_EQ(writer->dropped(), 7U) << removed;
    EXPECT_EQ(told, 1);
  }
}

TEST(RecordWriter, AFileThatIsMovedGoesOn) {
  const test::Folder folder;
  {
    const auto writer = test::quiet_writer(folder.file("a.sqlite"));
    test::add(*writer, {});
    writer->flush();
    std::filesystem::rename(folder.file("a.sqlite"), folder.file("b.sqlite"));
    std::filesystem::rename(folder.file("a.sqlite-wal"), folder.file("b.sqlite-wal"));
    test::add(*writer, {});
    writer->flush();
    EXPECT_FALSE(writer->failed());
  }
  EXPECT_EQ(RecordReader::open(folder.file("b.sqlite")).value().totals().samples, 2U);
}

// A layer that is killed as it starts leaves a record that opens, or none.
TEST(RecordWriter, TheFileHasItsNameOnlyOnceItSaysWhatIsRecorded) {
  const test::Folder folder;
  for (int i = 0; i < 40; ++i) {
    const std::string file = folder.file(std::to_string(i) + ".sqlite");
    const pid_t child = fork();
    if (child == 0) {
      const auto writer = RecordWriter::make({.file = file});
      pause();
      _exit(1);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500 * i));
    kill(child, SIGKILL);
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    if (std::filesystem::exists(file)) {
      const auto opened = RecordReader::open(file);
      EXPECT_TRUE(opened) << kernel::outcome::text(opened.error());
    }
  }
}

TEST(RecordWriter, RefusesAFileThatExistsAndAFolderThatDoesNot) {
  const test::Folder folder;
  test::quiet_writer(folder.file("a.sqlite"));
  EXPECT_FALSE(RecordWriter::make({.file = folder.file("a.sqlite")}));
  EXPECT_FALSE(RecordWriter::make({.file = folder.file("none/a.sqlite")}));
  EXPECT_FALSE(RecordWriter::make({.file = ""}));
  EXPECT_FALSE(RecordWriter::make({.file = folder.file("b.sqlite"), .commit_s = 0.0}));
}

/// Records noise until the files may not grow any further; 0 if the record then ended as it should.
int record_until_full(const std::string& file) {
  const auto writer = test::quiet_writer(file);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{.rlim_cur = 3'000'000, .rlim_max = 3'000'000};
  setrlimit(RLIMIT_FSIZE, &limit);
  test::Random random(4);
  for (int i = 0; i < 10'000 && !writer->failed(); ++i) {
    test::add(*writer, test::any_sample(random));
    if (i % 100 == 99) {
      writer->flush();
    }
  }
  const std::uint64_t before = writer->dropped();
  test::add(*writer, {});
  writer->flush();
  return writer->failed() && writer->fault() && before > 0 && writer->dropped() == before + 1 ? 0
                                                                                              : 1;
}

// In a child process, since the limit holds for the whole process.
TEST(RecordWriter, AFullDiskEndsTheRecordAndKeepsWhatWasWritten) {
  const test::Folder folder;
  const std::string file = folder.file("a.sqlite");
  const pid_t child = fork();
  if (child == 0) {
    _exit(record_until_full(file));
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  auto reader = RecordReader::open(file).value();
  EXPECT_FALSE(reader.totals().closed);
  EXPECT_GT(reader.totals().samples, 0U);
  std::uint64_t samples = 0;
  Sample sample;
  while (reader.next(sample).value()) {
    ++samples;
  }
  EXPECT_EQ(samples, reader.totals().samples);
}

}  // namespace
}  // namespace steadyrest::record
