// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <barrier>
#include <csignal>
#include <string>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

constexpr int kCommitted = 1000;

/// Commits, adds more, tells the parent and waits for its end.
[[noreturn]] void record_and_wait(const std::string& file, int tell) {
  const auto writer = test::quiet_writer(file);
  test::Random random(5);
  for (int i = 0; i < kCommitted + 500; ++i) {
    test::add(*writer, test::any_sample(random));
    if (i == kCommitted - 1) {
      writer->flush();
    }
  }
  if (write(tell, "x", 1) != 1) {
    _exit(1);
  }
  for (;;) {
    pause();
  }
}

/// Its log lies beside the record and has to be recovered.
void kill_a_writer(const std::string& file) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    record_and_wait(file, ends[1]);
  }
  char told = 0;
  ASSERT_EQ(read(ends[0], &told, 1), 1);
  kill(child, SIGKILL);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  close(ends[0]);
  close(ends[1]);
}

TEST(KilledWriter, LeavesEveryTransactionThatItMade) {
  const test::Folder folder;
  const std::string file = folder.file("a.sqlite");
  ASSERT_NO_FATAL_FAILURE(kill_a_writer(file));

  auto reader = RecordReader::open(file).value();
  EXPECT_FALSE(reader.totals().closed);
  test::Random random(5);
  Sample sample;
  for (int i = 0; i < kCommitted; ++i) {
    ASSERT_TRUE(reader.next(sample).value());
    EXPECT_EQ(test::bits_of(sample), test::bits_of(test::any_sample(random)));
  }
  EXPECT_FALSE(reader.next(sample).value());
}

// Whoever opens the record first recovers the log, and nobody else can read it meanwhile.
TEST(KilledWriter, LeavesARecordThatSeveralReadersOpenAtOnce) {
  constexpr int kRounds = 50;
  const test::Folder folder;
  const std::string file = folder.file("a.sqlite");
  ASSERT_NO_FATAL_FAILURE(kill_a_writer(file));
  for (int round = 0; round < kRounds; ++round) {
    std::barrier together(2);
    std::array<std::string, 2> refused;
    const auto read = [&](std::string& into) {
      together.arrive_and_wait();
      const auto reader = RecordReader::open(file);
      into = reader ? "" : reader.error().what;
      together.arrive_and_wait();  // the next round recovers again
    };
    {
      const std::jthread other([&] { read(refused[1]); });
      read(refused[0]);
    }
    ASSERT_EQ(refused[0] + refused[1], "") << round;
  }
}

}  // namespace
}  // namespace steadyrest::record
