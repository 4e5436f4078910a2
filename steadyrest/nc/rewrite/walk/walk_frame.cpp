// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Step;

// The kinds ascend by severity, so the worse of both positions counts.
Frame Walk::frame(char letter) const {
  const Frame own = frame_alone(letter);
  return other_ == nullptr || !together() ? own : std::max(own, other_->frame_alone(letter));
}

Frame Walk::frame_alone(char letter) const {
  if (facts_.reference) {
    return Frame::stored;
  }
  const interpret::State& now = run_->state();
  // G54 in G54 changes nothing on LinuxCNC, but on SINUMERIK it loads the stored frame again.
  if (now.active_offset != before_.active_offset || now.work_offset_on != before_.work_offset_on ||
      facts_.settable) {
    return Frame::changed;
  }
  if (!facts_.data || (facts_.axes & Step::bit(letter)) == 0) {
    return Frame::kept;
  }
  // L20 sets the active offset from the position shown, which includes the correction, so it stays
  // in. Any other offset would keep it for good.
  if (facts_.data_form == 20.0) {
    return of_active() ? Frame::kept : Frame::measured;
  }
  return of_active() ? Frame::changed : Frame::kept;
}

/// Whether a G10 refers to the work offset in force.
bool Walk::of_active() const noexcept {
  // P0 and no P both mean the active offset.
  return facts_.data_set <= 0.0 ||
         facts_.data_set == static_cast<double>(run_->state().active_offset) + 1.0;
}

/// What the program may not do where the head sets the external offset to 0 in G90.
void Walk::look_for_external() {
  // The head's G90 stays in force; the program may have relied on a G91 left in the control.
  if (facts_.axes != 0 && !said_.has(mode(interpret::GGroup::distance))) {
    said_.take({.line = line_or_call(),
                .what = "programs an axis before G90 or G91: the head removes the external offset "
                        "in G90 and would change the effect of this line",
                .to_do = "write G90 (or G91) before it"});
  }
  if (facts_.data && facts_.data_set == 0.0) {
    said_.take({.line = line_or_call(),
                .what = "sets the external offset itself, so external_offset_free is wrong",
                .to_do = "use a work offset (G10 L2 P1 ...), or set external_offset_free = false"});
  }
}

bool Walk::sets_offset(char letter) const noexcept {
  return sets_offset_alone(letter) ||
         (other_ != nullptr && together() && other_->sets_offset_alone(letter));
}

bool Walk::sets_offset_alone(char letter) const noexcept {
  const bool measures = facts_.data && facts_.data_form == 20.0 && of_active() &&
                        (facts_.axes & Step::bit(letter)) != 0;
  // From here on the offset differs from LinuxCNC's note: it is noted again.
  return facts_.shifts || measures;
}

}  // namespace steadyrest::nc::rewrite
