// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

/// The text that must precede each line of the original, character for character, built from the
/// correction that the proof finds in force on each axis. Running the program would not reveal
/// missing checks and notes: they only act after an abort.
///
/// Call begin() for each line, then one of the others for each axis, in the plan's order.
class GroupText {
 public:
  /// Both outlive it.
  GroupText(const Plan& plan, const Settings& settings) : plan_(plan), settings_(settings) {}

  void begin(const Walk& walk) {
    walk_ = &walk;
    text_.clear();
  }
  /// The axis keeps its correction, `stands_mm`.
  void stays(std::size_t axis, double stands_mm);
  /// The correction comes off, for this line only or at the program's end.
  void goes_off(std::size_t axis, double stands_mm);
  /// The correction changes, at a place of this kind.
  void changes(std::size_t axis, double from_mm, double to_mm, Site site);

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  void behind_the_line_before(std::size_t axis, double stands_mm);
  [[nodiscard]] Change change(std::size_t axis, double from_mm, double to_mm) const;

  const Plan& plan_;
  const Settings& settings_;
  const Walk* walk_ = nullptr;
  std::string text_;
  std::uint32_t off_ = 0;    ///< axes whose correction was off for the previous line, a mask
  std::uint32_t noted_ = 0;  ///< axes whose offset the previous line set, a mask
};

}  // namespace steadyrest::nc::rewrite
