// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/override/transition.hpp>

namespace steadyrest::kernel::override {

/// Puts the envelope's ratio onto the machine's override switch: quantises, walks the word, and
/// masks the panel or hands back to it.
///
/// Law: the step is the largest not above the envelope's ratio (and so not above the panel, unless
/// the layer may exceed it). Where the table has nothing that low, the lowest step is used if the
/// panel allows it.
///   mask on:  only after the word has held the panel's own step for a scan, so that switching from
///             panel to layer changes nothing by itself (a latched word carries its mask and
///             needs no wait);
///   mask off: at once when the word is above the panel (that lowers the value; it happens when the
///             operator turns down, unless the layer may exceed him); else once the envelope is
///             back at the panel and the word is at the largest step not above it, so that
///             handing back raises the value by less than one step. The word then holds for one
///             more scan.
/// Panel 0 takes the mask off in the same cycle. A panel whose code is unknown is never masked.
///   hold:     the word stays where it is, even in mid-walk, and no mask goes on; the
///             mask comes off only for the operator (panel 0, or panel below the word).
/// Waits count good time (`step_s`), so a cycle without a valid time settles nothing.
class Handover {
 public:
  struct Config {
    bool latched = true;    ///< the port writes the word as a whole; the table must say so too
    bool available = true;  ///< the port can write this override at all
  };

  struct Output {
    double ratio = 1.0;      ///< in force: the word's when masked, else the panel's
    std::uint32_t code = 0;  ///< the word to write
    bool masks_panel = false;
    bool settled = false;  ///< word and mask have been unchanged for a scan
    /// The next different ratios below and above the word's: the envelope stays between them.
    double reach_low = 0.0;
    double reach_high = 0.0;
  };

  struct State {
    Stepper::State word;
    bool masked = false;
  };

  [[nodiscard]] static outcome::Result<Handover> make(Table table, const Config& config);

  /// `step_s`: good time since the last cycle; `hold`: thread or tap.
  Output update(double step_s, const RatioEnvelope::Output& wanted, bool hold = false) noexcept;

  [[nodiscard]] const Table& table() const noexcept { return table_; }
  [[nodiscard]] bool available() const noexcept { return config_.available; }
  [[nodiscard]] State state() const noexcept {
    return {.word = stepper_.state(), .masked = masked_};
  }
  void restore(const State& state) noexcept;
  /// The state of the word's wires is unknown, and no mask is on.
  void reset() noexcept { restore({}); }

 private:
  Handover(Table table, Stepper stepper, const Config& config)
      : table_(std::move(table)), stepper_(stepper), config_(config) {}
  [[nodiscard]] double word_ratio() const noexcept { return table_.ratio(stepper_.state().step); }
  void follow_panel(const RatioEnvelope::Output& wanted, bool is_first) noexcept;
  void write_word(const RatioEnvelope::Output& wanted) noexcept;
  [[nodiscard]] bool operator_releases(const RatioEnvelope::Output& wanted) const noexcept;
  [[nodiscard]] bool may_release(const RatioEnvelope::Output& wanted) const noexcept;

  Table table_;
  Stepper stepper_;
  Config config_;
  bool masked_ = false;
};

}  // namespace steadyrest::kernel::override
