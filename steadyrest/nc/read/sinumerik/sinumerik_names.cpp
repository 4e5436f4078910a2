// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

// Words that the decoder knows; any other name is a variable, a call or refused.
constexpr std::array<std::string_view, 19> kKnownNames = {
    "CR",   "TURN", "SUPA",    "ADIS",  "ADISPOS", "FNORM", "CFC",  "CFTCP", "CFIN",  "FFWOF",
    "SOFT", "RET",  "TRAFOOF", "TRANS", "ATRANS",  "ROT",   "AROT", "RPL",   "STOPRE"};

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
    RefusedName{"CIP", "unknown_word", "a circle through a point (CIP) is not interpreted"},
    RefusedName{"CT", "unknown_word", "a tangential circle (CT) is not interpreted"},
};

// Words of the language without a text of their own.
constexpr auto kOtherWords = std::to_array<std::string_view>(
    {"ACC",       "ACN",     "ACP",      "ANG",       "AP",         "ASPLINE", "BAUTO",
     "BNAT",      "BRISK",   "BRISKA",   "BSPLINE",   "BTAN",       "CANCEL",  "CDOF",
     "CDON",      "CFINE",   "CHF",      "CHR",       "CLEARM",     "COMPCAD", "COMPCURV",
     "COMPOF",    "COMPON",  "COMPSURF", "CORROF",    "CPRECOF",    "CPRECON", "CRPL",
     "CSPLINE",   "CTRANS",  "CUT2D",    "CUT2DF",    "CUT3DC",     "CUT3DF",  "CUT3DFF",
     "CUT3DFS",   "DC",      "DELDTG",   "DIAM90",    "DIAMOF",     "DIAMON",  "DISC",
     "DISCL",     "DISR",    "DITE",     "DITS",      "DO",         "DRIVE",   "DRIVEA",
     "DYNFINISH", "DYNNORM", "DYNPOS",   "DYNROUGH",  "DYNSEMIFIN", "EAUTO",   "ENAT",
     "ETAN",      "EVERY",   "FA",       "FAD",       "FB",         "FCUB",    "FD",
     "FENDNORM",  "FFWON",   "FGREF",    "FGROUP",    "FIFOCTRL",   "FLIN",    "FP",
     "FPO",       "FPR",     "FPRAOF",   "FPRAON",    "FRC",        "FRCM",    "FXS",
     "FXST",      "FXSW",    "FZ",       "GEOAX",     "ID",         "IDS",     "INVCCW",
     "INVCW",     "JERKLIM", "KONT",     "KONTC",     "KONTT",      "LEAD",    "LIFTFAST",
     "LIMS",      "MEAC",    "MEAS",     "MEASA",     "MEAW",       "MEAWA",   "NEWCONF",
     "NORM",      "OFFN",    "ORIC",     "ORID",      "ORIMKS",     "ORIPATH", "ORIVECT",
     "ORIWKS",    "OSC",     "OSD",      "OSOF",      "OSS",        "OSSE",    "OST",
     "OVR",       "OVRA",    "OVRRAP",   "PAROT",     "PAROTOF",    "PL",      "POLY",
     "POS",       "POSA",    "PRESETON", "PTP",       "PW",         "RND",     "RNDM",
     "RP",        "SBLOF",   "SBLON",    "SCC",       "SETAL",      "SETINT",  "SPCOF",
     "SPCON",     "SPOS",    "SPOSA",    "STARTFIFO", "STOPFIFO",   "SYNFCT",  "TCARR",
     "TILT",      "TOFRAME", "TOROT",    "TRAILOF",   "TRAILON",    "VELOLIM", "WAITM",
     "WAITP",     "WAITS",   "WALIMOF",  "WALIMON",   "WHEN",       "WHENEVER"});

}  // namespace

// The control does not tell case apart; the tables are in capitals.
bool equal(std::string_view text, std::string_view upper_name) noexcept {
  return std::ranges::equal(text, upper_name, {}, upper);
}

// A linear search of twenty names: such words are rare in a program.
bool known_name(std::string_view name) noexcept {
  return std::ranges::any_of(kKnownNames,
                             [&](std::string_view known) { return equal(name, known); });
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

bool is_flow_word(std::string_view name) noexcept {
  const RefusedName* const refused = refused_name(name);
  return refused != nullptr && refused->reason == "flow_control";
}

}  // namespace steadyrest::nc::read
