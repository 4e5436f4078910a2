// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

// Words of the language that are not interpreted are refused for what they are, not as unknown
// names, so that nobody looks for a subprogram of that name.
constexpr std::array kRefusedNames = {
    RefusedName{"IF", "flow_control", "a condition (IF)"},
    RefusedName{"ELSE", "flow_control", "a condition (ELSE)"},
    RefusedName{"ENDIF", "flow_control", "a condition (ENDIF)"},
    RefusedName{"FOR", "flow_control", "a loop (FOR)"},
    RefusedName{"ENDFOR", "flow_control", "a loop (ENDFOR)"},
    RefusedName{"WHILE", "flow_control", "a loop (WHILE)"},
    RefusedName{"ENDWHILE", "flow_control", "a loop (ENDWHILE)"},
    RefusedName{"LOOP", "flow_control", "a loop (LOOP)"},
    RefusedName{"ENDLOOP", "flow_control", "a loop (ENDLOOP)"},
    RefusedName{"REPEAT", "flow_control", "a loop (REPEAT)"},
    RefusedName{"UNTIL", "flow_control", "a loop (UNTIL)"},
    RefusedName{"CASE", "flow_control", "a branch (CASE)"},
    RefusedName{"GOTO", "flow_control", "a jump (GOTO)"},
    RefusedName{"GOTOF", "flow_control", "a jump (GOTOF)"},
    RefusedName{"GOTOB", "flow_control", "a jump (GOTOB)"},
    RefusedName{"REPEATB", "flow_control", "a loop (REPEATB)"},
    RefusedName{"GOTOC", "flow_control", "a jump (GOTOC)"},
    RefusedName{"GOTOS", "flow_control", "a jump (GOTOS)"},
    RefusedName{"CALL", "subprogram_call", "an indirect call (CALL) is not interpreted"},
    RefusedName{"PCALL", "subprogram_call", "a call by path (PCALL) is not interpreted"},
    RefusedName{"ASCALE", "frame", "a programmed frame (ASCALE) is not interpreted"},
    RefusedName{"AMIRROR", "frame", "a programmed frame (AMIRROR) is not interpreted"},
    RefusedName{"ROTS", "frame", "a programmed frame (ROTS) is not interpreted"},
    RefusedName{"AROTS", "frame", "a programmed frame (AROTS) is not interpreted"},
    RefusedName{"SCALE", "frame", "a programmed frame (SCALE) is not interpreted"},
    RefusedName{"MIRROR", "frame", "a programmed frame (MIRROR) is not interpreted"},
    RefusedName{"TRAORI", "transformation", "a transformation (TRAORI) is not interpreted"},
    RefusedName{"TRANSMIT", "transformation", "a transformation (TRANSMIT) is not interpreted"},
    RefusedName{"TRACYL", "transformation", "a transformation (TRACYL) is not interpreted"},
    RefusedName{"A2", "orientation", "a tool orientation (A2=) is not interpreted"},
    RefusedName{"B2", "orientation", "a tool orientation (B2=) is not interpreted"},
    RefusedName{"C2", "orientation", "a tool orientation (C2=) is not interpreted"},
    RefusedName{"A3", "orientation", "a tool orientation (A3=) is not interpreted"},
    RefusedName{"B3", "orientation", "a tool orientation (B3=) is not interpreted"},
    RefusedName{"C3", "orientation", "a tool orientation (C3=) is not interpreted"},
    RefusedName{"LEAD", "orientation", "a tool orientation (LEAD) is not interpreted"},
    RefusedName{"TILT", "orientation", "a tool orientation (TILT) is not interpreted"},
    RefusedName{"RND", "corner", "a rounded corner (RND) is not interpreted"},
    RefusedName{"RNDM", "corner", "rounded corners (RNDM) are not interpreted"},
    RefusedName{"CHF", "corner", "a chamfer (CHF) is not interpreted"},
    RefusedName{"CHR", "corner", "a chamfer (CHR) is not interpreted"},
    RefusedName{"WAITM", "channels", "waiting for another channel (WAITM) is not interpreted"},
    RefusedName{"WAITMC", "channels", "waiting for another channel (WAITMC) is not interpreted"},
};

// Words of the language without a text of their own.
constexpr auto kOtherWords = std::to_array<std::string_view>(
    {"ACN",     "ACP",      "ASPLINE", "BAUTO",   "BNAT",     "BSPLINE",  "BTAN",    "CANCEL",
     "CFINE",   "CLEARM",   "CORROF",  "CPRECOF", "CPRECON",  "CRPL",     "CSPLINE", "CTRANS",
     "DC",      "DELDTG",   "DIAM90",  "DIAM90A", "DISC",     "DISCL",    "DISR",    "DITE",
     "DITS",    "DL",       "DO",      "DRFOF",   "EAUTO",    "ENAT",     "ETAN",    "EVERY",
     "FA",      "FAD",      "FB",      "FD",      "FENDNORM", "FP",       "FPO",     "FPR",
     "FPRAOF",  "FPRAON",   "FRC",     "FRCM",    "FXS",      "FXST",     "FXSW",    "FZ",
     "GEOAX",   "ID",       "IDS",     "INVCCW",  "INVCW",    "LIFTFAST", "MEAC",    "MEAS",
     "MEASA",   "MEAW",     "MEAWA",   "NEWCONF", "OFFN",     "ORIC",     "ORID",    "ORIPATH",
     "OVR",     "OVRA",     "OVRRAP",  "PAROT",   "PAROTOF",  "PL",       "POLY",    "POS",
     "POSA",    "PRESETON", "PTP",     "PW",      "SCC",      "SETINT",   "SYNFCT",  "TCARR",
     "TOFRAME", "TOROT",    "TRAILOF", "TRAILON", "WAITP",    "WAITS",    "WHEN",    "WHENEVER"});

}  // namespace

// The control does not tell case apart; the tables are in capitals.
bool equal(std::string_view text, std::string_view upper_name) noexcept {
  return std::ranges::equal(text, upper_name, {}, upper);
}

bool known_name(std::string_view name) noexcept {
  return named_word(name) != nullptr;
}

const RefusedName* refused_name(std::string_view name) noexcept {
  const auto* const found = std::ranges::find_if(
      kRefusedNames, [&](const RefusedName& refused) { return equal(name, refused.name); });
  if (found != kRefusedNames.end()) {
    return found;
  }
  static constexpr RefusedName kOther{"", "unknown_word",
                                      "a word of the language that is not interpreted"};
  const bool other =
      std::ranges::any_of(kOtherWords, [&](std::string_view word) { return equal(name, word); });
  return other ? &kOther : nullptr;
}

}  // namespace steadyrest::nc::read
