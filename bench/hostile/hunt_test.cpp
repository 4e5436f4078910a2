// SPDX-License-Identifier: Apache-2.0
// The hunt of bench/hostile, shortened: steadyrest_hostile_hunt runs as long as requested.
#include <string>

#include <bench/hostile/hunt.hpp>
#include <gtest/gtest.h>

#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::bench::hostile {
namespace {

class HostileHunt : public ::testing::TestWithParam<const char*> {};

TEST_P(HostileHunt, NoCycleBreaksARuleOfSafety) {
  const auto machine = passport::read(std::string(STEADYREST_SOURCE_DIR) + "/examples/machines/" +
                                      GetParam() + ".toml");
  ASSERT_TRUE(machine);
  const Tally seen = hunt(*machine, 1, 250'000);
  EXPECT_EQ(seen.broken, 0U) << seen.first;
  // A hunt in which little happens proves little.
  EXPECT_GT(seen.written, 100'000U);
  EXPECT_GT(seen.masked, 30'000U);
  EXPECT_GT(seen.moved, 500U);
  EXPECT_GT(seen.held, 1'000U);
  EXPECT_GT(seen.interrupted, 20U);
}

INSTANTIATE_TEST_SUITE_P(Machines, HostileHunt,
                         ::testing::Values("ideal-k50", "lathe-16k20f3", "linuxcnc-mill",
                                           "mill-802d", "vmc-840d"));

}  // namespace
}  // namespace steadyrest::bench::hostile
