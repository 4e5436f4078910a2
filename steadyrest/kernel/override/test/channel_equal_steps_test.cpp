// SPDX-License-Identifier: Apache-2.0
// Neighbouring steps of one ratio are one step: a table that repeats values behaves to the cycle
// like the table without the repeats where the word is latched, and only waits longer where it
// walks.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/kernel/override/test/cycle.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/override/test/random_scene.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using test::kCycle_s;

/// Step i so often.
machine::OverrideTable repeating(const machine::OverrideTable& table,
                                 const std::vector<std::size_t>& times) {
  machine::OverrideTable out = table;
  out.ratio.clear();
  for (std::size_t i = 0; i < table.ratio.size(); ++i) {
    out.ratio.insert(out.ratio.end(), times[i % times.size()], table.ratio[i]);
  }
  return out;
}

// The reference is the same channel on the table without the repeats.
RC_GTEST_PROP(EqualSteps, OfALatchedWordChangeNothingInForce, (bool may_exceed)) {
  test::Scene scene = test::random_scene(may_exceed);
  scene.config.table = *rc::gen::element(test::feed_840d(), test::spindle_840d());
  scene.config.table.layer_may_exceed_panel = may_exceed;
  scene.config.latched = true;
  auto plain = Channel::make(scene.config);
  const auto times =
      *rc::gen::container<std::vector<std::size_t>>(7, rc::gen::inRange<std::size_t>(1, 5));
  scene.config.table = repeating(scene.config.table, times);
  auto repeated = Channel::make(scene.config);
  RC_PRE(plain.has_value());
  RC_ASSERT(repeated.has_value());
  for (const auto& input : scene.inputs) {
    const auto one = plain->update(input);
    const auto other = repeated->update(input);
    RC_ASSERT(one.ratio == other.ratio);
    RC_ASSERT(one.masks_panel == other.masks_panel);
    RC_ASSERT(one.handed_back == other.handed_back);
    RC_ASSERT(one.reason == other.reason);
    RC_ASSERT(plain->in_force().ratio == repeated->in_force().ratio);
  }
}

struct Way {
  std::string name;
  std::vector<std::size_t> times;
  bool latched = true;
};

class EqualStepsWay : public ::testing::TestWithParam<Way> {};

// Down from 80 % to 10 % and back to the panel, by the slew both ways, at each repeated step.
TEST_P(EqualStepsWay, FallsAndRisesByTheSlewAndHandsBack) {
  auto table = repeating(test::feed_840d(), GetParam().times);
  table.scan_period_s = kCycle_s;
  auto channel =
      Channel::make(
          {.table = table, .fall_1_s = 0.5, .rise_1_s = 0.25, .latched = GetParam().latched})
          .value();
  RatioEnvelope::Input input{.step_s = kCycle_s,
                             .ratio = 0.1,
                             .reason = Reason::contour_limit,
                             .panel = {.panel_ratio = 0.8, .panel_code_known = true}};
  // Every step of the wires takes a cycle, and the mask one.
  const double walk_s = static_cast<double>(table.ratio.size() + 2) * kCycle_s;
  double fallen_s = 0.0;
  for (double t_s = 0.0; t_s < 4.0; t_s += kCycle_s) {
    const auto out = channel.update(input);
    ASSERT_GE(out.ratio, 0.8 - 0.5 * t_s - 0.1 - 1e-9) << t_s;  // one step of the table, 10 %
    fallen_s = out.ratio > 0.1 + 1e-9 ? t_s : fallen_s;
  }
  EXPECT_GT(fallen_s, (0.8 - 0.2) / 0.5 - kCycle_s);
  EXPECT_LT(fallen_s, (0.8 - 0.1) / 0.5 + walk_s);
  input.ratio = 1.0;
  input.reason = Reason::none;
  double back_s = 0.0;
  Channel::Output out;
  for (double t_s = 0.0; t_s < 5.0; t_s += kCycle_s) {
    out = channel.update(input);
    ASSERT_LE(out.ratio, 0.1 + 0.25 * t_s + 0.1 + 1e-9) << t_s;
    back_s = out.handed_back ? back_s : t_s;
  }
  EXPECT_TRUE(out.handed_back);
  EXPECT_EQ(out.ratio, 0.8);
  EXPECT_LT(back_s, (0.8 - 0.1) / 0.25 + walk_s + 2.0 * kCycle_s);
}

INSTANTIATE_TEST_SUITE_P(Tables, EqualStepsWay,
                         ::testing::Values(Way{"EachTwice", {2}},
                                           Way{"EachTwiceWalked", {2}, false},
                                           Way{"EachElevenTimes", {11}},
                                           Way{"EachElevenTimesWalked", {11}, false},
                                           Way{"HereAndThere", {1, 1, 3, 1, 2}},
                                           Way{"HereAndThereWalked", {1, 4, 1}, false}),
                         [](const auto& way) { return way.param.name; });

// What the control clips repeats too: above 50 % there is one step.
TEST(EqualSteps, ByTheControlsClipAreOneStep) {
  auto table = test::feed_840d();
  table.max_ratio = 0.5;
  auto channel = Channel::make({.table = table, .latched = true}).value();
  RatioEnvelope::Input input{.step_s = kCycle_s,
                             .ratio = 0.3,
                             .reason = Reason::contour_limit,
                             .panel = {.panel_ratio = 0.5, .panel_code_known = true}};
  Channel::Output out;
  for (int i = 0; i < 1000; ++i) {
    out = channel.update(input);
  }
  ASSERT_NEAR(out.ratio, 0.3, 1e-12);
  input.ratio = 1.0;
  input.reason = Reason::none;
  for (int i = 0; i < 1000; ++i) {
    out = channel.update(input);
  }
  EXPECT_TRUE(out.handed_back);
  EXPECT_EQ(out.ratio, 0.5);
}

// A walk that has come down to the upper of two equal steps stays there: the other is the same.
TEST(EqualSteps, AreNotWalkedThroughForNothing) {
  machine::OverrideTable table;
  table.ratio = {0.0, 0.5, 0.5, 0.5, 0.5, 1.0};
  table.scan_period_s = 0.01;
  auto channel =
      Channel::make({.table = table, .fall_1_s = 100.0, .rise_1_s = 100.0, .latched = false})
          .value();
  RatioEnvelope::Input input{.step_s = kCycle_s,
                             .ratio = 0.5,
                             .reason = Reason::contour_limit,
                             .panel = {.panel_ratio = 1.0, .panel_code_known = true}};
  std::vector<std::uint32_t> codes;
  for (int i = 0; i < 500; ++i) {
    const auto out = channel.update(input);
    if (out.masks_panel && (codes.empty() || codes.back() != out.code)) {
      codes.push_back(out.code);
    }
  }
  EXPECT_EQ(codes, (std::vector<std::uint32_t>{sinumerik_code(5), sinumerik_code(4)}));
}

}  // namespace
}  // namespace steadyrest::kernel::override
