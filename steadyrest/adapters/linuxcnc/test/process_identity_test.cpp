// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/adapters/linuxcnc/process_identity.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

TEST(ProcessIdentity, KnowsItself) {
  const ProcessIdentity self = this_process();
  EXPECT_EQ(self.number, static_cast<std::uint32_t>(::getpid()));
  EXPECT_GT(self.start, 0U);
  EXPECT_TRUE(runs(self));
  EXPECT_TRUE(runs({.number = self.number, .start = 0})) << "start not known";
}

TEST(ProcessIdentity, TellsALaterProcessWithTheSameNumberApart) {
  const ProcessIdentity self = this_process();
  EXPECT_FALSE(runs({.number = self.number, .start = self.start - 1}));
}

TEST(ProcessIdentity, AKilledProcessDoesNotRunThoughNobodyHasAskedForItsStatus) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    for (;;) {
      ::pause();
    }
  }
  const auto number = static_cast<std::uint32_t>(child);
  EXPECT_TRUE(start_of(number).has_value());
  ::kill(child, SIGKILL);
  siginfo_t info{};
  ASSERT_EQ(::waitid(P_PID, number, &info, WEXITED | WNOWAIT), 0);
  EXPECT_FALSE(start_of(number).has_value()) << "a zombie";
  ::waitpid(child, nullptr, 0);
  EXPECT_FALSE(start_of(number).has_value()) << "gone";
}

TEST(ProcessIdentity, NobodyDoesNotRun) {
  EXPECT_FALSE(runs({}));
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc
