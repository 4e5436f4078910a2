// SPDX-License-Identifier: Apache-2.0
// One property for each sentence on safety that the override alone can break. All run the same
// random histories of wishes, panel, faults and cycle times through envelope and hand-over.
#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using units::kInfinity;
using units::kNan;

constexpr double kTolerance = 1e-8;

struct Scene {
  Channel::Config config;
  std::vector<RatioEnvelope::Input> inputs;
};

// One wish in eight is no ratio at all.
double random_wish() {
  if (*rc::gen::inRange(0, 8) == 0) {
    return *rc::gen::element(kNan, kInfinity, -kInfinity, -1.0, 1e300);
  }
  return *rc::gen::inRange(0, 1500) / 1000.0;
}

// Published tables, coded in Gray, walked or latched; a binary percent word only latched, since
// make() refuses it otherwise.
Channel::Config random_config(bool may_exceed) {
  Channel::Config config;
  const bool binary = *rc::gen::inRange(0, 4) == 0;
  config.table = binary
                     ? test::percent_word()
                     : *rc::gen::element(test::feed_840d(), test::spindle_840d(), test::feed_dmg());
  config.table.layer_may_exceed_panel = may_exceed;
  config.latched = binary || *rc::gen::arbitrary<bool>();
  config.min_ratio = *rc::gen::inRange(0, 60) / 100.0;
  config.max_ratio = *rc::gen::inRange(60, 150) / 100.0;
  config.fall_1_s = *rc::gen::inRange(1, 20);
  config.rise_1_s = *rc::gen::inRange(1, 10);
  return config;
}

// A dozen spells of up to 120 cycles, each with a wish, faults, holds and panels that lie on and
// between the table's steps; now and then a cycle whose time is wrong.
Scene random_scene(bool may_exceed = false) {
  Scene scene{.config = random_config(may_exceed), .inputs = {}};
  const auto& ratio = scene.config.table.ratio;
  const double cycle_s = *rc::gen::inRange(1, 20) / 1000.0;
  const int acts = *rc::gen::inRange(1, 12);
  RatioEnvelope::Input input;
  for (int act = 0; act < acts; ++act) {
    input.ratio = random_wish();
    input.reason = *rc::gen::element(Reason::contour_limit, Reason::contour_objective, Reason::none,
                                     Reason::not_cutting);
    input.unfit = *rc::gen::inRange(0, 6) == 0 ? Reason::input_stale : Reason::none;
    input.hold = *rc::gen::inRange(0, 8) == 0;
    if (*rc::gen::inRange(0, 2) == 0) {
      input.panel.panel_ratio = *rc::gen::elementOf(ratio);
    }
    if (*rc::gen::inRange(0, 12) == 0) {
      input.panel.panel_ratio = *rc::gen::inRange(0, 130) / 100.0;
    }
    if (*rc::gen::inRange(0, 10) == 0) {
      input.panel.panel_ratio = 0.0;
    }
    input.panel.panel_code_known = *rc::gen::inRange(0, 10) != 0;
    input.panel.panel_code = input.panel.panel_code_known ? 1U : 0xFFFFU;
    const int cycles = *rc::gen::inRange(1, 120);
    for (int i = 0; i < cycles; ++i) {
      input.step_s = cycle_s;
      scene.inputs.push_back(input);
    }
    if (*rc::gen::inRange(0, 6) == 0) {
      scene.inputs.back().step_s = *rc::gen::element(5.0, 0.0, -1.0, kNan, kInfinity);
    }
  }
  return scene;
}

/// What the machine has on its input after a cycle.
struct Word {
  std::uint32_t code = 0;
  bool masks = false;
};

/// Ratio in force for a word; nothing when the machine could not decode it.
/// The machine's side, decoded independently of the channel.
std::optional<double> in_force(const Table& table, const Word& word, double panel) {
  if (!word.masks) {
    return panel;
  }
  const auto step = table.step_of_code(word.code);
  return step ? std::optional(table.ratio(*step)) : std::nullopt;
}

