// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/motion/offline/log/edge_log.hpp>
#include <steadyrest/motion/offline/log/rollover.hpp>

namespace steadyrest::motion::offline {
namespace {

using testing::HasSubstr;

/// What a counter of so many bits shows.
std::int64_t shown(std::int64_t count, int bits, bool is_signed) {
  const std::int64_t turn = std::int64_t{1} << bits;
  const std::int64_t low = is_signed ? -turn / 2 : 0;
  return ((count - low) % turn + turn) % turn + low;
}

/// Rows of a motion there and back over several turns: 0.8 of a turn's eighth per row at most.
std::int64_t truth(int row, int bits) {
  const double turn = std::ldexp(1.0, bits);
  return std::llround(3.3 * turn * std::sin(0.004 * row));
}

TEST(Rollover, UnwrapsEveryCounterBothWays) {
  for (const int bits : {16, 24, 32}) {
    for (const bool is_signed : {false, true}) {
      Rollover counter;
      const std::int64_t first = shown(truth(0, bits), bits, is_signed);
      for (int row = 0; row < 3000; ++row) {
        const std::int64_t seen =
            counter.unwrapped(0.001 * row, shown(truth(row, bits), bits, is_signed));
        ASSERT_EQ(seen - first, truth(row, bits) - truth(0, bits)) << bits << is_signed << row;
      }
      EXPECT_EQ(counter.bits(), bits);
      EXPECT_GT(counter.times(), 12U);
    }
  }
}

// Edges step by one; the counter may roll over where the axis turns, and during a gap.
TEST(Rollover, UnwrapsEdgesAndGaps) {
  Rollover edges;
  EXPECT_EQ(edges.unwrapped(0.0, 65534), 65534);
  EXPECT_EQ(edges.unwrapped(0.1, 65535), 65535);
  EXPECT_EQ(edges.unwrapped(0.3, 0), 65536);
  EXPECT_EQ(edges.unwrapped(0.4, 65535), 65535);
  Rollover gap;
  EXPECT_EQ(gap.unwrapped(0.000, 64000), 64000);
  EXPECT_EQ(gap.unwrapped(0.001, 64500), 64500);
  EXPECT_EQ(gap.unwrapped(0.006, 1464), 67000);
}

TEST(Rollover, LeavesResetsAndLostBitsAlone) {
  const auto after = [](std::initializer_list<std::int64_t> counts) {
    Rollover counter;
    std::int64_t last = 0;
    double t_s = 0.0;
    for (const std::int64_t count : counts) {
      last = counter.unwrapped(t_s += 0.001, count);
    }
    EXPECT_EQ(counter.times(), 0U);
    return last;
  };
  EXPECT_EQ(after({60000, 60050, 0}), 0);               // reset; a rollover would be 5486
  EXPECT_EQ(after({1000, 1050, 1100 + 32768}), 33868);  // a bit of the cable
  EXPECT_EQ(after({4'000'000'000, 4'000'000'050, 0}), 0);
  EXPECT_EQ(after({100'000, 100'050, 100'100 - 65'536}),
            34'564);                                     // no counter of 16 bits has 100000
  EXPECT_EQ(after({-40'000, -40'050, 25'486}), 25'486);  // nor −40000
}

std::string log_of(int bits, bool is_signed) {
  std::string out = "t_s,count\n";
  for (int row = 0; row < 400; ++row) {
    const std::int64_t start = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 10'000;
    out += fmt::format("{:.3f},{}\n", 0.001 * row, shown(start + 50 * row, bits, is_signed));
  }
  return out;
}

TEST(EdgeLogRollover, IsSaidOnceAndGivesNoJump) {
  EdgeLogConfig config;
  config.max_step = 0;
  config.max_speed_counts_s = 100e3;
  for (const int bits : {16, 24, 32}) {
    for (const bool is_signed : {false, true}) {
      const auto log = parse_edge_log(log_of(bits, is_signed), "log", config);
      ASSERT_TRUE(log) << log.error().what;
      EXPECT_EQ(log->jumps, 0U);
      EXPECT_EQ(log->rollovers, 1U);
      EXPECT_EQ(log->counter_bits, bits);
      EXPECT_EQ(log->rows.back().count - log->rows.front().count, 50 * 399);
      ASSERT_EQ(log->findings.size(), 1U);
      EXPECT_EQ(log->findings[0].line, 202U);
      EXPECT_THAT(log->findings[0].what,
                  HasSubstr(fmt::format("the counter of {} bits rolls over here", bits)));
    }
  }
}

}  // namespace
}  // namespace steadyrest::motion::offline
