// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/units/constants.hpp>

/// A channel under random wishes, panels and limits, and the words that it writes.
namespace steadyrest::kernel::override::test {

using outcome::Reason;
using units::kInfinity;
using units::kNan;

inline constexpr double kTolerance = 1e-8;

struct Scene {
  Channel::Config config;
  std::vector<RatioEnvelope::Input> inputs;
};

// One wish in eight is an invalid ratio.
inline double random_wish() {
  if (*rc::gen::inRange(0, 8) == 0) {
    return *rc::gen::element(kNan, kInfinity, -kInfinity, -1.0, 1e300);
  }
  return *rc::gen::inRange(0, 1500) / 1000.0;
}

// As machine builders fill a switch: positions that repeat a value anywhere, one position alone,
// all 256 positions of a byte. A binary switch may have its codes in any order.
inline machine::OverrideTable varied(machine::OverrideTable table) {
  const auto published = table.ratio;
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      table.ratio = {*rc::gen::elementOf(published)};
      break;
    case 1: {
      const auto count = static_cast<std::size_t>(*rc::gen::inRange(1, 24));
      const auto some =
          *rc::gen::container<std::vector<double>>(count, rc::gen::elementOf(published));
      table.ratio.clear();
      for (std::size_t i = 0; i < 256; ++i) {
        table.ratio.push_back(some[i % some.size()]);
      }
      std::ranges::sort(table.ratio);
      break;
    }
    case 2:
    case 3:
      table.ratio.clear();
      for (const double ratio : published) {
        table.ratio.insert(table.ratio.end(), static_cast<std::size_t>(*rc::gen::inRange(1, 4)),
                           ratio);
      }
      break;
    case 4:
      table.max_ratio = *rc::gen::element(0.5, 0.9, 1.0);
      break;
    default:
      break;
  }
  if (table.coding == machine::Coding::binary) {
    table.code.clear();
    const auto odd = static_cast<std::uint32_t>(2 * *rc::gen::inRange(0, 512) + 1);
    for (std::uint32_t i = 0; i < table.ratio.size(); ++i) {
      table.code.push_back(i * odd % 1024U);
    }
  }
  return table;
}

// Published tables and variants of them, in Gray code, walked or latched; a binary word only
// latched, since make() refuses it otherwise.
inline Channel::Config random_config(bool may_exceed) {
  Channel::Config config;
  const bool binary = *rc::gen::inRange(0, 4) == 0;
  config.table = binary
                     ? test::percent_word()
                     : *rc::gen::element(test::feed_840d(), test::spindle_840d(), test::feed_dmg());
  config.table = varied(std::move(config.table));
  config.table.layer_may_exceed_panel = may_exceed;
  config.latched = binary || *rc::gen::arbitrary<bool>();
  config.min_ratio = *rc::gen::inRange(0, 60) / 100.0;
  config.max_ratio = *rc::gen::inRange(60, 150) / 100.0;
  config.fall_1_s = *rc::gen::inRange(1, 20);
  config.rise_1_s = *rc::gen::inRange(1, 10);
  return config;
}

// A dozen spells of up to 120 cycles, each with a wish, faults, holds and panels on and between the
// table's steps; now and then a cycle with a wrong time.
inline Scene random_scene(bool may_exceed = false) {
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

/// What the machine has at its input after a cycle.
struct Word {
  std::uint32_t code = 0;
  bool masks = false;
};

/// Ratio in force for a word; empty when the machine could not decode it. This is the machine's
/// side, decoded independently of the channel.
inline std::optional<double> in_force(const Table& table, const Word& word, double panel) {
  if (!word.masks) {
    return panel;
  }
  const auto step = table.step_of_code(word.code);
  return step ? std::optional(table.ratio(*step)) : std::nullopt;
}

/// Calls check(input, output, before, now) for each cycle: the ratios in force at this cycle's
/// panel, with the last cycle's word and with this one's.
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

inline double widest_step(const Table& table) {
  double widest = 0.0;
  for (std::size_t step = 1; step < table.steps(); ++step) {
    widest = std::max(widest, table.ratio(step) - table.ratio(step - 1));
  }
  return widest;
}

/// Repeats the last input until the slowest way ends: the whole range at 1 1/s, all steps of a scan
/// each, a scan for the mask.
inline void settle(Scene& scene, RatioEnvelope::Input input) {
  const double walk_s =
      static_cast<double>(scene.config.table.ratio.size()) * scene.config.table.scan_period_s;
  input.hold = false;
  input.panel.panel_code_known = true;
  input.step_s = 0.002;
  for (double waited_s = 0.0; waited_s < 2.7 + walk_s; waited_s += 0.002) {
    scene.inputs.push_back(input);
  }
}

}  // namespace steadyrest::kernel::override::test
