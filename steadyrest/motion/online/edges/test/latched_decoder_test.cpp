// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/motion/online/edges/edge_inputs.hpp>

namespace steadyrest::motion::online {
namespace {

/// An encoder input with a latch, and what truly happened: the brute-force reference.
/// Keeps every edge, the decoder sees one read a cycle: whatever it says can be checked.
class Input {
 public:
  Input(unsigned count_bits, unsigned clock_bits, std::int64_t cell, std::uint64_t now)
      : count_bits_(count_bits), clock_bits_(clock_bits), cell_(cell), now_(now), edge_at_(now) {}

  void wait(std::uint64_t ticks) { now_ += ticks; }
  void pass(int direction) {
    // As counters do it: the count wraps, also at the ends of 64 bits.
    const auto cell = static_cast<std::uint64_t>(cell_);
    cell_ = static_cast<std::int64_t>(direction > 0 ? cell + 1U : cell - 1U);
    line_ = static_cast<std::int64_t>(direction > 0 ? cell + 1U : cell);
    direction_ = static_cast<std::int8_t>(direction);
    edge_at_ = now_;
    ++edges_;
  }
  [[nodiscard]] LatchedRead read(std::uint64_t cycle, bool tells_direction) const {
    return {.count = static_cast<std::uint64_t>(cell_) & detail::mask(count_bits_),
            .stamp = edge_at_ & detail::mask(clock_bits_),
            .clock = now_ & detail::mask(clock_bits_),
            .cycle = cycle,
            .direction = tells_direction ? direction_ : std::int8_t{0}};
  }
  [[nodiscard]] std::int64_t cell() const { return cell_; }
  [[nodiscard]] std::int64_t line() const { return line_; }
  [[nodiscard]] std::int8_t direction() const { return direction_; }
  [[nodiscard]] std::uint64_t edge_at() const { return edge_at_; }
  [[nodiscard]] std::uint64_t now() const { return now_; }
  [[nodiscard]] std::uint64_t edges() const { return edges_; }

 private:
  unsigned count_bits_;
  unsigned clock_bits_;
  std::int64_t cell_;
  std::int64_t line_ = 0;
  std::int8_t direction_ = 0;
  std::uint64_t now_;
  std::uint64_t edge_at_;
  std::uint64_t edges_ = 0;
};

constexpr std::uint64_t kCycle = 2000;

/// One cycle of a random walk: 0…4 edges at random instants.
/// Cycles jitter by ± 2.5 %, edges keep apart.
void random_cycle(Input& input, std::mt19937_64& random) {
  std::uint64_t left = kCycle + random() % 101 - 50;
  for (std::uint64_t n = random() % 5; n > 0; --n) {
    const std::uint64_t step = 1 + random() % (left / 6);
    input.wait(step);
    left -= step;
    input.pass((random() & 1U) != 0 ? 1 : -1);
  }
  input.wait(left);
}

// Counts and clocks of 16 to 64 bits, both about to wrap. `certain_from` of 1000 makes every sign
// a guess where the hardware gives no direction, so the test asks for the mark there.
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
/// The parabola turns at `phase` of a cycle: the case in which the last edge may be against the
/// sign of the change. Forty places within a count, both signs.
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
// limit would be put too low.
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
    EXPECT_GT(above, 0) << n;  // the limit is not put too low
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

// After more than half of the clock's range nobody can tell how often the stamp wrapped: no time
// then, rather than a wrong one.
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

// 500 counts a cycle wrap 16 bits after 131 cycles; 65 are still safe for half of the range.
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

// A stamp before the last read belongs to an edge that was there already: the registers disagree.
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
  // A stamp that jumps without an edge is none.
  EXPECT_FALSE(decoder.update({.count = 1, .stamp = 300, .clock = 9000, .cycle = 2}, event));
}

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
/// At 200 the timer is full and stays so, at 350 it has run over; both times the next edge must
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
    // k < 300: the timer stops when full; after that it runs over and tells by COEF.
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

// COEF and CDEF as the manual has them: after a turn the sign of three counts is no direction.
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
  // An event whose time runs back is an edge without a time.
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
