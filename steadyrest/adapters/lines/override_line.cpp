// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/adapters/lines/override_line.hpp>
#include <steadyrest/kernel/override/transition.hpp>

namespace steadyrest::adapters::lines {

using kernel::machine::kNoLine;
using kernel::machine::Wiring;
using kernel::outcome::Result;
using kernel::override::kRatioTolerance;
using kernel::override::Table;

Result<OverrideLine> OverrideLine::make(const Config& config) {
  auto table = Table::make(config.table);
  if (!table) {
    return std::unexpected(std::move(table.error()));
  }
  if (!table->latched_word()) {
    if (auto walk = kernel::override::check_walk(*table); !walk) {
      return std::unexpected(std::move(walk.error()));
    }
  }
  return OverrideLine(config, std::move(*table));
}

OverrideLine::Seen OverrideLine::see(const Levels& inputs, const Levels& outputs) noexcept {
  const auto& wires = config_.wires;
  shown_code_ = word_of(inputs, wires.panel, wires.panel_inverted);
  const auto panel = table_.step_of_code(shown_code_);
  unknown_ = panel ? 0 : std::min(unknown_ + 1, kUnknownReadings);
  if (panel || unknown_ == kUnknownReadings) {
    seen_.panel_code = shown_code_;
    seen_.panel_known = panel.has_value();
  }
  if (panel) {
    seen_.panel_ratio = table_.ratio(*panel);
  }
  seen_.effective_ratio = seen_.panel_ratio;
  const bool masked =
      config_.wiring == Wiring::through || wires.mask == kNoLine || outputs[wires.mask];
  const auto word = table_.step_of_code(word_of(outputs, wires.out, wires.out_inverted));
  if (masked && word) {
    const double ratio = table_.ratio(*word);
    const bool lower = config_.wiring == Wiring::plc && !table_.layer_may_exceed_panel();
    seen_.effective_ratio = lower ? std::min(ratio, seen_.panel_ratio) : ratio;
  }
  return seen_;
}

/// A panel that reads 0, or nothing known, is never masked; one below the word is not either.
bool OverrideLine::operator_has_it(std::size_t step) const noexcept {
  const bool above = table_.ratio(step) > seen_.panel_ratio + kRatioTolerance;
  return !seen_.panel_known || seen_.panel_ratio <= 0.0 ||
         (above && !table_.layer_may_exceed_panel());
}

void OverrideLine::adopt(const Levels& outputs, bool begins) noexcept {
  step_ = table_.step_of_code(word_of(outputs, config_.wires.out, config_.wires.out_inverted));
  mask_on_ = !begins && config_.wires.mask != kNoLine && outputs[config_.wires.mask];
  catches_up_ = begins && config_.wiring == Wiring::through;
}

std::size_t OverrideLine::walk(std::size_t step, bool step_time) noexcept {
  const std::size_t goal = step;
  const bool far = step_ && catches_up_ && goal > *step_;
  if (step_ && *step_ != step &&
      (far ||
       (!table_.latched_word() && !kernel::override::change_is_safe(table_, *step_, step)))) {
    // Two steps of a walk that the link has swallowed come one after the other all the same.
    step = !step_time ? *step_ : step > *step_ ? *step_ + 1 : *step_ - 1;
  }
  catches_up_ = catches_up_ && step != goal;
  step_ = step;
  return step;
}

bool OverrideLine::put_mask(bool on, Levels& outputs) noexcept {
  mask_on_ = on;
  if (config_.wires.mask != kNoLine) {
    outputs[config_.wires.mask] = on;
  }
  return on;
}

void OverrideLine::put_code(std::uint32_t code, Levels& outputs) const noexcept {
  put_word(code, config_.wires.out, config_.wires.out_inverted, outputs);
}

bool OverrideLine::put(const Word& word, bool step_time, Levels& outputs) noexcept {
  const auto layer = table_.step_of_code(word.code);
  const auto panel = table_.step_of_code(seen_.panel_code);
  const bool masks = word.masks && layer;
  if (!masks && config_.wiring == Wiring::through) {
    release(step_time, outputs);
    return false;
  }
  // Before the mask is on, it is the panel's word that settles, whatever the layer wants.
  const bool settled = panel && step_ == panel && step_time;
  const bool comes = config_.wiring != Wiring::through && !mask_on_;
  const bool waits = comes && (config_.wiring == Wiring::relay || !settled);
  // Whatever is not masked follows the panel, so that a mask that comes changes nothing.
  const auto goal = masks && !waits ? layer : panel;
  if (!goal) {
    put_mask(false, outputs);
    return false;
  }
  const std::size_t step = walk(*goal, step_time);
  put_code(table_.code(step), outputs);
  switch (config_.wiring) {
    case Wiring::relay:
      return put_mask((mask_on_ || (settled && !holds_)) && !operator_has_it(step), outputs);
    case Wiring::plc:
      return put_mask(masks && !waits, outputs);
    case Wiring::through:
      break;
  }
  if (operator_has_it(step)) {
    release(step_time, outputs);
    return false;
  }
  return true;
}

void OverrideLine::release(bool step_time, Levels& outputs) noexcept {
  put_mask(false, outputs);
  if (config_.wiring != Wiring::through) {
    return;
  }
  const auto panel = table_.step_of_code(shown_code_);
  // Between steps of equal ratio too: a word that jumps there mixes like any other.
  const bool rises = panel && step_ && table_.ratio(*panel) >= table_.ratio(*step_);
  if (rises) {
    put_code(table_.code(walk(*panel, step_time)), outputs);
  } else {
    catches_up_ = false;
    step_ = panel;
    put_code(shown_code_, outputs);
  }
}

}  // namespace steadyrest::adapters::lines
