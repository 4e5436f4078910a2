// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/motion/online/edges/edge_ring.hpp>
#include <steadyrest/motion/online/edges/latched_decoder.hpp>
#include <steadyrest/motion/online/edges/quadrature_decoder.hpp>
#include <steadyrest/motion/online/edges/test/sampled.hpp>

namespace steadyrest::motion::online {
namespace {

using test::in_cell;
using test::Sample;

// Nine events into four places: five are dropped, one of which had itself lost five.
TEST(EdgeRing, WhenItOverflowsTheNextEventSaysHowManyAreMissing) {
  EdgeRing<4> ring;
  EdgeEvent event;
  EXPECT_FALSE(ring.pop(event));
  for (std::int64_t line = 1; line <= 9; ++line) {
    event = {};
    event.line = line;
    event.lost = line == 2 ? 5 : 0;
    ring.push(event);
  }
  EXPECT_EQ(ring.size(), 4U);
  ASSERT_TRUE(ring.pop(event));
  EXPECT_EQ(event.line, 6);
  EXPECT_EQ(event.lost, 10U);  // five dropped, five that one of them had lost
  ASSERT_TRUE(ring.pop(event));
  EXPECT_EQ(event.line, 7);
  EXPECT_EQ(event.lost, 0U);
}

TEST(EdgeRecorder, DoesNotAllocate) {
  const kernel::rt::testing::AllocationGuard guard;
  QuadratureDecoder sampled({.hold_samples = 2});
  LatchedDecoder latched;
  EdgeRing<8> ring;
  EdgeEvent event;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Sample s = in_cell(static_cast<std::int64_t>(i / 4), i);
    if (sampled.update(s.a, s.b, s.t, event)) {
      ring.push(event);
    }
    if (latched.update({.count = i, .stamp = 10 * i, .clock = 10 * i + 5}, event)) {
      ring.push(event);
    }
  }
  EXPECT_EQ(ring.size(), 8U);
}

}  // namespace
}  // namespace steadyrest::motion::online
