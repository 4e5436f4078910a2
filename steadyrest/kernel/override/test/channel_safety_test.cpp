// SPDX-License-Identifier: Apache-2.0
// One property for each safety statement that the override alone can break. All run the same random
// histories of wishes, panel, faults and cycle times through envelope and hand-over.
#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/test/random_scene.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using test::in_force;
using test::kTolerance;
using test::play;
using test::random_scene;
using test::Scene;
using test::settle;
using test::widest_step;
using test::Word;
using units::kInfinity;

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
  // Bound: from any instant, the ratio in force rises by no more than rise·t plus one step of the
  // table, unless the operator turns his switch up while no mask is on. On the way up to a panel
  // beyond the table's last step, the mask can come off only at that step.
  const Scene scene = random_scene(may_exceed);
  double bound = kInfinity;
  play(scene, [&](auto& channel, auto& input, auto&, auto&, auto&, double before, double now,
                  double panel) {
    const double passed_s =
        std::isfinite(input.step_s) ? std::clamp(input.step_s, 0.0, scene.config.max_step_s) : 0.0;
    const double step = std::max(widest_step(channel.table()),
                                 panel - channel.table().ratio(channel.table().steps() - 1)) +
                        kTolerance;
    // `before` combines the last word with this cycle's panel: a rise up to there is the
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

// Long enough after the last change the wish must be in force within all limits: between the lowest
// step that min_ratio allows and max_ratio, and under the panel where the panel rules.
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

// All words that the bits can show in any order, with the old and the new mask: part runs through
// the subsets of the differing bits, (part − 1) & differing.
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
  // Only the operator changes what is in force: by panel 0, or by a panel below the word.
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

}  // namespace
}  // namespace steadyrest::kernel::override
