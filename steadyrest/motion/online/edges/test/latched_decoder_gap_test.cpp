// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/motion/online/edges/edge_inputs.hpp>
#include <steadyrest/motion/online/edges/test/latched_input.hpp>

namespace steadyrest::motion::online {
namespace {

using test::Input;
using test::kCycle;
using test::random_cycle;

// After more than half of the clock's range it is unknown how often the stamp wrapped: no time
// rather than a wrong one.
RC_GTEST_PROP(LatchedDecoder, DroppedCyclesNeverGiveAFalseTime, ()) {
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  Input input(16, 16, 0, random() % 65'536);
  const std::uint64_t start = input.now();
  LatchedDecoder decoder(hostmot2_config(kCycle));
  EdgeEvent event;
  decoder.update(input.read(0, true), event);
  std::uint64_t cycle = 0;
  std::uint32_t gaps = 0;
  for (int i = 0; i < 100; ++i) {
    // Up to 200 cycles are missed: 16 bits at 2 ticks/µs wrap after 32.8.
    const std::uint64_t missed = random() % 4 != 0 ? 1 : 1 + random() % 200;
    const std::uint64_t before = input.now();
    const std::uint64_t edges = input.edges();
    for (std::uint64_t k = 0; k < missed; ++k, ++cycle) {
      random_cycle(input, random);
    }
    const bool late = input.now() - before > 32'767;
    gaps += late ? 1U : 0U;
    const bool seen = decoder.update(input.read(cycle, true), event);
    RC_ASSERT(decoder.ticks() == input.now());
    RC_ASSERT(decoder.count() == input.cell());
    if (seen) {
      RC_ASSERT(input.edges() > edges);
      RC_ASSERT(((event.uncertain & kTimeUnknown) != 0) == late);
      RC_ASSERT(late || event.ticks == input.edge_at());
      RC_ASSERT(event.ticks >= input.edge_at());
      RC_ASSERT(event.line == input.line());
    }
  }
  RC_ASSERT(decoder.state().gaps == gaps);
  RC_ASSERT(start < 65'536U);
}

// 500 counts per cycle wrap 16 bits after 131 cycles; 65 are still safe for half of the range.
TEST(LatchedDecoder, ACountThatMayHaveWrappedUnseenSaysSo) {
  LatchedDecoder decoder({.count_bits = 16, .clock_bits = 64, .counts_per_cycle = 500});
  EdgeEvent event;
  decoder.update({}, event);
  ASSERT_TRUE(decoder.update({.count = 400, .stamp = 90, .clock = 100, .cycle = 65}, event));
  EXPECT_EQ(event.uncertain, 0);
  EXPECT_EQ(event.lost, 399U);
  ASSERT_TRUE(decoder.update({.count = 500, .stamp = 190, .clock = 200, .cycle = 131}, event));
  EXPECT_EQ(event.uncertain, kCountUncertain);
}

// A stamp before the last read belongs to an edge already reported: the registers disagree.
TEST(LatchedDecoder, AStampOlderThanTheLastReadIsNoTime) {
  LatchedDecoder decoder(hostmot2_config(kCycle, 0));
  EdgeEvent event;
  decoder.update({.count = 0, .stamp = 1000, .clock = 5000, .cycle = 0}, event);
  // The count moved, the stamp lies before the last read.
  ASSERT_TRUE(decoder.update({.count = 1, .stamp = 4000, .clock = 7000, .cycle = 1}, event));
  EXPECT_EQ(event.uncertain, kTimeUnknown);
  EXPECT_EQ(event.line, 1);
  EXPECT_EQ(event.ticks, 7000U);
  EXPECT_EQ(decoder.state().impossible, 1U);
  // A stamp that jumps without a count change is not an edge.
  EXPECT_FALSE(decoder.update({.count = 1, .stamp = 300, .clock = 9000, .cycle = 2}, event));
}

}  // namespace
}  // namespace steadyrest::motion::online
