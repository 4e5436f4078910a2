// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/nc/read/heidenhain/klartext_words.hpp>

namespace steadyrest::nc::read {

// Each is named by what it does, so that nobody looks for a typing error.
const RefusedFunction* refused_function(std::string_view upper_name) noexcept {
  static constexpr std::array kRefused = {
      RefusedFunction{"LN", "tool_normal", "a line with a surface normal (LN) is not interpreted"},
      RefusedFunction{"SPL", "spline", "a spline (SPL) is not interpreted"},
      RefusedFunction{"APPR", "approach",
                      "an approach (APPR) is not interpreted; write its lines and arcs"},
      RefusedFunction{"DEP", "departure",
                      "a departure (DEP) is not interpreted; write its lines and arcs"},
      RefusedFunction{"PLANE", "tilted_plane", "a tilted working plane (PLANE) is not interpreted"},
      RefusedFunction{"FUNCTION", "function", "FUNCTION blocks are not interpreted"},
      RefusedFunction{"TCH", "probing", "touch probe cycles (TCH PROBE) are not interpreted"},
      RefusedFunction{"PATTERN", "pattern", "point patterns (PATTERN DEF) are not interpreted"},
      RefusedFunction{"SEL", "selection",
                      "SEL blocks (table, pattern, contour or program by "
                      "name) are not interpreted"},
      RefusedFunction{"CONTOUR", "contour", "contour definitions are not interpreted"},
      RefusedFunction{"DECLARE", "contour", "contour definitions are not interpreted"},
      RefusedFunction{"FPOL", "free_contour", "free contours (FK) are not interpreted"},
      RefusedFunction{"FSELECT", "free_contour", "free contours (FK) are not interpreted"},
      RefusedFunction{"FL", "free_contour", "free contours (FK) are not interpreted"},
      RefusedFunction{"FLT", "free_contour", "free contours (FK) are not interpreted"},
      RefusedFunction{"FC", "free_contour", "free contours (FK) are not interpreted"},
      RefusedFunction{"FCT", "free_contour", "free contours (FK) are not interpreted"},
      RefusedFunction{"GLOBAL", "global_definition", "GLOBAL DEF is not interpreted"},
      RefusedFunction{"POLARKIN", "kinematics", "polar kinematics are not interpreted"},
      RefusedFunction{"OPEN", "file", "files (OPEN, FILE) are not interpreted"},
      RefusedFunction{"QS", "string", "string parameters (QS) are not interpreted"},
      RefusedFunction{"IF", "flow_control", "IF blocks are not interpreted; FN 9 to FN 12 are"},
      RefusedFunction{"FOR", "flow_control", "loops (FOR) are not interpreted"},
      RefusedFunction{"WHILE", "flow_control", "loops (WHILE) are not interpreted"},
      RefusedFunction{"ERROR", "damaged_block",
                      "a block that the control itself has marked as wrong"},
  };
  const auto* const found = std::ranges::find(kRefused, upper_name, &RefusedFunction::name);
  return found == kRefused.end() ? nullptr : found;
}

}  // namespace steadyrest::nc::read
