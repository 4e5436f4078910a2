// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

/// What must stand before each line of the original, character for character, put together from
/// what the proof finds to stand on each axis: checks and notes change nothing in a run from the
/// beginning to the end, and would be missed after an abort.
///
/// For each line begin(), then for each axis of the plan, in its order, one of the others.
class GroupText {
 public:
  /// Both outlive it.
  GroupText(const Plan& plan, const Settings& settings) : plan_(plan), settings_(settings) {}

  void begin(const Walk& walk) {
    walk_ = &walk;
    text_.clear();
  }
  /// The axis stands corrected as before, by `stands_mm`.
  void stays(std::size_t axis, double stands_mm);
  /// What stands is taken off, for this line alone or at the program's end.
  void goes_off(std::size_t axis, double stands_mm);
  /// It changes, at a place of this kind.
  void changes(std::size_t axis, double from_mm, double to_mm, Site site);

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  void behind_the_line_before(std::size_t axis, double stands_mm);
  [[nodiscard]] Change change(std::size_t axis, double from_mm, double to_mm) const;

  const Plan& plan_;
  const Settings& settings_;
  const Walk* walk_ = nullptr;
  std::string text_;
  std::uint32_t off_ = 0;    ///< axes that were taken off for the line before, a mask
  std::uint32_t noted_ = 0;  ///< axes whose offset the line before has set, a mask
};

}  // namespace steadyrest::nc::rewrite
