// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/interpreter.hpp>

// Nearly all lines of a long program are G0 or G1, F and axis words. Of all that check() and act()
// look for, only what is done here can come of such a block.
namespace steadyrest::nc::interpret {

bool Interpreter::is_plain(const Step& step) const noexcept {
  const int motion = step.code(GGroup::motion);
  const int now = motion != kNoCode ? motion : state_.motion;
  return !step.others && config_.dialect == read::Dialect::linuxcnc && (now == 0 || now == 10) &&
         (motion != kNoCode || (step.mask & kAxisMask) != 0) && state_.cutter_side == 0 &&
         spline_points_.empty();
}

bool Interpreter::execute_plain(const Step& step) {
  const int motion = step.code(GGroup::motion);
  motion_now_ = motion != kNoCode ? motion : state_.motion;
  if (!check_values(step)) {
    return false;
  }
  move_.line = step.line;
  move_.speed_modulation = state_.speed_modulation;
  set_feed(step);
  state_.motion = motion_now_;
  cubic_goes_on_ = false;
  return straight(step);
}

}  // namespace steadyrest::nc::interpret
