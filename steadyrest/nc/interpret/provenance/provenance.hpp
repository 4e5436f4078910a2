// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/flow/flow_control.hpp>
#include <steadyrest/nc/interpret/parameters/known_state.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/provenance/doubt.hpp>
#include <steadyrest/nc/interpret/provenance/effects.hpp>
#include <steadyrest/nc/interpret/provenance/opaque_stretches.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::interpret {

/// Follows through a program what its text settles and what the control decides.
///
/// Law: a mode is known from the word that sets it; the position of an axis from an absolute word,
/// in modes that are known; a parameter from an assignment of known values. What is set in doubt
/// (FlowControl::in_doubt), or would be in a line that is skipped in doubt, and what a word with an
/// unknown value sets, is not known again before the text sets it out of doubt. After a change of
/// the work offset or of the tool's length a position is known only where these are given.
///
/// Known at the start: the work offsets, where they are given; nothing else.
class Provenance {
 public:
  Provenance(const Config& config, const DialectRules& rules, Parameters& parameters);
  Provenance(const Provenance&) = delete;
  Provenance& operator=(const Provenance&) = delete;
  ~Provenance() = default;

  /// Before a line is read.
  void at_line(std::uint32_t line, bool in_doubt, bool repeating);
  /// Nothing is in doubt, and a straight move in plain numbers settles nothing more: nearly every
  /// line.
  [[nodiscard]] bool settled() const noexcept {
    constexpr ModeMask kSaid = mode(GGroup::motion) | mode(GGroup::distance) | kFeedMode;
    constexpr std::uint32_t kXyz = 7U;
    return !known_.doubt && !repeating_ && lost_ == 0 && !opaque() &&
           (known_.modes & kSaid) == kSaid && (known_.axes & kXyz) == kXyz;
  }
  /// After its words were executed.
  void executed(const read::Block& block, const State& state);
  /// It is skipped for a condition; true when it has M98 or M99.
  bool passed_over(std::string_view line);
  /// After an O-word.
  void lose(FlowControl::Lost lost);
  /// It was not understood, and may have changed these.
  void not_understood(const read::Refused& refused, const Effects& effects, const State& state);
  /// An opaque stretch is open where the line at hand begins.
  [[nodiscard]] bool opaque() const noexcept { return opaque_.any_open(); }
  /// MCALL alone: no modal call is on.
  void no_modal_call() noexcept { lost_ &= known_.doubt ? ~ModeMask{0} : ~kCallMode; }
  /// The line at hand was not understood.
  [[nodiscard]] bool at_opaque() const noexcept { return at_opaque_; }
  /// After the last line.
  [[nodiscard]] OpaqueStretches& stretches() noexcept {
    opaque_.settle(known_.line, ~known_.axes, lost_);
    return opaque_;
  }
  [[nodiscard]] KnownState& known() noexcept { return known_; }
  [[nodiscard]] const KnownState& known() const noexcept { return known_; }
  /// Of the line at hand.
  [[nodiscard]] Doubt doubt() const noexcept {
    return {.line = acts_,
            .opaque = opaque_before_ || at_opaque_,
            .axes = ~axes_before_,
            .unset = ~known_.modes,
            .lost = lost_};
  }

 private:
  struct Words;
  void apply(const Effects& effects);
  Words words_of(const read::Block& block);
  void unknown_word(const read::Word& word, Words& words);
  void settle(const read::Word& word, Words& words);
  void name(const read::Word& word) noexcept;
  void offsets(const Words& words);
  void axes(const Words& words, const State& state);

  bool tools_known_;  ///< of the control's tool table
  const DialectRules& rules_;
  bool lathe_;
  Parameters& parameters_;
  KnownState known_;
  ModeMask lost_ = 0;
  ModeMask never_ = 0;  ///< M70 has saved them before they were known: they may come back
  Effects turn_;        ///< of what was executed since the outermost loop or call began
  bool repeating_ = false;
  bool acts_ = false;
  bool at_opaque_ = false;
  bool opaque_before_ = false;      ///< before the line at hand
  std::uint32_t machine_axes_ = 0;  ///< 0: not known
  OpaqueStretches opaque_;
  std::uint32_t axes_before_ = 0;
  std::size_t active_offset_ = 0;
};

}  // namespace steadyrest::nc::interpret
