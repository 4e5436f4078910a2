// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/live/black_box.hpp>

namespace steadyrest::live {
namespace {

using kernel::outcome::Reason;

/// Cycles of 10 ms.
struct Watch {
  std::string_view cycle(bool port_fault, Reason unfit = Reason::none) {
    now.now_s += 0.01;
    now.port_fault = port_fault;
    now.unfit = unfit;
    return box.update(now);
  }
  int told(int cycles, bool port_fault, Reason unfit = Reason::none) {
    int count = 0;
    for (int i = 0; i < cycles; ++i) {
      count += cycle(port_fault, unfit).empty() ? 0 : 1;
    }
    return count;
  }
  BlackBox box;
  BlackBox::Cycle now{.now_s = 1e5};
};

TEST(BlackBox, TellsWhereAFaultBeginsAndOnlyThere) {
  Watch watch;
  EXPECT_EQ(watch.told(100, false), 0);
  EXPECT_EQ(watch.cycle(true), "kept: the port could not be read or written");
  EXPECT_EQ(watch.told(10'000, true), 0) << "100 s of the same";
  EXPECT_EQ(watch.told(100, false), 0);
  EXPECT_EQ(watch.told(1, true), 1);
}

TEST(BlackBox, FaultsThatFollowCloselyAreToldOnce) {
  Watch watch;
  int told = 0;
  for (int i = 0; i < 3100; ++i) {  // 62 s of a loose contact
    told += watch.told(1, true) + watch.told(1, false);
  }
  EXPECT_EQ(told, 3) << "at 0, 30 and 60 s";
}

TEST(BlackBox, ABurstOfOverrunsDoesNotHideALostLink) {
  Watch watch;
  watch.told(10, false);
  watch.now.overruns += 100;
  EXPECT_EQ(watch.cycle(false), "kept: a burst of overruns");
  EXPECT_EQ(watch.cycle(true), "kept: the port could not be read or written");
  EXPECT_TRUE(watch.cycle(true).empty());
}

TEST(BlackBox, NamesWhatWasUnfit) {
  EXPECT_EQ(Watch().cycle(false, Reason::input_stale), "kept: the input was stale");
  EXPECT_EQ(Watch().cycle(false, Reason::input_not_finite), "kept: the input was not finite");
  EXPECT_EQ(Watch().cycle(false, Reason::input_out_of_range), "kept: the input was out of range");
}

TEST(BlackBox, OverrunsCountOnlyInABurst) {
  Watch slow;
  for (int i = 0; i < 6000; ++i) {
    slow.now.overruns += i % 10 == 0 ? 1 : 0;  // ten in a second
    EXPECT_TRUE(slow.cycle(false).empty());
  }
  Watch burst;
  burst.told(105, false);
  std::string_view why;
  for (int i = 0; i < 30 && why.empty(); ++i) {
    ++burst.now.overruns;
    why = burst.cycle(false);
  }
  EXPECT_EQ(why, "kept: a burst of overruns");
}

TEST(BlackBox, AllocatesNothing) {
  Watch watch;
  const kernel::rt::testing::AllocationGuard guard;
  EXPECT_EQ(watch.told(1, true), 1);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::live
