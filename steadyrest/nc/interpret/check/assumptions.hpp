// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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
class Assumptions {
 public:
  explicit Assumptions(const Control& control) noexcept : control_(control) {}

  /// Call before the block acts.
  void look(const Step& step) noexcept {
    if (!control_.state.unit_known || !control_.state.feed_unit_known) {
      note(step);
    }
    if (step.reference_point > 2 && reference_line_ == 0) {
      reference_line_ = step.line;
    }
    if (step.has_fanuc && step.fanuc.no_point && point_line_ == 0) {
      point_line_ = step.line;
    }
  }
  /// A call of a cycle: its values are lengths.
  void look_at_cycle(const read::Block& block) noexcept;

  /// The program ends where its file does.
  void note_end(std::uint32_t line) noexcept { end_line_ = line; }
  /// A cut before the first F.
  void note_feed(std::uint32_t line) noexcept {
    missing_feed_line_ = missing_feed_line_ == 0 ? line : missing_feed_line_;
  }
  /// The tool is moved off the wall of a bore before it comes out: which way is a setting.
  void note_shift(std::uint32_t line) noexcept {
    shift_line_ = shift_line_ == 0 ? line : shift_line_;
  }

  [[nodiscard]] std::vector<Assumption> found() const;

 private:
  void note(const Step& step) noexcept;
  void add_units(std::vector<Assumption>& out) const;
  void add_others(std::vector<Assumption>& out) const;
  [[nodiscard]] bool uses_length(const Step& step) const noexcept;
  [[nodiscard]] bool uses_feed(const Step& step) const noexcept;

  const Control& control_;
  std::uint32_t length_line_ = 0;
  std::uint32_t feed_line_ = 0;
  bool lengths_said_ = false;  ///< at that F word
  std::uint32_t reference_line_ = 0;
  std::uint32_t point_line_ = 0;
  std::uint32_t end_line_ = 0;
  std::uint32_t missing_feed_line_ = 0;
  std::uint32_t shift_line_ = 0;
};

}  // namespace steadyrest::nc::interpret
