// SPDX-License-Identifier: Apache-2.0
// Somebody sets the computer's clock while the layer runs: the loop does not look at it. The clock
// of this program is its own: CLOCK_REALTIME jumps by an hour at every look.
#include <atomic>
#include <ctime>

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <tests/rig/everything_on.hpp>
#include <unistd.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/recording_port.hpp>

namespace {

std::atomic<int> looks_at_real_time{0};
thread_local bool in_loop = false;
thread_local int looks_in_loop = 0;

}  // namespace

// In the place of the library's.
extern "C" int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const auto answer = static_cast<int>(::syscall(SYS_clock_gettime, clock, now));
  if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE) {
    const int looks = ++looks_at_real_time;
    now->tv_sec += looks % 2 == 0 ? 3600 : -3600;
    looks_in_loop += in_loop ? 1 : 0;
  }
  return answer;
}

namespace steadyrest {
namespace {

TEST(ClockChange, TheLoopDoesNotLookAtTheComputersClock) {
  constexpr std::uint64_t kCycles = 1500;
  const int before = looks_at_real_time.load();
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  ASSERT_EQ(looks_at_real_time.load(), before + 1) << "this program's clock is not in use";
  const kernel::file::testing::OwnFolder folder;
  const auto machine = rig::everything_on("vmc-840d");
  const auto port = rig::chattering(machine, rig::busy_path(machine, 20));
  auto layer = rig::listening(machine, port->capability());
  live::MonotonicPace pace(0.0005);
  {
    const auto writer =
        record::RecordWriter::make(
            {.file = folder.at("run.sqlite"), .info = {.cycle_s = 0.004}, .commit_s = 0.1})
            .value();
    record::RecordingPort recording(*port, *writer);
    live::Loop loop(
        recording, layer, pace,
        {.period_s = 0.0005,
         .contour_limit_mm = 0.01,
         .most_cycles = kCycles,
         .on_mode =
             [&](kernel::machine::Mode) { writer->event(record::EventKind::mode, "observe"); },
         .on_command = [&](const kernel::signal::Command& c) { recording.record(c); }});
    ::alarm(60);  // a loop that looks there may sleep for an hour
    in_loop = true;
    const auto& figures = loop.run();
    in_loop = false;
    ::alarm(0);
    EXPECT_EQ(figures.cycles, kCycles);
    EXPECT_EQ(looks_in_loop, 0);
    EXPECT_LT(figures.lateness.largest_s(), 1000.0);
    EXPECT_LT(figures.overruns, 1'000'000U) << "an hour is seven million cycles";
    writer->flush();
    EXPECT_EQ(writer->dropped(), 0U);
    EXPECT_FALSE(writer->failed());
  }
  auto reader = record::RecordReader::open(folder.at("run.sqlite"));
  ASSERT_TRUE(reader.has_value());
  record::Sample sample;
  std::uint64_t samples = 0;
  for (auto more = reader->next(sample); more && *more; more = reader->next(sample)) {
    ++samples;
  }
  EXPECT_EQ(samples, kCycles);
}

}  // namespace
}  // namespace steadyrest