/// Calls check(input, output, before, now) for each cycle: ratios in force with the panel of this
/// cycle, by the word of the last cycle and by the word of this one.
template <class Check>
void play(const Scene& scene, Check&& check) {
  auto channel = Channel::make(scene.config);
  RC_PRE(channel.has_value());
  Word word;
  double panel = 1.0;
  for (const auto& input : scene.inputs) {
    const auto output = channel->update(input);
    if (input.panel.panel_code_known) {
      panel = input.panel.panel_ratio;
    }
    const Word next{.code = output.code, .masks = output.masks_panel};
    const auto before = in_force(channel->table(), word, panel);
    const auto now = in_force(channel->table(), next, panel);
    RC_ASSERT(before.has_value());
    RC_ASSERT(now.has_value());
    RC_ASSERT(std::abs(*now - output.ratio) < kTolerance);
    check(*channel, input, output, word, next, *before, *now, panel);
    word = next;
  }
}

double widest_step(const Table& table) {
  double widest = 0.0;
  for (std::size_t step = 1; step < table.steps(); ++step) {
    widest = std::max(widest, table.ratio(step) - table.ratio(step - 1));
  }
  return widest;
}

RC_GTEST_PROP(Safety, TheOperatorWinsInForceIsNeverAboveThePanel, ()) {
  play(random_scene(), [](auto&, auto&, auto&, auto&, auto&, double, double now, double panel) {
    RC_ASSERT(now <= panel + kTolerance);
  });
}

RC_GTEST_PROP(Safety, PanelZeroAlwaysStops, (bool may_exceed)) {
  play(random_scene(may_exceed),
       [](auto&, auto&, auto& output, auto&, auto&, double, double now, double panel) {
         if (panel == 0.0) {
           RC_ASSERT(now == 0.0);
           RC_ASSERT(!output.masks_panel);
         }
       });
}

RC_GTEST_PROP(Safety, TheLayerNeverRaisesTheFeedByAJump, (bool may_exceed)) {
  // Bound: from every instant on, what is in force rises by no more than rise·t and one step of the
  // table, unless it is the operator who turns his switch up while no mask is on. Up to a panel
  // beyond the table's last step the mask can only come off at that step.
  const Scene scene = random_scene(may_exceed);
  double bound = kInfinity;
  play(scene, [&](auto& channel, auto& input, auto&, auto&, auto&, double before, double now,
                  double panel) {
    const double passed_s =
        std::isfinite(input.step_s) ? std::clamp(input.step_s, 0.0, scene.config.max_step_s) : 0.0;
    const double step = std::max(widest_step(channel.table()),
                                 panel - channel.table().ratio(channel.table().steps() - 1)) +
                        kTolerance;
    // `before` has the last word with this cycle's panel: a rise up to there is the
    // operator's.
    bound = std::max(bound, before + step) + scene.config.rise_1_s * passed_s;
    RC_ASSERT(now <= bound);
    RC_ASSERT(now <= before + step + scene.config.rise_1_s * passed_s);
    bound = std::min(bound, now + step);
  });
}

// Latched, so that no walk delays the word: rounding down alone must keep it below the slew.
RC_GTEST_PROP(Safety, QuantisedDownNeverAboveWhatTheSlewAllows, ()) {
  Scene scene = random_scene();
  scene.config.latched = true;
  play(scene, [](auto& channel, auto&, auto& output, auto&, auto&, double, double now, double) {
    const double slewed = channel.state().envelope.ratio;
    if (output.masks_panel && slewed >= channel.table().min_ratio()) {
      RC_ASSERT(now <= slewed + kTolerance);
    }
  });
}

/// The last input for long enough that the slowest way ends: the whole range at 1 1/s, 31 steps of
/// a scan each, a scan for the mask.
void settle(Scene& scene, RatioEnvelope::Input input) {
  input.hold = false;
  input.panel.panel_code_known = true;
  input.step_s = 0.002;
  for (double waited_s = 0.0; waited_s < 3.0; waited_s += 0.002) {
    scene.inputs.push_back(input);
  }
}

