// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/adapters/opcua/order_watch.hpp>

namespace steadyrest::adapters::opcua {
namespace {

constexpr std::uint32_t kPeriod = 250;

std::uint32_t beat(std::uint32_t count) {
  return 1 + count % kPeriod;
}

// Orders get lost and come late, but never out of turn.
TEST(OrderWatch, OwnOrdersAreNeverTakenForOthers) {
  std::mt19937 dice(2);  // NOLINT(bugprone-random-generator-seed): the same cases each time
  OrderWatch watch(kPeriod);
  std::uint32_t taken = 0;
  for (std::uint32_t sent = 1; sent < 100000; ++sent) {
    watch.sent(beat(sent));
    if (dice() % 3 == 0 && sent > taken + dice() % 20) {
      taken += 1 + static_cast<std::uint32_t>(dice()) % (sent - taken);
    }
    watch.seen(dice() % 100 == 0 ? std::nan("") : static_cast<double>(beat(taken)));
    ASSERT_FALSE(watch.other()) << sent;
  }
}

TEST(OrderWatch, WhatWasThereBeforeTheFirstOrderSaysNothing) {
  OrderWatch watch(kPeriod);
  for (std::uint32_t i = 0; i < 100; ++i) {
    watch.seen(beat(100 + i));  // another layer's last orders
  }
  for (std::uint32_t sent = 7; sent < 200; ++sent) {
    watch.sent(beat(sent));
    watch.seen(sent < 20 ? beat(199) : beat(sent - 10));
  }
  EXPECT_FALSE(watch.other());
}

TEST(OrderWatch, AnotherLayersOrdersAreSeenWhateverItsCount) {
  for (const std::uint32_t ahead : {1U, 5U, 125U, 248U}) {
    OrderWatch watch(kPeriod);
    std::uint32_t cycles = 0;
    for (std::uint32_t sent = 1; sent < 100 && !watch.other(); ++sent, ++cycles) {
      watch.sent(beat(sent));
      watch.seen(beat(sent % 2 == 0 ? sent : sent + ahead));
    }
    EXPECT_TRUE(watch.other());
    EXPECT_LT(cycles, 12U) << ahead;
  }
}

// The control took none for so long that the heartbeats have gone round.
TEST(OrderWatch, AStallOfAnyLengthIsNobodyElse) {
  for (std::uint32_t stall = 1; stall < 3 * kPeriod; ++stall) {
    OrderWatch watch(kPeriod);
    std::uint32_t sent = 1;
    for (int cycle = 0; cycle < 40; ++cycle, ++sent) {
      watch.sent(beat(sent));
      watch.seen(beat(sent > 5 ? sent - 5 : 0));
    }
    const std::uint32_t taken = sent - 6;
    for (const std::uint32_t end = sent + stall; sent < end; ++sent) {
      watch.sent(beat(sent));
      watch.seen(beat(taken));
    }
    for (int cycle = 0; cycle < 40; ++cycle, ++sent) {
      watch.sent(beat(sent));
      watch.seen(beat(sent - 5));
      ASSERT_FALSE(watch.other()) << stall;
    }
  }
}

TEST(OrderWatch, AnOrderThatComesLateNowAndThenIsNobodyElse) {
  OrderWatch watch(kPeriod);
  for (std::uint32_t sent = 300; sent < 2000; ++sent) {
    watch.sent(beat(sent));
    watch.seen(beat(sent % 60 == 0 ? sent - 20 : sent - 1));
  }
  EXPECT_FALSE(watch.other());
}

TEST(OrderWatch, AfterAPauseItBeginsAnew) {
  OrderWatch watch(kPeriod);
  watch.sent(beat(7));
  for (int i = 0; i < 100; ++i) {
    watch.seen(beat(7));
  }
  // The layer's count goes on while it sends nothing.
  for (std::uint32_t sent = 240; sent < 400; ++sent) {
    watch.sent(beat(sent));
    watch.seen(beat(sent < 243 ? 7 : sent - 3));
    ASSERT_FALSE(watch.other()) << sent;
  }
}

TEST(OrderWatch, NumbersThatAreNoHeartbeatsAreSomebodyElses) {
  OrderWatch watch(kPeriod);
  for (const double number : {2.0, -1.0, 251.0, 1e300}) {
    watch.sent(2);
    watch.seen(number);
  }
  EXPECT_TRUE(watch.other());
}

TEST(OrderWatch, WhileNothingIsSentNothingIsJudged) {
  OrderWatch watch(kPeriod);
  watch.sent(1);
  for (std::uint32_t i = 0; i < 60; ++i) {
    watch.seen(1.0);
  }
  for (std::uint32_t i = 0; i < 60; ++i) {
    watch.seen(beat(100 + i));
  }
  EXPECT_FALSE(watch.other());
}

}  // namespace
}  // namespace steadyrest::adapters::opcua
