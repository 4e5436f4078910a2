// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/motion/online/edges/edge_stream.hpp>

namespace steadyrest::motion::online {
namespace {

EdgeEvent event_at(std::int64_t line, std::uint64_t ticks, std::uint8_t uncertain = 0,
                   std::uint32_t lost = 0) {
  EdgeEvent out;
  out.line = line;
  out.ticks = ticks;
  out.lost = lost;
  out.uncertain = uncertain;
  return out;
}

// Nanoseconds since 1970 as a double resolve 0.2 µs: the zero must be subtracted as integers.
TEST(EdgeStream, KeepsTheClocksResolutionHalfACenturyAfterItsZero) {
  auto stream = EdgeStream::make({.count_mm = 0.001, .clock_hz = 1e9}).value();
  constexpr std::uint64_t kNow = 1'760'000'000'000'000'000;
  EXPECT_EQ(stream.tick(kNow, 3).t_s, 0.0);
  EXPECT_EQ(stream.edge(event_at(4, kNow + 1))->t_s, 1e-9);
  EXPECT_EQ(stream.edge(event_at(4, kNow - 5))->t_s, -5e-9);
}

TEST(EdgeStream, PutsTheLineErrorsOnEdgesAndOnBothEndsOfTheCell) {
  constexpr std::array kErrors{1e-5, -2e-5, 3e-5, 0.0};
  auto line = EdgeStream::make({.line_error_mm = kErrors, .first_line = -2}).value();
  const Tick tick = line.tick(0, -1);
  EXPECT_DOUBLE_EQ(tick.low_mm, -0.001 - 2e-5);
  EXPECT_DOUBLE_EQ(tick.high_mm, 3e-5);
  EXPECT_DOUBLE_EQ(line.edge(event_at(-2, 0))->position_mm, -0.002 + 1e-5);
  EXPECT_DOUBLE_EQ(line.line_mm(2), 0.002);
  EXPECT_DOUBLE_EQ(line.line_mm(-3), -0.003);
  const auto turn =
      EdgeStream::make({.line_error_mm = kErrors, .first_line = -2, .periodic = true}).value();
  EXPECT_DOUBLE_EQ(turn.line_mm(2), 0.002 + 1e-5);
  EXPECT_DOUBLE_EQ(turn.line_mm(-5), -0.005 - 2e-5);
}

TEST(EdgeStream, WhatIsNotCertainBecomesALossOfTheNextEdge) {
  auto stream = EdgeStream::make({}).value();
  const kernel::rt::testing::AllocationGuard guard;
  EXPECT_EQ(stream.edge(event_at(1, 10))->lost, 0);
  EXPECT_FALSE(stream.edge(event_at(2, 20, kTimeUnknown, 3)));
  EXPECT_FALSE(stream.edge(event_at(2, 30, kLineGuessed, 1)));
  EXPECT_EQ(stream.edge(event_at(3, 40))->lost, 6);
  EXPECT_EQ(stream.edge(event_at(4, 50))->lost, 0);
  EXPECT_EQ(stream.edge(event_at(5, 60, 0, 4000))->lost, 255);
  auto trusting = EdgeStream::make({.take_guesses = true}).value();
  EXPECT_TRUE(trusting.edge(event_at(2, 30, kLineGuessed, 1)));
  EXPECT_FALSE(trusting.edge(event_at(2, 30, kLineGuessed | kTimeUnknown, 1)));
}

TEST(EdgeStream, RefusesWhatIsNoEncoder) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr std::array kBroken{0.0, kNan};
  constexpr std::array kFar{0.0, 0.2};
  EXPECT_FALSE(EdgeStream::make({.count_mm = 0.0}));
  EXPECT_FALSE(EdgeStream::make({.count_mm = kNan}));
  EXPECT_FALSE(EdgeStream::make({.clock_hz = -1.0}));
  EXPECT_FALSE(EdgeStream::make({.line_error_mm = kBroken}));
  EXPECT_FALSE(EdgeStream::make({.line_error_mm = kFar}));
  EXPECT_FALSE(EdgeStream::make({.periodic = true}));
}

}  // namespace
}  // namespace steadyrest::motion::online
