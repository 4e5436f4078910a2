// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/signal/arriving.hpp>

namespace steadyrest::kernel::signal {
namespace {

// 8/k of 20 1/s are 0.4 s.
TEST(Arriving, CutsOnUntilTheToolIsThere) {
  Arriving tool(20.0);
  EXPECT_EQ(tool.update(Motion::feed, 1.0), Motion::feed);
  EXPECT_FALSE(tool.cuts_on());
  EXPECT_EQ(tool.update(Motion::dwell, 1.1), Motion::feed);
  EXPECT_EQ(tool.update(Motion::idle, 1.39), Motion::feed);
  EXPECT_TRUE(tool.cuts_on());
  EXPECT_EQ(tool.update(Motion::idle, 1.41), Motion::idle);
  EXPECT_FALSE(tool.cuts_on());
}

TEST(Arriving, LeavesNoSurfaceAfterARapid) {
  Arriving tool(20.0);
  EXPECT_EQ(tool.update(Motion::feed, 1.0), Motion::feed);
  EXPECT_EQ(tool.update(Motion::rapid, 1.1), Motion::rapid);
  EXPECT_EQ(tool.update(Motion::idle, 1.2), Motion::idle);
  EXPECT_FALSE(tool.cuts_on());
}

TEST(Arriving, BeginsAtRest) {
  Arriving tool(20.0);
  EXPECT_EQ(tool.update(Motion::spindle_wait, 0.0), Motion::spindle_wait);
  EXPECT_FALSE(tool.cuts_on());
}

}  // namespace
}  // namespace steadyrest::kernel::signal
