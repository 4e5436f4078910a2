// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/handover.hpp>

// Taking over: the word first follows the panel and settles there; only then does the mask go on,
// so the control sees no change. Handing back is the reverse: the word goes to the panel's step,
// settles, and the mask comes off.
namespace steadyrest::kernel::override {

outcome::Result<Handover> Handover::make(Table table, const Config& config) {
  // A word that is never written needs no safe path between its steps.
  const bool latched = !config.available || (config.latched && table.latched_word());
  auto stepper = Stepper::make(table, {.latched = latched, .scan_period_s = table.scan_period_s()});
  if (!stepper) {
    return std::unexpected(std::move(stepper.error()));
  }
  return Handover(std::move(table), *stepper, config);
}

// The operator's 0, or a panel below the word, takes the mask off at once, settled or not: on the
// way down no misreading can be faster than the panel.
bool Handover::operator_releases(const RatioEnvelope::Output& wanted) const noexcept {
  const bool above_panel = word_ratio() > wanted.panel_ratio + kRatioTolerance;
  return wanted.panel_ratio == 0.0 || (above_panel && !table_.layer_may_exceed_panel());
}

// Where the panel lies between two steps, the step below is as close as a word can get.
bool Handover::may_release(const RatioEnvelope::Output& wanted) const noexcept {
  if (!wanted.hand_back || !stepper_.settled()) {
    return false;
  }
  const auto panel_step = table_.floor_step(wanted.panel_ratio);
  return !panel_step || word_ratio() == table_.ratio(*panel_step);
}

/// The first word is placed at once: the layer had nothing there before it.
void Handover::follow_panel(const RatioEnvelope::Output& wanted, bool is_first) noexcept {
  const auto panel_step = table_.floor_step(wanted.panel_ratio);
  if (!wanted.panel_known || !panel_step || !(stepper_.settled() || is_first)) {
    return;
  }
  stepper_.place(*panel_step);
  if (config_.available && !wanted.hand_back && stepper_.settled()) {
    masked_ = true;
    stepper_.touch();
    write_word(wanted);
  }
}

/// Of equal steps the nearest: a walk among them would change nothing but delay what comes next.
void Handover::write_word(const RatioEnvelope::Output& wanted) noexcept {
  const auto run = table_.equal_steps(table_.floor_step(wanted.ratio).value_or(0));
  stepper_.update(std::clamp(stepper_.state().step, run.first, run.last));
}

// One action per cycle: drop the mask, move the word, or follow the panel. During a hold only the
// operator changes anything.
Handover::Output Handover::update(double step_s, const RatioEnvelope::Output& wanted,
                                  bool hold) noexcept {
  const bool is_first = !stepper_.state().written;
  stepper_.pass(step_s);
  if (masked_ && (operator_releases(wanted) || (!hold && may_release(wanted)))) {
    masked_ = false;
    stepper_.touch();
  } else if (masked_ && !hold) {
    write_word(wanted);
  } else if (!hold) {
    follow_panel(wanted, is_first);
  }
  const std::size_t step = stepper_.state().step;
  const auto [first, last] = table_.equal_steps(step);
  return {.ratio = masked_ ? word_ratio() : wanted.panel_ratio,
          .code = table_.code(step),
          .masks_panel = masked_,
          .settled = stepper_.settled(),
          // How far the next change can take the word; the envelope stays within that. A neighbour
          // of the same ratio is no change: bounded by it, the envelope could never leave the step.
          .reach_low = first > 0 ? table_.ratio(first - 1) : 0.0,
          .reach_high = last + 1 < table_.steps() ? table_.ratio(last + 1) : kMaxRequestRatio};
}

// A mask without a written word would point at whatever is on the wires.
void Handover::restore(const State& state) noexcept {
  stepper_.restore(state.word);
  masked_ = state.masked && state.word.written && config_.available;
}

}  // namespace steadyrest::kernel::override
