// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/motion/online/edges/edge_inputs.hpp>
#include <steadyrest/motion/online/edges/test/latched_input.hpp>

namespace steadyrest::motion::online {
namespace {

using test::kCycle;

TEST(Hostmot2, AnEdgeBetweenTheTwoRegistersStillComesBeforeItsTick) {
  LatchedDecoder decoder(hostmot2_config(kCycle, 500));
  EdgeEvent event;
  decoder.update(hostmot2_read(0x0000'0000U, 0xFFF0U, 0), event);
  // Clock read at 0x07C0 (2000 later), the edge 32 ticks after that, then the counter.
  ASSERT_TRUE(decoder.update(hostmot2_read(0x07E0'0001U, 0x07C0U, 1), event));
  EXPECT_EQ(event.ticks, 0xFFF0U + 2032U);
  EXPECT_EQ(event.uncertain, 0);
  EXPECT_EQ(decoder.ticks(), event.ticks);
  // The same edge is not seen again.
  EXPECT_FALSE(decoder.update(hostmot2_read(0x07E0'0001U, 0x07C0U + 2000U, 2), event));
  EXPECT_EQ(decoder.ticks(), 0xFFF0U + 4000U);
}

/// Capture ticks of 1.28 µs (100 MHz / 128), cycle 1 ms = 781.25 of them: the timer is full after
/// 84 ms.
/// At 200 the timer is full and stays so, at 350 it has overflowed; both times the next edge must
/// have its true instant.
TEST(Eqep, AFullOrOverrunTimerGivesNoEdgeAndTheNextOneItsRightTime) {
  LatchedDecoder decoder(eqep_config());
  EdgeEvent event;
  constexpr double kTicks = 781.25;
  std::uint64_t edge = 100;  // in capture ticks
  std::uint32_t position = 5;
  for (int k = 0; k <= 400; ++k) {
    const auto clock = static_cast<std::uint64_t>(std::floor(k * kTicks)) + 1000;
    const bool moves = k == 200 || k == 350;
    if (moves) {
      edge = clock - 50;
      ++position;
    }
    const std::uint64_t age = clock - edge;
    // k < 300: the timer stops when full; after that it overflows and sets COEF.
    const bool runs_over = k >= 300;
    const auto timer = static_cast<std::uint16_t>(
        runs_over ? age & 0xFFFFU : std::min<std::uint64_t>(age, 0xFFFFU));
    const bool overflow = runs_over && (moves || (age >> 16U) != ((age - 781) >> 16U));
    const bool seen = decoder.update(eqep_read({.position = position,
                                                .timer = timer,
                                                .overflow = overflow,
                                                .direction_error = false,
                                                .direction = 0,
                                                .clock = clock}),
                                     event);
    ASSERT_EQ(seen, moves) << k;
    if (moves) {
      EXPECT_EQ(event.ticks, edge);
      EXPECT_EQ(event.uncertain, 0);
    }
  }
  EXPECT_EQ(decoder.count(), 7);
}

// COEF and CDEF as in the manual: after a turn the sign of three counts is not a direction.
TEST(Eqep, TheFlagOfATurnMakesTheLineAGuessUnlessTheDirectionIsKnown) {
  for (const int direction : {0, -1}) {
    LatchedDecoder decoder(eqep_config());
    EdgeEvent event;
    decoder.update(eqep_read({.position = 10, .timer = 900, .clock = 5000}), event);
    ASSERT_TRUE(decoder.update(eqep_read({.position = 13,
                                          .timer = 80,
                                          .direction_error = true,
                                          .direction = static_cast<std::int8_t>(direction),
                                          .clock = 5781}),
                               event));
    EXPECT_EQ(event.uncertain, direction == 0 ? kLineGuessed : 0);
    EXPECT_EQ(event.line, direction == 0 ? 13 : 14);
    EXPECT_EQ(event.lost, direction == 0 ? 2U : 4U);
  }
}

// Nanoseconds since the epoch need all 64 bits.
TEST(LinuxCounter, EveryEventIsAnEdgeWithItsOwnStamp) {
  LatchedDecoder decoder(linux_counter_config(24));
  EdgeEvent event;
  constexpr std::uint64_t kNow = 1'760'000'000'000'000'000;  // ns since the epoch
  EXPECT_FALSE(decoder.update(linux_counter_read(0xFFFFFE, kNow), event));
  ASSERT_TRUE(decoder.update(linux_counter_read(0xFFFFFF, kNow + 700), event));
  EXPECT_EQ(event.line, -1);
  ASSERT_TRUE(decoder.update(linux_counter_read(0x000000, kNow + 1500), event));
  EXPECT_EQ(event.line, 0);
  ASSERT_TRUE(decoder.update(linux_counter_read(0xFFFFFF, kNow + 2900), event));
  EXPECT_EQ(event.line, 0);
  EXPECT_EQ(event.direction, -1);
  EXPECT_EQ(event.ticks, kNow + 2900);
  EXPECT_EQ(event.uncertain, 0);
  // An event whose time goes back is an edge without a time.
  ASSERT_TRUE(decoder.update(linux_counter_read(0xFFFFFE, kNow + 100), event));
  EXPECT_EQ(event.uncertain, kTimeUnknown);
}

// Halfway into cell −1 is cell −1: an arithmetic shift, not a division.
TEST(EtherCat, MicroIncrementsAreCutOffAndAMissingStampIsNotInvented) {
  LatchedDecoder decoder(ethercat_config(32, 8, 1'000'000));
  EdgeEvent event;
  decoder.update(ethercat_read(0xFFFF'FF80U, 5, 10, 0, true), event);  // cell −1, halfway
  EXPECT_EQ(decoder.count(), -1);
  EXPECT_FALSE(decoder.update(ethercat_read(0xFFFF'FFF0U, 5, 1'000'010, 1, true), event));
  ASSERT_TRUE(decoder.update(ethercat_read(0x0000'0010U, 1'900'000, 2'000'010, 2, true), event));
  EXPECT_EQ(event.line, 0);
  EXPECT_EQ(event.ticks, 1'900'000U);
  ASSERT_TRUE(decoder.update(ethercat_read(0x0000'0110U, 0, 3'000'010, 3, false), event));
  EXPECT_EQ(event.line, 1);
  EXPECT_EQ(event.uncertain, kTimeUnknown);
}

}  // namespace
}  // namespace steadyrest::motion::online
