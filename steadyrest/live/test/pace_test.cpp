// SPDX-License-Identifier: Apache-2.0
#include <ctime>

#include <gtest/gtest.h>

#include <steadyrest/live/pace.hpp>

namespace steadyrest::live {
namespace {

// Nothing is said of how late a wake-up is: that is the computer's. It is never early.
TEST(MonotonicPace, IsNeverEarly) {
  MonotonicPace pace(0.002);
  const double begin_s = pace.now_s();
  pace.wait();
  std::uint64_t deadlines = 1;
  double late_s = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Pace::Wake wake = pace.wait();
    EXPECT_GE(wake.lateness_s, 0.0);
    deadlines += 1 + wake.missed;
    late_s = wake.lateness_s;
  }
  EXPECT_GE(pace.now_s() - begin_s + 1e-6, 0.002 * static_cast<double>(deadlines) + late_s);
}

TEST(MonotonicPace, LeavesOutWhatHasPassed) {
  MonotonicPace pace(0.001);
  pace.wait();
  const timespec nap{.tv_sec = 0, .tv_nsec = 10'500'000};
  nanosleep(&nap, nullptr);
  const Pace::Wake wake = pace.wait();
  EXPECT_GE(wake.missed, 9U);
  EXPECT_GE(wake.lateness_s, 0.0);
}

}  // namespace
}  // namespace steadyrest::live
