// SPDX-License-Identifier: Apache-2.0
// A short hunt; steadyrest_daemon_hunt runs as long as requested.
#include <bench/hostile/daemon/daemon_hunt.hpp>
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::bench::hostile {
namespace {

class DaemonHuntTest : public testing::TestWithParam<const char*> {};

TEST_P(DaemonHuntTest, NoHostileInputGetsACommandPastTheEnvelopeOrEndsTheLoop) {
  kernel::rt::testing::AllocationGuard guard;
  const DaemonTally seen =
      hunt({.machine = GetParam(), .cycles = 50'000, .scene = 4000, .allocations = [&guard] {
              return guard.allocations();
            }});
  EXPECT_EQ(seen.broken, 0U) << seen.first;
  EXPECT_EQ(seen.allocated, 0U);
  // A hunt in which little happens proves little.
  EXPECT_GT(seen.written, 12'500U);
  EXPECT_GT(seen.masked, 2'500U);
  EXPECT_GT(seen.moved, 500U);
  EXPECT_GT(seen.failed, 500U);
  EXPECT_GT(seen.asked, 3U);
  guard.forgive();  // its own scenes
}

INSTANTIATE_TEST_SUITE_P(Machines, DaemonHuntTest, testing::Values("vmc-840d", "linuxcnc-mill"));

}  // namespace
}  // namespace steadyrest::bench::hostile
