// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>

namespace steadyrest::nc::rewrite {

std::string_view sentence(Stays stays) noexcept {
  switch (stays) {
    case Stays::free:
      return "it may be replaced";
    case Stays::repeated:
      return "it is in a subprogram, a loop or a condition, or is executed more than once";
    case Stays::switchable:
      return "the operator can skip it (block delete)";
    case Stays::after_switch:
      return "it begins, or cuts, as a block says that the operator can skip (block delete)";
    case Stays::by_control:
      return "the control decides where it begins or what its words mean";
    case Stays::before_control:
      return "what comes next is the control's decision";
    case Stays::calculated:
      return "its words hold parameters or expressions";
    case Stays::more_words:
      return "it does more than cut along a line or an arc";
    case Stays::feed_mode:
      return "its feed is a time (G93)";
    case Stays::compensated:
      return "cutter radius compensation is on";
    case Stays::diameter:
      return "X is a diameter";
    case Stays::framed:
      return "its words are mirrored, scaled, turned or polar (G51.1, G51, G68, G16)";
    case Stays::rotary:
      return "an axis beyond X, Y and Z moves";
    case Stays::spline:
      return "it is a spline or a canned cycle";
    case Stays::locked:
      return "no feed override acts on it";
    case Stays::too_long:
      return "the line is too long to be kept as a comment";
    case Stays::motion_needed:
      return "the next block takes its motion word from it";
    case Stays::line_needed:
      return "it is the first move after G40, which must be straight";
    case Stays::beside:
      return "a rotation has changed under G52 or G92, and the control does not count with where "
             "the machine is";
    case Stays::unproved:
      return "no proof was found for what would replace it";
  }
  return {};
}

}  // namespace steadyrest::nc::rewrite
