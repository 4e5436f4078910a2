// SPDX-License-Identifier: Apache-2.0
// The link is lost in the cut, for less and for more than the machine's watchdog waits (0.2 s).
#include <cmath>

#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;
using Link = Stage::Link;

constexpr std::size_t kLost = 1000;

void lose(Stage& stage, std::size_t cycles, Link how) {
  stage.link = [cycles, how](std::size_t cycle) {
    return cycle >= kLost && cycle < kLost + cycles ? how : Link::good;
  };
  stage.run(2000);
}

std::size_t first_written(const Stage& stage, std::size_t from) {
  while (!stage.log()[from].written) {
    ++from;
  }
  return from;
}

TEST(LinkLost, AShortLossGoesOnWhereItWas) {
  for (const Link how : {Link::no_read, Link::no_write}) {
    Stage stage;
    lose(stage, 30, how);
    EXPECT_EQ(stage.figures().port_faults, 30U);
    const std::size_t first = first_written(stage, kLost + 30);
    EXPECT_LE(first, kLost + 32) << "the stamps tell the gap";
    EXPECT_TRUE(stage.log()[first].masks());
    EXPECT_NEAR(stage.log()[first].feed_ratio(), stage.log()[kLost - 1].feed_ratio(), 0.11);
    EXPECT_NE(stage.log()[first].written->offset_mm[2], 0.0);
  }
}

TEST(LinkLost, AfterALongLossItBeginsAtThePanelAndAtOffsetZero) {
  for (const Link how : {Link::no_read, Link::no_write}) {
    Stage stage;
    lose(stage, 100, how);
    const auto& log = stage.log();
    const std::size_t first = first_written(stage, kLost + 100);
    EXPECT_LE(first, kLost + 103) << "the stamps tell the gap";
    EXPECT_FALSE(log[first].masks());
    EXPECT_LT(std::abs(log[first].written->offset_mm[2]), 0.0005);
    EXPECT_LT(log[1999].feed_ratio(), 0.6) << "it corrects again";
  }
}

TEST(LinkLost, TheStatusSaysSoAndWhatIsStillInForce) {
  Stage stage;
  lose(stage, 30, Link::no_read);
  const auto& before = stage.log()[kLost - 1].status;
  const auto& lost = stage.log()[kLost + 10].status;
  EXPECT_TRUE(lost.port_fault);
  EXPECT_STREQ(lost.port_words.data(), "the link is lost");
  EXPECT_EQ(lost.reasons[0], Reason::heartbeat_lost);
  EXPECT_EQ(lost.offset_mm, before.offset_mm) << "the machine still has it";
  EXPECT_EQ(lost.cycles, before.cycles + 11);
  EXPECT_FALSE(stage.log()[kLost + 31].status.port_fault);
  EXPECT_EQ(stage.named(Reason::heartbeat_lost, 0, 2000), 31U) << "one more to tell the gap";
}

}  // namespace
}  // namespace steadyrest::scenarios
