// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/control.hpp>
#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

/// Far beyond any machine; larger values would lose their meaning in later arithmetic.
inline constexpr double kLargestValue = 1e7;

/// Checks what a block must and must not contain before any of it acts. Reads the state and changes
/// nothing. The rules are LinuxCNC 2.9's (docs "G-code overview", and rs274 by experiment). All
/// functions return false when the block is refused.
class BlockCheck {
 public:
  explicit BlockCheck(Control& control) noexcept
      : state_(control.state), rules_(control.rules), refusals_(control.refusals) {}

  /// Sets `moves_by`: the block's own G word, or the modal one when axis words ask for it.
  bool choose_motion(Step& step) const;
  /// Checks everything else; `moves_by` must be set.
  bool check(const Step& step) const;
  /// Checks the range of all numbers.
  bool check_values(const Step& step) const;

 private:
  bool by_modal_motion(Step& step, int motion) const;
  bool by_pattern(Step& step) const;
  [[nodiscard]] bool takes_peck_words(int motion) const noexcept;
  bool check_non_modal(const Step& step) const;
  bool check_spindle_choice(const Step& step) const;
  bool unused(const Step& step, char letter, bool used) const;
  bool check_unused(const Step& step) const;
  bool check_unused_values(const Step& step) const;
  bool check_cutter(const Step& step) const;
  bool cutter_permits_what_comes_before(const Step& step) const;
  bool cutter_permits_what_comes_behind(const Step& step) const;

  const State& state_;
  const DialectRules& rules_;
  Refusals& refusals_;
};

/// Checks that a feed is in force for a cutting move, and a spindle speed where the feed needs one.
bool has_feed(const Step& step, const State& state, Refusals& refusals);

}  // namespace steadyrest::nc::interpret