// Long enough after the last change the wish must be in force within all limits: between the
// lowest step that min_ratio allows and max_ratio, under the panel if it rules.
RC_GTEST_PROP(Safety, WhateverIsWishedEndsInsideTheEnvelope, (bool may_exceed)) {
  Scene scene = random_scene(may_exceed);
  auto input = scene.inputs.back();
  input.unfit = Reason::none;
  input.ratio = *rc::gen::inRange(0, 9000) / 1000.0;
  input.reason = Reason::contour_limit;
  settle(scene, input);
  double in_force_ratio = 0.0;
  double last_panel = 0.0;
  const Table table = Table::make(scene.config.table).value();
  play(scene, [&](auto&, auto&, auto&, auto&, auto&, double, double now, double panel) {
    in_force_ratio = now;
    last_panel = panel;
  });
  const double lowest = table.ratio(*table.ceil_step(scene.config.min_ratio));
  RC_ASSERT(in_force_ratio <= std::max(scene.config.max_ratio, last_panel) + kTolerance);
  if (may_exceed && last_panel > 0.0 && last_panel >= table.min_ratio()) {
    RC_ASSERT(in_force_ratio <= scene.config.max_ratio + kTolerance);
    RC_ASSERT(in_force_ratio >= lowest - kTolerance);
  } else if (!may_exceed) {
    RC_ASSERT(in_force_ratio <= std::min(scene.config.max_ratio, last_panel) + kTolerance);
    RC_ASSERT(in_force_ratio >= std::min(lowest, last_panel) - widest_step(table));
  }
}

// All words that bits in any order can show, with the old and the new mask: part runs through the
// subsets of the differing bits, (part − 1) & differing.
RC_GTEST_PROP(Safety, NoIntermediateWordDecodesOutsideOfFromAndTo, (bool may_exceed)) {
  Scene scene = random_scene(may_exceed);
  play(scene, [&](auto& channel, auto& input, auto&, const Word& from, const Word& to,
                  double before, double now, double panel) {
    if (scene.config.latched || !input.panel.panel_code_known) {
      return;
    }
    const auto [low, high] = std::minmax({before, now});
    const std::uint32_t differing = from.code ^ to.code;
    for (std::uint32_t part = differing;; part = (part - 1) & differing) {
      for (const bool mask : {from.masks, to.masks}) {
        const auto seen =
            in_force(channel.table(), {.code = from.code ^ part, .masks = mask}, panel);
        RC_ASSERT(seen.has_value());
        RC_ASSERT(*seen >= low - kTolerance);
        RC_ASSERT(*seen <= high + kTolerance);
      }
      if (part == 0) {
        break;
      }
    }
  });
}

// An unknown panel code may mean a broken cable: no new mask on it, and the reason says so.
RC_GTEST_PROP(Safety, AnUnknownPanelCodeIsNeverMaskedAnew, (bool may_exceed)) {
  play(random_scene(may_exceed),
       [](auto&, auto& input, auto& output, const Word& from, auto&, double, double, double) {
         if (!input.panel.panel_code_known) {
           RC_ASSERT(!output.masks_panel || from.masks);
           RC_ASSERT(output.reason == Reason::unknown_override_code ||
                     input.unfit != Reason::none || !std::isfinite(input.step_s));
         }
       });
}

RC_GTEST_PROP(Safety, UnfitInputEndsWithThePanelHandedBack, (bool may_exceed)) {
  Scene scene = random_scene(may_exceed);
  const auto fault = *rc::gen::element(Reason::input_stale, Reason::input_not_finite);
  auto input = scene.inputs.back();
  input.unfit = fault;
  settle(scene, input);
  Channel::Output last;
  play(scene,
       [&](auto&, auto&, auto& output, auto&, auto&, double, double, double) { last = output; });
  RC_ASSERT(last.handed_back);
  RC_ASSERT(!last.masks_panel);
  RC_ASSERT(last.reason == fault);
}

