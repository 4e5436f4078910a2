// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/nc/interpret/control/control.hpp>
#include <steadyrest/nc/interpret/state/assumption.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

/// Notes where a program first depends on a unit that neither its text nor `Config::unit_known`
/// settles. A value of 0 depends on none.
///
/// Lengths: axis words, centres, radii, levels and depths of cycles, tolerances, cutting speeds
/// (m/min, ft/min). Feeds: F per minute and per revolution; on sinumerik G70 leaves them to the
/// control, on linuxcnc G20 in the block of F comes too late for it.
///
/// Also the first word that changes the dynamics of the control alone (sinumerik BRISK, ACC[X],
/// DYNFINISH, CYCLE832 …): the plan has those of the machine file.
class Assumptions {
 public:
  explicit Assumptions(const Control& control) noexcept : control_(control) {}

  /// Call before the block acts.
  void look(const Step& step) {
    if (!control_.state.unit_known || !control_.state.feed_unit_known) {
      note(step);
    }
    if (step.reference_point > 2 && reference_line_ == 0) {
      reference_line_ = step.line;
    }
    if (step.named && step.named->dynamics != nullptr && dynamics_line_ == 0) {
      note_dynamics(step.line, step.named->dynamics->name);
    }
  }
  /// A call of a cycle: its values are lengths.
  void look_at_cycle(const read::Block& block);
  /// A frame written as data: the corrections of rewriting use the frames that the control stores.
  void look_at_frame(const read::Block& block) noexcept;

  [[nodiscard]] std::vector<Assumption> found() const;

 private:
  void note_dynamics(std::uint32_t line, std::string_view word);
  void note(const Step& step) noexcept;
  [[nodiscard]] bool uses_length(const Step& step) const noexcept;
  [[nodiscard]] bool uses_feed(const Step& step) const noexcept;

  const Control& control_;
  std::uint32_t length_line_ = 0;
  std::uint32_t feed_line_ = 0;
  bool lengths_said_ = false;  ///< at that F word
  std::uint32_t reference_line_ = 0;
  std::uint32_t frame_line_ = 0;
  std::uint32_t dynamics_line_ = 0;
  std::string dynamics_word_;
};

}  // namespace steadyrest::nc::interpret
