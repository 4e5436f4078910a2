// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/rewrite/prove/group_text.hpp>
#include <steadyrest/nc/rewrite/prove/shifts.hpp>

namespace steadyrest::nc::rewrite {

// Builds the lines that the plan calls for before the current line, from the original alone. The
// proof compares them with the actual ones, character for character.
Change GroupText::change(std::size_t axis, double from_mm, double to_mm) const {
  const Walk::Before& before = walk_->before();
  return {.letter = plan_.axes[axis].letter,
          .from_mm = from_mm,
          .to_mm = to_mm,
          .unit_mm = before.unit_mm,
          .active_offset = before.active_offset,
          .incremental = before.incremental};
}

// What the previous line left open: a correction to reapply after a change of the frame, a note to
// rewrite after a change of the offset.
void GroupText::behind_the_line_before(std::size_t axis, double stands_mm) {
  if ((off_ & axis_bit(axis)) != 0) {
    text_ += change_text(settings_, change(axis, 0.0, stands_mm), "\n");
  }
  if ((noted_ & axis_bit(axis)) != 0) {
    text_ += renote_text(settings_, plan_.axes[axis].letter, "\n");
  }
  off_ &= ~axis_bit(axis);
  noted_ &= ~axis_bit(axis);
}

void GroupText::stays(std::size_t axis, double stands_mm) {
  behind_the_line_before(axis, stands_mm);
  const char letter = plan_.axes[axis].letter;
  if (stands_mm != 0.0 && walk_->sets_offset(letter) && !walk_->ends() &&
      walk_->frame(letter) == Frame::kept) {
    text_ += check_text(settings_, letter, "\n");
    noted_ |= axis_bit(axis);
  }
}

void GroupText::goes_off(std::size_t axis, double stands_mm) {
  behind_the_line_before(axis, stands_mm);
  text_ += change_text(settings_, change(axis, stands_mm, 0.0), "\n");
  // At the program's end nothing follows that could reapply it.
  off_ |= walk_->ends() ? 0U : axis_bit(axis);
}

void GroupText::changes(std::size_t axis, double from_mm, double to_mm, Site site) {
  behind_the_line_before(axis, from_mm);
  const Change change = this->change(axis, from_mm, to_mm);
  text_ += change_text(settings_, change, "\n");
  // Without a word of the axis in the line the added G0 makes the shift act.
  if (site == Site::clearance) {
    text_ += restate_text(settings_.method, change, walk_->units_said(),
                          walk_->before().position[plan_.axes[axis].index], "\n");
  }
}

}  // namespace steadyrest::nc::rewrite