RC_GTEST_PROP(Safety, AThreadHoldsTheWordWhateverComesIn, (bool may_exceed)) {
  // Only the operator moves what is in force: by panel 0, or by a panel below the word.
  play(random_scene(may_exceed), [&](auto&, auto& input, auto&, const Word& from, const Word& to,
                                     double before, double now, double panel) {
    if (!input.hold) {
      return;
    }
    RC_ASSERT(from.code == to.code || !(from.masks || to.masks));
    RC_ASSERT(!to.masks || from.masks);
    if (from.masks && !to.masks) {
      RC_ASSERT(panel == 0.0 || (panel < before && !may_exceed));
    } else {
      RC_ASSERT(now == before);
    }
  });
}

RC_GTEST_PROP(Safety, APortThatCannotWriteIsNeverAskedTo, ()) {
  Scene scene = random_scene();
  scene.config.available = false;
  play(scene, [](auto&, auto&, auto& output, auto&, auto&, double, double, double) {
    RC_ASSERT(!output.masks_panel);
  });
}

// 34.9 % rounds down to 30 %, position 9 of the switch: Gray 01101.
TEST(Channel, AskedForASteadyWishItStandsOnTheLargestStepBelow) {
  auto channel = Channel::make({.table = test::feed_840d()});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.349, .reason = Reason::contour_limit};
  input.panel.panel_code = 0b11010;
  Channel::Output output;
  for (int ms = 0; ms < 200; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_TRUE(output.masks_panel);
  EXPECT_EQ(output.ratio, 0.30);
  EXPECT_EQ(output.code, 0b01101U);
  EXPECT_EQ(output.reason, Reason::contour_limit);
}

// The fault that the machine file exists for: 11010 is 100 % on the 840D panel, 70 % here.
TEST(Channel, OnTheDmgTableTheWordForSeventyPercentIsTheOneThatElsewhereMeansHundred) {
  auto channel = Channel::make({.table = test::feed_dmg()});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.7, .reason = Reason::contour_limit};
  Channel::Output output;
  for (int ms = 0; ms < 200; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_EQ(output.ratio, 0.7);
  EXPECT_EQ(output.code, 0b11010U);
}

TEST(Channel, TheLowerLimitIsAStepOfTheTable) {
  // 25 % stands between 20 and 30: rounding down must not end below the limit.
  auto channel = Channel::make({.table = test::feed_840d(), .min_ratio = 0.25});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.0, .reason = Reason::contour_limit};
  Channel::Output output;
  for (int ms = 0; ms < 500; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_EQ(output.ratio, 0.30);
  EXPECT_EQ(output.reason, Reason::clamped);
}

TEST(Channel, WhereThePortCannotWriteTheReasonSaysSo) {
  auto channel = Channel::make({.table = test::feed_840d(), .available = false});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.3, .reason = Reason::contour_limit};
  Channel::Output output;
  for (int ms = 0; ms < 500; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_FALSE(output.masks_panel);
  EXPECT_EQ(output.ratio, 1.0);
  EXPECT_EQ(output.reason, Reason::port_cannot_write);
}

TEST(Channel, RefusesATableThatTheEnvelopeExcludes) {
  const auto channel = Channel::make({.table = test::spindle_840d(), .max_ratio = 0.4});
  ASSERT_FALSE(channel);
  EXPECT_EQ(channel.error().what, "the override table has no step within the envelope's 0 … 40 %");
}

// At 90 ms the walk is under way: step, scan and mask must come over.
TEST(Channel, ARestoredStateGoesOnWhereItWas) {
  const Channel::Config config{.table = test::feed_840d(), .latched = false};
  auto first = Channel::make(config);
  auto second = Channel::make(config);
  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  RatioEnvelope::Input input{.ratio = 0.3, .reason = Reason::contour_limit};
  for (int ms = 0; ms < 90; ++ms) {
    input.step_s = 0.001;
    first->update(input);
  }
  second->restore(first->state());
  for (int ms = 90; ms < 300; ++ms) {
    input.step_s = 0.001;
    const auto a = first->update(input);
    const auto b = second->update(input);
    ASSERT_EQ(a.code, b.code);
    ASSERT_EQ(a.masks_panel, b.masks_panel);
  }
}

}  // namespace
}  // namespace steadyrest::kernel::override
