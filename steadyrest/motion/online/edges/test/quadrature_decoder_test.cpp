// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/motion/online/edges/latched_decoder.hpp>
#include <steadyrest/motion/online/edges/quadrature_decoder.hpp>
#include <steadyrest/motion/online/edges/test/sampled.hpp>

namespace steadyrest::motion::online {
namespace {

using test::in_cell;
using test::Sample;

std::vector<EdgeEvent> decode(const std::vector<Sample>& samples, QuadratureDecoder& decoder) {
  std::vector<EdgeEvent> out;
  EdgeEvent event;
  for (const Sample& s : samples) {
    if (decoder.update(s.a, s.b, s.t, event)) {
      out.push_back(event);
    }
  }
  return out;
}

/// A walk over cells that stays in each cell for some samples, and its true passages.
struct Walk {
  std::vector<Sample> samples;
  std::vector<EdgeEvent> truth;
  std::int64_t cell = 0;
};

// Turns in 40 % of the steps: reversals on a line are the hard case.
Walk walk(std::mt19937_64& random, int steps, int least_hold, std::uint64_t t, int dt) {
  Walk out;
  std::uniform_int_distribution<int> hold(least_hold, least_hold + 5);
  std::uniform_int_distribution<int> gap(1, dt);
  std::bernoulli_distribution turn(0.4);
  std::int8_t direction = 1;
  const std::uint64_t start = t;
  for (int i = 0; i <= steps; ++i) {
    if (i > 0) {
      direction = turn(random) ? static_cast<std::int8_t>(-direction) : direction;
      t += static_cast<std::uint64_t>(gap(random));
      out.cell += direction;
      EdgeEvent edge;
      edge.line = direction > 0 ? out.cell : out.cell + 1;
      edge.direction = direction;
      edge.ticks = t - start;
      out.truth.push_back(edge);
    }
    out.samples.push_back(in_cell(out.cell, t));
    for (int k = hold(random); k > 1; --k) {
      t += static_cast<std::uint64_t>(gap(random));
      out.samples.push_back(in_cell(out.cell, t));
    }
  }
  return out;
}

void expect_same(const std::vector<EdgeEvent>& seen, const std::vector<EdgeEvent>& truth,
                 std::uint64_t zero) {
  RC_ASSERT(seen.size() == truth.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    RC_ASSERT(seen[i].line == truth[i].line);
    RC_ASSERT(seen[i].direction == truth[i].direction);
    RC_ASSERT(seen[i].ticks - zero == truth[i].ticks);
    RC_ASSERT(seen[i].lost == 0U);
    RC_ASSERT(seen[i].uncertain == 0U);
  }
}

TEST(QuadratureDecoder, TurningOnALineNamesThatLineTwice) {
  QuadratureDecoder decoder;
  const auto events = decode({in_cell(0, 0), in_cell(1, 1), in_cell(2, 2), in_cell(1, 3),
                              in_cell(0, 4), in_cell(-1, 5), in_cell(0, 6)},
                             decoder);
  ASSERT_EQ(events.size(), 6U);
  const std::array<std::int64_t, 6> lines{1, 2, 2, 1, 0, 0};
  const std::array<int, 6> directions{1, 1, -1, -1, -1, 1};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(events[i].line, lines[i]) << i;
    EXPECT_EQ(events[i].direction, directions[i]) << i;
    EXPECT_EQ(events[i].ticks, i + 1) << i;
  }
}

// The truth is the walk. Clocks wrap within it.
RC_GTEST_PROP(QuadratureDecoder, EveryEdgeOfAWalkComesOutWhereverTheClockWraps, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const unsigned bits = *rc::gen::element(8U, 16U, 24U, 32U, 63U, 64U);
  std::mt19937_64 random(seed);
  // The walk begins shortly before a wrap.
  const std::uint64_t start = ~std::uint64_t{0} - random() % 100;
  Walk w = walk(random, 300, 1, start, 7);
  for (Sample& s : w.samples) {
    s.t &= ~std::uint64_t{0} >> (64U - bits);
  }
  QuadratureDecoder decoder({.clock_bits = bits});
  const auto events = decode(w.samples, decoder);
  expect_same(events, w.truth, w.samples.front().t);
  RC_ASSERT(decoder.count() == w.cell);
}

// Pulses shorter than the filter, away from edges, must leave the very same events.
RC_GTEST_PROP(QuadratureDecoder, GlitchesShorterThanTheFilterChangeNothing, ()) {
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  const auto hold = *rc::gen::inRange<std::uint16_t>(2, 9);
  // Every cell lasts long enough for a glitch and settling.
  Walk w = walk(random, 200, 3 * hold, 0, 5);
  const std::vector<Sample> clean = w.samples;
  std::uniform_int_distribution<int> length(1, hold - 1);
  for (std::size_t i = hold; i + 2 * hold < w.samples.size();) {
    const auto n = static_cast<std::size_t>(length(random));
    const bool on_a = (random() & 1U) != 0;
    bool still = true;  // no edge within the filter's reach
    for (std::size_t k = i - hold; k < i + n + hold; ++k) {
      still = still && clean[k].a == clean[i].a && clean[k].b == clean[i].b;
    }
    for (std::size_t k = i; still && k < i + n; ++k) {
      bool& level = on_a ? w.samples[k].a : w.samples[k].b;
      level = !level;
    }
    i += n + hold + random() % 40;
  }
  QuadratureDecoder decoder({.hold_samples = hold});
  expect_same(decode(w.samples, decoder), w.truth, 0);
  RC_ASSERT(decoder.state().glitches > 0U);
}

/// The levels after the filter by definition: the last level that lasted n samples.
std::vector<bool> filtered(const std::vector<bool>& raw, std::size_t n) {
  std::vector<bool> out(raw.size(), raw[0]);
  for (std::size_t i = 1; i < raw.size(); ++i) {
    out[i] = out[i - 1];
    if (i + 1 >= n) {
      bool held = true;
      for (std::size_t k = i + 1 - n; k <= i; ++k) {
        held = held && raw[k] == raw[i];
      }
      out[i] = held ? raw[i] : out[i - 1];
    }
  }
  return out;
}

// The oracle is the textbook's table of sixteen transitions, on levels filtered by definition.
// Levels here are arbitrary, illegal transitions included.
RC_GTEST_PROP(QuadratureDecoder, AgreesWithTheTableOfSixteenOnAnyLevels, ()) {
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  const auto hold = *rc::gen::inRange<std::uint16_t>(1, 5);
  std::vector<bool> a(400);
  std::vector<bool> b(400);
  std::bernoulli_distribution flip(0.3);
  for (std::size_t i = 1; i < a.size(); ++i) {
    a[i] = a[i - 1] != flip(random);
    b[i] = b[i - 1] != flip(random);
  }
  const std::vector<bool> fa = filtered(a, hold);
  const std::vector<bool> fb = filtered(b, hold);
  // Rows: old AB, columns: new AB, as 00 01 10 11; 2 = illegal. A leads upwards.
  constexpr std::array<std::array<int, 4>, 4> kTable{
      {{0, -1, 1, 2}, {1, 0, 2, -1}, {-1, 2, 0, 1}, {2, 1, -1, 0}}};
  QuadratureDecoder decoder({.hold_samples = hold});
  EdgeEvent event;
  decoder.update(a[0], b[0], 0, event);
  std::int64_t count = 0;
  int last = 1;
  std::uint32_t illegal = 0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    const bool edge = decoder.update(a[i], b[i], i, event);
    const auto index = [&](std::size_t k) { return (fa[k] ? 2U : 0U) + (fb[k] ? 1U : 0U); };
    const int step = kTable.at(index(i - 1)).at(index(i));
    RC_ASSERT(edge == (step != 0));
    if (step == 0) {
      continue;
    }
    illegal += step == 2 ? 1U : 0U;
    last = step == 2 ? last : step;
    count += step == 2 ? 2 * last : step;
    RC_ASSERT(decoder.count() == count);
    RC_ASSERT(event.lost == (step == 2 ? 1U : 0U));
    RC_ASSERT((event.uncertain == kLineGuessed) == (step == 2));
    RC_ASSERT(event.line == (last > 0 ? count : count + 1));
    RC_ASSERT(event.ticks == i + 1 - hold);
  }
  RC_ASSERT(decoder.state().illegal == illegal);
}

