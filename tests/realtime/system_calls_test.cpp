// SPDX-License-Identifier: Apache-2.0
// The thread of the loop makes no system call but its pace's: a seccomp filter on this thread alone
// kills the process at any other. Record and rooms are at work.
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <tests/rig/everything_on.hpp>
#include <unistd.h>

#include <steadyrest/live/loop.hpp>
#include <steadyrest/record/recording_port.hpp>

namespace steadyrest {
namespace {

constexpr int kLoopDone = 42;
constexpr int kNoFilter = 43;
constexpr int kIdleRooms = 44;

constexpr sock_filter statement(unsigned code, unsigned value) {
  return {.code = static_cast<unsigned short>(code), .jt = 0, .jf = 0, .k = value};
}
/// Allows the call with this number, else goes on to the next line.
constexpr std::array<sock_filter, 2> allow(long number) {
  return {
      sock_filter{
          .code = BPF_JMP | BPF_JEQ | BPF_K, .jt = 0, .jf = 1, .k = static_cast<unsigned>(number)},
      statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
}

/// From here on this thread may sleep, read the clock and end its process, nothing else.
bool allow_pace_alone() {
  const auto sleep = allow(SYS_clock_nanosleep);
  const auto clock = allow(SYS_clock_gettime);
  const auto end = allow(SYS_exit_group);
  std::array<sock_filter, 8> lines{statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                                   sleep[0],
                                   sleep[1],
                                   clock[0],
                                   clock[1],
                                   end[0],
                                   end[1],
                                   statement(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS)};
  const sock_fprog program{.len = lines.size(), .filter = lines.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Runs in a separate process, which the filter may kill.
[[noreturn]] void run_filtered(const std::string& machine_name, const std::string& folder,
                               bool forbidden_call) {
  constexpr std::uint64_t kCycles = 2000;
  const auto machine = rig::everything_on(machine_name);
  const auto port = rig::chattering(machine, rig::busy_path(machine, 100));
  auto layer = rig::listening(machine, port->capability());
  const auto writer =
      record::RecordWriter::make({.file = folder + "/run.sqlite", .info = {.cycle_s = 0.001}})
          .value();
  record::RecordingPort recording(*port, *writer);
  live::MonotonicPace pace(0.00025);
  live::Loop loop(
      recording, layer, pace,
      {.period_s = 0.00025,
       .contour_limit_mm = 0.01,
       .handback_s = 0.05,
       .mode = kernel::machine::Mode::act,
       .most_cycles = kCycles,
       .on_mode = [&](kernel::machine::Mode) { writer->event(record::EventKind::mode, "act"); },
       .on_command =
           [&](const kernel::signal::Command& command) {
             recording.record(command);
             if (forbidden_call && command.heartbeat == kCycles / 2) {
               static_cast<void>(::getppid());
             }
           }});
  if (!allow_pace_alone()) {
    ::_exit(kNoFilter);
  }
  const live::LoopFigures& figures = loop.run();
  const auto& seen = layer.estimates();
  const bool at_work = figures.port_faults == 0 && seen.contour && seen.chatter && seen.heard &&
                       seen.thermal && seen.thermal->displacement_mm[2] != 0.0;
  ::_exit(at_work ? kLoopDone : kIdleRooms);
}

/// The child's wait status.
int status_of(const char* machine, bool forbidden_call) {
  const std::string folder = testing::TempDir() + "system-calls-" + std::to_string(::getpid());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const pid_t child = ::fork();
  if (child == 0) {
    run_filtered(machine, folder, forbidden_call);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  std::filesystem::remove_all(folder);
  return status;
}

TEST(SystemCalls, TheLoopMakesNoneButItsPaces) {
  for (const char* machine : {"vmc-840d", "linuxcnc-mill"}) {
    const int status = status_of(machine, false);
    ASSERT_TRUE(WIFEXITED(status)) << machine << ": killed by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), kLoopDone) << machine;
  }
}

TEST(SystemCalls, AnyOtherWouldEndTheProcess) {
  const int status = status_of("vmc-840d", true);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGSYS);
}

}  // namespace
}  // namespace steadyrest
