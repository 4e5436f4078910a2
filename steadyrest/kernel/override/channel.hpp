// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/kernel/override/handover.hpp>
#include <steadyrest/kernel/signal/in_force.hpp>

namespace steadyrest::kernel::override {

/// One override (feed or spindle) from the arbiter's request to the word: envelope, then hand-over.
///
/// The envelope's lower limit is raised to the next step of the table, so that rounding down never
/// ends below it.
class Channel {
 public:
  struct Config {
    machine::OverrideTable table;
    double min_ratio = 0.0;  ///< see RatioEnvelope::Config
    double max_ratio = 1.2;
    double fall_1_s = 10.0;
    double rise_1_s = 2.0;
    double max_step_s = 0.1;
    bool latched = true;  ///< see Handover::Config
    bool available = true;
  };

  struct Output {
    double ratio = 1.0;      ///< in force: the word's when masked, else the panel's
    std::uint32_t code = 0;  ///< the word to write
    bool masks_panel = false;
    bool handed_back = true;  ///< neutral, and every reader has seen the mask off
    outcome::Reason reason = outcome::Reason::none;
  };

  struct State {
    RatioEnvelope::State envelope;
    Handover::State handover;
  };

  [[nodiscard]] static outcome::Result<Channel> make(const Config& config);

  Output update(const RatioEnvelope::Input& input) noexcept;
  /// Takes note of the panel in a cycle in which nothing is written.
  void see_panel(const signal::OverrideState& panel) noexcept;

  /// What the last update let pass, or what has applied since (see_panel, take_back, reset,
  /// restore).
  [[nodiscard]] signal::RatioInForce in_force() const noexcept;

  [[nodiscard]] const Table& table() const noexcept { return handover_.table(); }
  /// The machine's state is unknown: starts at the panel, without a mask.
  void reset() noexcept;
  [[nodiscard]] State state() const noexcept {
    return {.envelope = envelope_.state(), .handover = handover_.state()};
  }
  void restore(const State& state) noexcept;
  /// The last word did not reach the machine: restores the state before, except what was seen of
  /// the panel.
  void take_back(const State& before) noexcept;

 private:
  Channel(const RatioEnvelope& envelope, Handover handover)
      : envelope_(envelope), handover_(std::move(handover)) {}

  RatioEnvelope envelope_;
  Handover handover_;
};

}  // namespace steadyrest::kernel::override
