// SPDX-License-Identifier: Apache-2.0
#include <cmath>
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

// Counts and clocks of 16 to 64 bits, both about to wrap. `certain_from` of 1000 makes every sign a
// guess where the hardware gives no direction, so the test expects the mark there.
RC_GTEST_PROP(LatchedDecoder, GivesTheLastEdgeOfEachCycleWhereverCountAndClockWrap,
              (bool tells_direction)) {
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  const unsigned count_bits = *rc::gen::element(16U, 24U, 32U, 64U);
  const unsigned clock_bits = *rc::gen::element(16U, 24U, 32U, 64U);
  // Both begin just before they wrap.
  const std::uint64_t start = detail::mask(clock_bits) / 2 - random() % 9000;
  const auto cell = static_cast<std::int64_t>(detail::mask(count_bits) / 2) -
                    static_cast<std::int64_t>(random() % 20);
  Input input(count_bits, clock_bits, cell, start);
  LatchedDecoder decoder({.count_bits = count_bits,
                          .clock_bits = clock_bits,
                          .cycle_ticks = kCycle,
                          .certain_from = tells_direction ? 1U : 1000U});
  EdgeEvent event;
  decoder.update(input.read(0, tells_direction), event);
  const std::int64_t zero = decoder.count() - cell;
  for (std::uint64_t cycle = 1; cycle <= 200; ++cycle) {
    const std::uint64_t edges = input.edges();
    random_cycle(input, random);
    const bool seen = decoder.update(input.read(cycle, tells_direction), event);
    const std::uint64_t passed = input.edges() - edges;
    RC_ASSERT(decoder.count() - zero == input.cell());
    RC_ASSERT(decoder.ticks() - start == input.now() - start);
    RC_ASSERT(seen == (passed > 0));
    if (!seen) {
      continue;
    }
    RC_ASSERT(event.ticks == input.edge_at());
    RC_ASSERT(event.lost < passed);
    RC_ASSERT((passed - 1 - event.lost) % 2 == 0);
    if (tells_direction) {
      RC_ASSERT(event.uncertain == 0);
      RC_ASSERT(event.line - zero == input.line());
      RC_ASSERT(event.direction == input.direction());
    } else {
      RC_ASSERT(event.uncertain == kLineGuessed);
    }
  }
}

/// Reads x(t) = A·t²/2 turned about `phase`, in counts and cycles; counts wrong events.
/// The parabola turns at `phase` of a cycle: there the last edge may go against the sign of the
/// change. Forty places within a count, both signs.
int wrong_lines(double acceleration, double phase, std::uint64_t certain_from) {
  LatchedDecoder decoder({.clock_bits = 16, .cycle_ticks = 1000, .certain_from = certain_from});
  EdgeEvent event;
  int wrong = 0;
  for (const double sign : {1.0, -1.0}) {
    for (int offset = 0; offset < 40; ++offset) {
      decoder =
          LatchedDecoder({.clock_bits = 16, .cycle_ticks = 1000, .certain_from = certain_from});
      Input input(32, 16, 0, 1);
      const double start = -10.0;
      const auto x = [&](double t) {
        const double d = t - phase;
        return sign * -0.5 * acceleration * d * d + offset / 40.0 +
               sign * 0.5 * acceleration * (start - phase) * (start - phase);
      };
      for (int k = 0; k <= 20'000; ++k) {
        const double t = start + k * 1e-3;
        const auto cell = static_cast<std::int64_t>(std::floor(x(t)));
        while (input.cell() != cell) {
          input.pass(cell > input.cell() ? 1 : -1);
        }
        if (k % 1000 == 0 &&
            decoder.update(input.read(static_cast<std::uint64_t>(k / 1000), false), event)) {
          wrong += event.uncertain == 0 && event.line != input.line() ? 1 : 0;
        }
        input.wait(1);
      }
    }
  }
  return wrong;
}

// From both sides: just below |a| = 2n no certain line may be wrong, above it some must be, or the
// limit would be too low.
TEST(LatchedDecoder, TheSignOfTheChangeIsCertainUpToTheAccelerationThatTheHeaderNames) {
  for (const std::uint64_t n : {1U, 2U, 4U}) {
    int below = 0;
    int above = 0;
    for (int i = 0; i < 20; ++i) {
      const double limit = 2.0 * static_cast<double>(n);
      below += wrong_lines(0.98 * limit, 0.05 * i, n);
      above += wrong_lines(1.25 * limit, 0.05 * i, n);
    }
    EXPECT_EQ(below, 0) << n;
    EXPECT_GT(above, 0) << n;  // the limit is not too low
  }
}

// Up, then down and up again over line 8 within a cycle: the count is the same, the stamp is new.
TEST(LatchedDecoder, DitherWithinACycleIsTheSameLineAgainAndSaysThatItIsAGuess) {
  Input input(16, 16, 7, 100);
  LatchedDecoder decoder(hostmot2_config(kCycle));
  EdgeEvent event;
  decoder.update(input.read(0, false), event);
  input.wait(500);
  input.pass(1);
  input.wait(1500);
  ASSERT_TRUE(decoder.update(input.read(1, false), event));
  EXPECT_EQ(event.line, 8);
  EXPECT_EQ(event.uncertain, 0);
  input.wait(300);
  input.pass(-1);
  input.wait(300);
  input.pass(1);
  input.wait(1400);
  ASSERT_TRUE(decoder.update(input.read(2, false), event));
  EXPECT_EQ(event.line, 8);
  EXPECT_EQ(event.direction, 1);
  EXPECT_EQ(event.lost, 1U);
  EXPECT_EQ(event.ticks, 100U + 2000U + 600U);
  EXPECT_EQ(event.uncertain, kLineGuessed);
  EXPECT_EQ(decoder.count(), 8);
  input.wait(kCycle);
  EXPECT_FALSE(decoder.update(input.read(3, false), event));
}

// Dither at the counter's wrap, 65 535 to 0: a sign error would show as 65 536 counts.
TEST(LatchedDecoder, AMillionCyclesOfDitherDoNotMoveTheCount) {
  Input input(16, 16, 65'535, 0);
  LatchedDecoder decoder(hostmot2_config(kCycle));
  EdgeEvent event;
  std::mt19937_64 random(11);
  decoder.update(input.read(0, false), event);
  const std::int64_t zero = decoder.count() - 65'535;
  for (std::uint64_t cycle = 1; cycle <= 1'000'000; ++cycle) {
    for (std::uint64_t n = random() % 4; n > 0; --n) {
      input.wait(100);
      input.pass(input.cell() == 65'535 ? 1 : -1);  // about line 65 536, where the counter wraps
    }
    input.wait(1600);
    if (decoder.update(input.read(cycle, false), event)) {
      ASSERT_EQ(event.line - zero, 65'536);
      ASSERT_EQ(event.ticks, input.edge_at());
    }
    ASSERT_EQ(decoder.count() - zero, input.cell());
  }
  EXPECT_EQ(decoder.state().gaps, 0U);
}

}  // namespace
}  // namespace steadyrest::motion::online
