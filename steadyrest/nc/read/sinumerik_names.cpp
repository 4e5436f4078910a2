// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/nc/read/character.hpp>
#include <steadyrest/nc/read/sinumerik_names.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr std::array<std::string_view, 11> kKnownNames = {
    "CR", "TURN", "SUPA", "ADIS", "ADISPOS", "FNORM", "CFC", "CFTCP", "CFIN", "FFWOF", "SOFT"};

constexpr std::array kRefusedNames = {
    RefusedName{"DEF", "definition", "the definition of a variable (DEF); variables are not read"},
    RefusedName{"PROC", "definition", "the head of a subprogram (PROC)"},
    RefusedName{"EXTERN", "definition", "the declaration of a subprogram (EXTERN)"},
    RefusedName{"IF", "control_structure", "a condition (IF)"},
    RefusedName{"ELSE", "control_structure", "a condition (ELSE)"},
    RefusedName{"ENDIF", "control_structure", "a condition (ENDIF)"},
    RefusedName{"FOR", "control_structure", "a loop (FOR)"},
    RefusedName{"ENDFOR", "control_structure", "a loop (ENDFOR)"},
    RefusedName{"WHILE", "control_structure", "a loop (WHILE)"},
    RefusedName{"ENDWHILE", "control_structure", "a loop (ENDWHILE)"},
    RefusedName{"LOOP", "control_structure", "a loop (LOOP)"},
    RefusedName{"ENDLOOP", "control_structure", "a loop (ENDLOOP)"},
    RefusedName{"REPEAT", "control_structure", "a loop (REPEAT)"},
    RefusedName{"UNTIL", "control_structure", "a loop (UNTIL)"},
    RefusedName{"CASE", "control_structure", "a branch (CASE)"},
    RefusedName{"GOTO", "control_structure", "a jump (GOTO)"},
    RefusedName{"GOTOF", "control_structure", "a jump (GOTOF)"},
    RefusedName{"GOTOB", "control_structure", "a jump (GOTOB)"},
    RefusedName{"RET", "subprogram", "the end of a subprogram (RET)"},
    RefusedName{"MCALL", "modal_call", "a modal subprogram call (MCALL)"},
    RefusedName{"TRANS", "frame", "a programmed frame (TRANS) is not interpreted"},
    RefusedName{"ATRANS", "frame", "a programmed frame (ATRANS) is not interpreted"},
    RefusedName{"ROT", "frame", "a programmed frame (ROT) is not interpreted"},
    RefusedName{"AROT", "frame", "a programmed frame (AROT) is not interpreted"},
    RefusedName{"SCALE", "frame", "a programmed frame (SCALE) is not interpreted"},
    RefusedName{"MIRROR", "frame", "a programmed frame (MIRROR) is not interpreted"},
    RefusedName{"TRAFOOF", "transformation", "a transformation (TRAFOOF) is not interpreted"},
    RefusedName{"TRAORI", "transformation", "a transformation (TRAORI) is not interpreted"},
    RefusedName{"TRANSMIT", "transformation", "a transformation (TRANSMIT) is not interpreted"},
    RefusedName{"TRACYL", "transformation", "a transformation (TRACYL) is not interpreted"},
    RefusedName{"CIP", "unknown_word", "a circle through a point (CIP) is not interpreted"},
    RefusedName{"CT", "unknown_word", "a tangential circle (CT) is not interpreted"},
};

}  // namespace

bool equal(std::string_view text, std::string_view upper_name) noexcept {
  return std::ranges::equal(text, upper_name, {}, upper);
}

bool known_name(std::string_view name) noexcept {
  return std::ranges::any_of(kKnownNames,
                             [&](std::string_view known) { return equal(name, known); });
}

const RefusedName* refused_name(std::string_view name) noexcept {
  const auto* const found = std::ranges::find_if(
      kRefusedNames, [&](const RefusedName& refused) { return equal(name, refused.name); });
  return found == kRefusedNames.end() ? nullptr : found;
}

}  // namespace steadyrest::nc::read
