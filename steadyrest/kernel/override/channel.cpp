// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/format.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/channel.hpp>

// Envelope and hand-over are two halves of one state: the envelope may lead the word only by what
// the word can follow in one step, else its slew would continue while the word waits for a scan.
namespace steadyrest::kernel::override {
namespace {

outcome::Refusal no_step_between(const Channel::Config& config) {
  return outcome::bad_input(
      fmt::format("the override table has no step within the envelope's {:g} … {:g} %",
                  100.0 * config.min_ratio, 100.0 * config.max_ratio),
      "widen the envelope or correct the table");
}

}  // namespace

outcome::Result<Channel> Channel::make(const Config& config) {
  auto table = Table::make(config.table);
  if (!table) {
    return std::unexpected(std::move(table.error()));
  }
  const auto lowest = table->ceil_step(config.min_ratio);
  if (!lowest || table->ratio(*lowest) > config.max_ratio + kRatioTolerance) {
    return std::unexpected(no_step_between(config));
  }
  // The next step up: ratios are rounded down to a step, and the lower limit must survive that.
  auto envelope = RatioEnvelope::make({.min_ratio = table->ratio(*lowest),
                                       .max_ratio = config.max_ratio,
                                       .fall_1_s = config.fall_1_s,
                                       .rise_1_s = config.rise_1_s,
                                       .max_step_s = config.max_step_s,
                                       .may_exceed_panel = table->layer_may_exceed_panel()});
  if (!envelope) {
    return std::unexpected(std::move(envelope.error()));
  }
  auto handover =
      Handover::make(std::move(*table), {.latched = config.latched, .available = config.available});
  if (!handover) {
    return std::unexpected(std::move(handover.error()));
  }
  return Channel(*envelope, std::move(*handover));
}

Channel::Output Channel::update(const RatioEnvelope::Input& input) noexcept {
  // Without a mask the operator's switch acts at once. If he has turned it since the last cycle,
  // the layer starts from the new position: a first word from the old one would undo him. The
  // envelope takes the first look at the panel and gives no time credit before it.
  if (handover_.available() && envelope_.state().panel_seen) {
    see_panel(input.panel);
  }
  const auto wanted = envelope_.update(input);
  const auto word = handover_.update(input.step_s, wanted, input.hold);
  if (word.masks_panel) {
    envelope_.wait_within(word.reach_low, word.reach_high);
  } else if (handover_.available()) {
    // The mask had to wait: the way from the panel begins when the mask is on, not before.
    envelope_.start_at_panel();
  }
  // "Port cannot write" is the reason only while there is something to write.
  const bool stuck = !handover_.available() && !wanted.hand_back && is_wish(wanted.reason);
  return {.ratio = word.ratio,
          .code = word.code,
          .masks_panel = word.masks_panel,
          .handed_back = envelope_.state().at_panel && !word.masks_panel && word.settled,
          .reason = stuck ? outcome::Reason::port_cannot_write : wanted.reason};
}

// From the state, not from the last output: valid immediately after a take-back or a restore.
signal::RatioInForce Channel::in_force() const noexcept {
  const RatioEnvelope::State& envelope = envelope_.state();
  const Handover::State handover = handover_.state();
  return {.ratio = handover_.available() ? envelope.ratio : envelope.panel_ratio,
          .word_ratio = handover.masked ? table().ratio(handover.word.step) : envelope.panel_ratio};
}

void Channel::see_panel(const signal::OverrideState& panel) noexcept {
  static_cast<void>(envelope_.see_panel(panel));
  if (!handover_.state().masked) {
    envelope_.start_at_panel();
  }
}

void Channel::take_back(const State& before) noexcept {
  const RatioEnvelope::State now = envelope_.state();
  restore(before);
  // The panel's reading is valid whether or not the word arrived.
  if (now.panel_seen) {
    see_panel({.panel_ratio = now.panel_ratio, .panel_code_known = true});
  }
}

void Channel::reset() noexcept {
  envelope_.reset();
  handover_.reset();
}

void Channel::restore(const State& state) noexcept {
  envelope_.restore(state.envelope);
  handover_.restore(state.handover);
}

}  // namespace steadyrest::kernel::override
