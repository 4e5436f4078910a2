// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/sample_queue.hpp>
#include <steadyrest/adapters/linuxcnc/test/fake_hal.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using test::cutting;
using test::FakeHal;
using Got = SampleQueue::Got;

TEST(SampleQueue, JoinsTheChannelsOfOneCycle) {
  FakeHal hal;
  SampleQueue queue(3);
  Sample sample;
  hal.push(cutting(7));
  ASSERT_EQ(queue.next(hal, sample), Got::sample);
  EXPECT_EQ(sample.tick, 7U);
  EXPECT_EQ(sample[Column::path_speed], 66.7);
  EXPECT_EQ(sample.axis[0].following_error, 1.0);
  EXPECT_EQ(queue.next(hal, sample), Got::none);
}

TEST(SampleQueue, WaitsForTheChannelThatIsStillToCome) {
  FakeHal hal;
  SampleQueue queue(3);
  Sample sample;
  hal.push_state(cutting(7));
  EXPECT_EQ(queue.next(hal, sample), Got::none);
  hal.push_axes(cutting(7));
  EXPECT_EQ(queue.next(hal, sample), Got::sample);
}

TEST(SampleQueue, LeavesOutCyclesThatOneChannelLost) {
  FakeHal hal;
  SampleQueue queue(3);
  Sample sample;
  hal.push(cutting(1));
  hal.push_state(cutting(2));
  hal.push_axes(cutting(3));
  hal.push_state(cutting(4));
  hal.push_axes(cutting(4));
  ASSERT_EQ(queue.next(hal, sample), Got::sample);
  EXPECT_EQ(sample.tick, 1U);
  ASSERT_EQ(queue.next(hal, sample), Got::sample);
  EXPECT_EQ(sample.tick, 4U);
  EXPECT_EQ(queue.missed(), 2U);
}

TEST(SampleQueue, CountsAGapInAllChannels) {
  FakeHal hal;
  SampleQueue queue(3);
  Sample sample;
  hal.push(cutting(100));
  hal.push(cutting(111));
  ASSERT_EQ(queue.next(hal, sample), Got::sample);
  EXPECT_EQ(queue.missed(), 0U);  // what came before the first is nobody's loss
  ASSERT_EQ(queue.next(hal, sample), Got::sample);
  EXPECT_EQ(queue.missed(), 10U);
}

TEST(SampleQueue, TellsAFrozenCounterFromARestartedOne) {
  FakeHal hal;
  SampleQueue queue(3);
  Sample sample;
  hal.push(cutting(7));
  hal.push(cutting(7));
  hal.push(cutting(3));
  EXPECT_EQ(queue.next(hal, sample), Got::sample);
  EXPECT_EQ(queue.next(hal, sample), Got::frozen);
  EXPECT_EQ(queue.next(hal, sample), Got::restarted);
}

TEST(SampleQueue, RefusesATickThatIsNone) {
  for (const double tick : {std::numeric_limits<double>::quiet_NaN(), -1.0, 0.5,
                            std::numeric_limits<double>::infinity()}) {
    FakeHal hal;
    SampleQueue queue(3);
    Sample sample;
    hal.push(cutting(7));
    hal.rows[1][0][0] = tick;
    EXPECT_EQ(queue.next(hal, sample), Got::not_a_tick) << tick;
  }
}

TEST(SampleQueue, SpreadsEightAxesOverTwoChannels) {
  FakeHal hal;
  SampleQueue queue(8);
  Sample sample;
  hal.push(cutting(7));
  EXPECT_EQ(queue.next(hal, sample), Got::none);
  hal.rows[2].push_back({7.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0});
  ASSERT_EQ(queue.next(hal, sample), Got::sample);
  EXPECT_EQ(sample.axis[4].command, 1.0);
  EXPECT_EQ(sample.axis[5].following_error, 7.0);
  EXPECT_EQ(sample.axis[5].offset, 8.0);
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc
