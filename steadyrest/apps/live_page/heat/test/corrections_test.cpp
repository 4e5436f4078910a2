// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/heat/corrections.hpp>

namespace steadyrest::apps::live_page {
namespace {

kernel::signal::AxisValues z(double offset_mm) {
  kernel::signal::AxisValues out{};
  out[2] = offset_mm;
  return out;
}

// 1 µm a minute, the slope of a machine file without one, seen 10 times a second.
TEST(Corrections, ListEachMicrometreOfASlowOffset) {
  Corrections corrections;
  for (int n = 0; n <= 1850; ++n) {
    corrections.see(0.1 * n, z(-0.001 / 60.0 * 0.1 * n), 3);
  }
  ASSERT_EQ(corrections.list().size(), 3U);
  const Correction& second = corrections.list()[1];
  EXPECT_EQ(second.axis, 2U);
  EXPECT_NEAR(second.from_s, 120.0, 0.15);
  EXPECT_NEAR(second.from_mm, -0.001, 1e-12);
  EXPECT_NEAR(second.to_mm, -0.002, 1e-12);
}

TEST(Corrections, TakeOneMoveForOne) {
  Corrections corrections;
  corrections.see(0.0, z(-0.010), 3);
  for (int n = 1; n <= 30; ++n) {  // handed back at 10 µm/s
    corrections.see(100.0 + 0.033 * n, z(-0.010 + 0.010 * n / 30.0), 3);
  }
  corrections.see(101.5, z(-0.002), 3);
  ASSERT_EQ(corrections.list().size(), 3U);
  EXPECT_NEAR(corrections.list()[1].from_mm, -0.010, 1e-9);
  EXPECT_NEAR(corrections.list()[1].to_mm, 0.0, 1e-9);
  EXPECT_LT(corrections.list()[2].to_mm, corrections.list()[2].from_mm) << "the other way";
}

TEST(Corrections, DoNotListLessThanAMicrometre) {
  Corrections corrections;
  for (int n = 0; n < 1000; ++n) {
    corrections.see(n, z(n % 2 == 0 ? 0.0009 : -0.00009), 3);
  }
  EXPECT_TRUE(corrections.list().empty());
}

TEST(Corrections, KeepTheNewest) {
  Corrections corrections;
  for (int n = 0; n < 2000; ++n) {
    corrections.see(10.0 * n, z(n % 2 == 0 ? 0.005 : 0.0), 3);
  }
  EXPECT_EQ(corrections.list().size(), Corrections::kMost);
  EXPECT_EQ(corrections.list().back().to_s, 19'990.0);
  EXPECT_TRUE(corrections.from_here().list().empty());
}

}  // namespace
}  // namespace steadyrest::apps::live_page
