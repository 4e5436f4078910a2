// SPDX-License-Identifier: Apache-2.0
// A channel whose word is not latched: it walks from neighbour to neighbour, one per scan, and the
// envelope must wait for it.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/test/cycle.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using test::kCycle_s;

/// 1 … 10 % by 1 %, then 20 … 100 % by 10 %: one fine end and one coarse, as on real switches.
machine::OverrideTable fine_and_coarse() {
  machine::OverrideTable table;
  for (int percent = 1; percent <= 10; ++percent) {
    table.ratio.push_back(percent / 100.0);
  }
  for (int percent = 20; percent <= 100; percent += 10) {
    table.ratio.push_back(percent / 100.0);
  }
  table.scan_period_s = 0.01;
  return table;
}

struct Walker {
  explicit Walker(const Channel::Config& config) : channel(Channel::make(config).value()) {}
  Channel::Output cycle() { return channel.update(input); }
  Channel::Output cycles(int count) {
    Channel::Output out;
    for (int i = 0; i < count; ++i) {
      out = cycle();
    }
    return out;
  }
  void wish(double ratio) {
    input.ratio = ratio;
    input.reason = Reason::contour_limit;
  }
  void no_wish() {
    input.ratio = 1.0;
    input.reason = Reason::none;
  }

  Channel channel;
  RatioEnvelope::Input input{.step_s = kCycle_s};
};

// Ten fine steps take 0.1 s, in which a rise of 5 1/s would reach 50 %. With the envelope that far
// ahead, the word would then chase it by a coarse step per scan, 10 1/s.
TEST(ChannelWalk, TheSlewWaitsForTheWordOnItsFineSteps) {
  Walker walker({.table = fine_and_coarse(), .rise_1_s = 5.0, .latched = false});
  walker.wish(0.01);
  ASSERT_EQ(walker.cycles(1000).ratio, 0.01);
  walker.wish(1.0);
  std::vector<double> in_force;
  for (int i = 0; i < 500; ++i) {
    in_force.push_back(walker.cycle().ratio);
  }
  ASSERT_EQ(in_force.back(), 1.0);
  constexpr double kCoarse = 0.1;
  for (std::size_t from = 0; from < in_force.size(); from += 5) {
    for (std::size_t to = from; to < in_force.size(); to += 5) {
      const double passed_s = kCycle_s * static_cast<double>(to - from);
      ASSERT_LE(in_force[to] - in_force[from], 5.0 * passed_s + kCoarse + 1e-9)
          << from << "…" << to;
    }
  }
}

// Down to 1 % the word needs 18 scans; the envelope alone would need 99 ms. From any place on its
// way a new wish for more turns it round at once.
TEST(ChannelWalk, AWishForMoreTurnsTheWordRoundWithoutFallingFurther) {
  for (const int fallen : {30, 60, 120, 170}) {
    Walker walker({.table = fine_and_coarse(), .rise_1_s = 5.0, .latched = false});
    walker.wish(0.01);
    walker.cycles(fallen);
    const double before = walker.cycle().ratio;
    walker.wish(1.0);
    double lowest = before;
    for (int i = 0; i < 300; ++i) {
      lowest = std::min(lowest, walker.cycle().ratio);
    }
    const auto step_below = walker.channel.table().floor_step(before - 1e-6);
    const double one_less = step_below ? walker.channel.table().ratio(*step_below) : before;
    EXPECT_GE(lowest, one_less) << fallen << ": the step in hand and no more";
  }
}

// Not yet while the word is in use, nor while it settles; then for good.
TEST(ChannelHandedBack, IsSaidOnlyOnceNothingOfTheLayerIsLeft) {
  Walker walker({.table = fine_and_coarse(), .latched = false});
  EXPECT_FALSE(walker.cycles(5).handed_back) << "the first word has not held for a scan";
  EXPECT_TRUE(walker.cycles(10).handed_back);
  walker.wish(0.5);
  for (int i = 0; i < 400; ++i) {
    ASSERT_FALSE(walker.cycle().handed_back) << "cycle " << i << " of a wish";
  }
  walker.no_wish();
  int masked = 0;
  int waits = 0;
  Channel::Output out = walker.cycle();
  for (; !out.handed_back && masked + waits < 1000; out = walker.cycle()) {
    (out.masks_panel ? masked : waits) += 1;
  }
  EXPECT_GT(masked, 200) << "0.5 at 2 1/s";
  EXPECT_NEAR(waits, 10, 1) << "one scan after the mask";
  EXPECT_FALSE(out.masks_panel);
  EXPECT_TRUE(walker.cycles(100).handed_back);
}

// A latched word carries its mask: nothing has to settle.
TEST(ChannelHandedBack, IsSaidAtOnceOfALatchedWord) {
  Walker walker({.table = fine_and_coarse()});
  EXPECT_TRUE(walker.cycle().handed_back);
  walker.wish(0.5);
  EXPECT_FALSE(walker.cycles(2).handed_back);
  EXPECT_FALSE(walker.cycles(300).handed_back);
  walker.no_wish();
  Channel::Output out = walker.cycle();
  while (out.masks_panel) {
    ASSERT_FALSE(out.handed_back);
    out = walker.cycle();
  }
  EXPECT_TRUE(out.handed_back);
}

// Table, envelope and word each refuse with their own text.
TEST(ChannelConfig, EachPartsRefusalIsTheChannels) {
  const auto refused = [](const Channel::Config& config) {
    const auto made = Channel::make(config);
    return made ? "" : made.error().what;
  };
  machine::OverrideTable falling = fine_and_coarse();
  std::ranges::reverse(falling.ratio);
  EXPECT_NE(refused({.table = falling}).find("override step 1 has ratio"), std::string::npos);
  EXPECT_EQ(refused({.table = fine_and_coarse(), .fall_1_s = units::kNan}),
            "envelope: fall_1_s is nan; allowed: finite and > 0");
  EXPECT_NE(refused({.table = test::percent_word(), .latched = false}).find("differ in 2 bits"),
            std::string::npos);
  EXPECT_EQ(refused({.table = test::percent_word(), .latched = false, .available = false}), "")
      << "a word that is never written needs no walk";
}

// 70 % alone is allowed and is a step: no more is needed. 0.7 as 1 − 0.3 is the same 70 %.
TEST(ChannelConfig, AnEnvelopeOfOneStepIsEnough) {
  EXPECT_TRUE(Channel::make({.table = fine_and_coarse(), .min_ratio = 0.7, .max_ratio = 0.7}));
  EXPECT_TRUE(
      Channel::make({.table = fine_and_coarse(), .min_ratio = 1.0 - 0.3, .max_ratio = 1.0 - 0.3}));
  EXPECT_FALSE(Channel::make({.table = fine_and_coarse(), .min_ratio = 0.71, .max_ratio = 0.79}));
}

}  // namespace
}  // namespace steadyrest::kernel::override