// Two levels at once: the direction of the last edge is the best guess, and marked.
TEST(QuadratureDecoder, AnIllegalTransitionGoesOnInTheLastDirection) {
  for (const int sign : {1, -1}) {
    QuadratureDecoder decoder;
    // One edge at a time, then two at once, then one.
    const auto events = decode(
        {in_cell(0, 0), in_cell(sign, 1), in_cell(3 * sign, 2), in_cell(4 * sign, 3)}, decoder);
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[1].lost, 1U);
    EXPECT_EQ(events[1].uncertain, kLineGuessed);
    EXPECT_EQ(events[1].line, sign > 0 ? 3 : -2);
    EXPECT_EQ(events[2].line, sign > 0 ? 4 : -3);
    EXPECT_EQ(events[2].uncertain, 0);
    EXPECT_EQ(decoder.count(), 4 * sign);
    EXPECT_EQ(decoder.state().illegal, 1U);
  }
}

// Half a million edges over one line.
TEST(QuadratureDecoder, AMillionSamplesOfDitherDoNotMoveTheCount) {
  QuadratureDecoder decoder({.clock_bits = 16});
  EdgeEvent event;
  std::mt19937_64 random(7);
  std::int64_t cell = 100;
  std::int64_t edges = 0;
  for (std::uint64_t i = 0; i < 1'000'000; ++i) {
    cell = (random() & 1U) != 0 ? 100 : 99;  // about line 100
    const Sample s = in_cell(cell, (i * 3) & 0xFFFFU);
    if (decoder.update(s.a, s.b, s.t, event)) {
      ++edges;
      // The decoder's zero is its first cell: 100 or 99.
      ASSERT_LE(std::abs(decoder.count()), 1);
      ASSERT_EQ(event.line,
                edges == 1 ? event.line : decoder.state().count + (event.direction > 0 ? 0 : 1));
    }
  }
  EXPECT_GT(edges, 490'000);
  EXPECT_EQ(decoder.state().illegal, 0U);
  EXPECT_EQ(decoder.ticks(), 3U * 999'999U);
}

TEST(QuadratureDecoder, ReversedWiringCountsTheOtherWay) {
  QuadratureDecoder decoder({.reversed = true});
  const auto events = decode({in_cell(0, 0), in_cell(1, 1), in_cell(2, 2)}, decoder);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1].direction, -1);
  EXPECT_EQ(events[1].line, -1);
  EXPECT_EQ(decoder.count(), -2);
}

}  // namespace
}  // namespace steadyrest::motion::online
