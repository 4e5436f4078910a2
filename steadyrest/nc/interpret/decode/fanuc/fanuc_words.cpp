// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/decode/fanuc/fanuc_words.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::string_view kNotRead = "g_code_not_interpreted";
constexpr std::string_view kSkip = "in this dialect probing is a macro of the control (G31)";
constexpr std::string_view kDecimals =
    "this decimal G word means something different, or nothing, on each control";

// The texts name FANUC's function of a code where it differs from LinuxCNC's.
constexpr FanucNote kFamilyG[] = {
    {g::kSplinePoint, g::kSplinePoint, kNotRead, "G5.2 is not interpreted"},
    {g::kSplineEnd, g::kSplineEnd, kNotRead, "G5.3 is not interpreted"},
    {g::kDiameter, g::kDiameter, kNotRead, "G7/G07 means something different on every control"},
    {71, 71, kNotRead,
     "cylindrical interpolation (G7.1) is not interpreted; G0 to G3 in X, Y and Z are"},
    {121, 121, kNotRead, "polar coordinate interpolation (G12.1) is not interpreted"},
    {270, 270, kNotRead, "the reference check (G27) is not interpreted"},
    {290, 290, kNotRead, "the return from the reference point (G29) is not interpreted"},
    {310, 310, kNotRead, "a skip move (G31) ends where the machine decides"},
    {320, 320, "lathe_code", "G32 threads on a lathe; lathe programs are not interpreted"},
    {g::kThread, g::kThread, "ambiguous_code",
     "G33 takes F as pitch here; its rounding differs between controls"},
    {g::kRigidTap, g::kRigidTap, "ambiguous_code", "G33.1 is no code of this dialect"},
    {g::kProbeOrFail, g::kProbeAway, kNotRead, kSkip},
    {434, 435, kNotRead, "tool centre point control (G43.4, G43.5) is not interpreted"},
    {630, 630, kNotRead, "tapping mode (G63) is not interpreted; G84 is"},
    {650, 650, "macro_call", "a macro call (G65) is not interpreted"},
    {660, 660, "macro_call", "a modal macro call (G66) is not interpreted"},
    {670, 670, "macro_call", "the end of a modal macro call (G67) is not interpreted"},
    {682, 682, kNotRead, "a tilted plane (G68.2) is not interpreted"},
    {521, 521, "ambiguous_code", kDecimals},
    {g::kStoreHome, g::kStoreHome, "ambiguous_code", kDecimals},
    {g::kStoreSecondHome, g::kStoreSecondHome, "ambiguous_code", kDecimals},
    {g::kToolLengthByWords, g::kAddToolLength, "ambiguous_code", kDecimals},
    {g::kWorkOffset7, g::kWorkOffset9, "ambiguous_code", kDecimals},
    {g::kExactStop, g::kExactStop, "ambiguous_code", kDecimals},
    {g::kCentreAbsolute, g::kCentreAbsolute, "ambiguous_code", kDecimals},
    {g::kCentreIncremental, g::kCentreIncremental, "ambiguous_code", kDecimals},
    {g::kForgetOrigin, g::kOriginOn, "ambiguous_code", kDecimals},
};

constexpr FanucNote kFanucG[] = {
    // Haas alone has these as words of a mill.
    {g::kPocketClockwise, g::kPocketCounterClockwise, kNotRead,
     "G12 and G13 are circular pockets on a Haas; choose that dialect if it is one"},
    {g::kHolesOnCircle, g::kHolesOnLine, "lathe_code",
     "G70 to G72 are lathe cycles, or bolt patterns on a Haas; choose that dialect if it is one"},
};

constexpr FanucNote kHaasG[] = {
    {g::kPocketClockwise, g::kPocketCounterClockwise, kNotRead,
     "the circular pocket (G12, G13) is not interpreted: the manual does not state its way in"},
    {350, 370, kNotRead, "automatic tool measuring (G35, G36, G37) ends where the machine decides"},
    {470, 470, kNotRead, "text engraving (G47) is not interpreted"},
    {770, 770, kNotRead, "back boring (G77) is not interpreted"},
    {1360, 1360, kNotRead, "automatic work offset measuring (G136) ends where the machine decides"},
    {1410, 1410, kNotRead, "3D+ cutter compensation (G141) is not interpreted"},
    {1430, 1430, kNotRead, "5-axis tool length (G143) is not interpreted"},
    {1500, 1500, kNotRead, "general pocket milling (G150) is not interpreted"},
    {1530, 1530, kNotRead, "5-axis drilling cycles (G153 to G169) are not interpreted"},
    {1550, 1690, kNotRead, "5-axis drilling cycles (G153 to G169) are not interpreted"},
    {1740, 1840, kNotRead, "non-vertical rigid tapping (G174, G184) is not interpreted"},
    {2340, 2340, kNotRead, "tool centre point control (G234) is not interpreted"},
    {2530, 2540, kNotRead, "work offsets of a turned table (G253, G254) are not interpreted"},
    {2680, 2680, kNotRead, "feature coordinates (G268) are not interpreted"},
};

constexpr FanucQuietG kFamilyQuietG[] = {
    {g::kCubicSpline, "P"},        // G05 P: high-speed machining, on or off
    {g::kQuadraticSpline, "QRP"},  // G05.1 Q: AI contour control, smoothing
    {g::kRadius, "P"},             // G08 P: look-ahead
    {131, ""},                     // G13.1: no polar interpolation
    {220, ""},                     // stored stroke check, with the limits in force
    {230, ""},
    {250, ""},  // spindle speed fluctuation detection
    {260, "PQR"},
    {502, ""},  // no polygon turning
};

constexpr FanucQuietG kHaasQuietG[] = {
    {1030, "P"},   // G103: how many blocks are read ahead
    {1870, "PE"},  // G187: smoothness level, corner rounding
    {2550, ""},    // G255, G269: off what G254 and G268 would switch on
    {2690, ""},
};

// FANUC leaves nearly all numbers to the machine builder. These are the usual ones of machining
// centres and mean nothing to the program: clamps of the fourth axis, orientation of the spindle.
constexpr FanucQuietM kFanucQuietM[] = {{10, 11}};

// Haas, mill operator's manual, "M-codes".
constexpr FanucQuietM kHaasQuietM[] = {
    {10, 13},    // brakes of the fourth and fifth axis
    {31, 36},    // chip conveyor, coolant spigot, pallet part ready
    {41, 42},    // gear override
    {73, 74},    // tip clean, tool air blast
    {76, 77},    // displays
    {78, 79},    // alarm with or without a skip signal
    {80, 81},    // door
    {83, 86},    // air gun, door
    {88, 89},    // coolant through the spindle
    {93, 94},    // position capture
    {104, 105},  // probe arm
    {115, 117},  // fluid and chip handling
    {130, 131},  // media display
    {158, 159},  // mist condenser
    {160, 163},  // minimum quantity lubrication
};

constexpr FanucNote kFanucM[] = {
    {50, 53, "machine_builders_code", "an M word whose meaning depends on the machine builder"},
    {60, 61, "machine_builders_code", "an M word whose meaning depends on the machine builder"},
};

constexpr FanucNote kHaasM[] = {
    {16, 16, "m_code_not_interpreted", "the tool change M16 is not interpreted; M6 is"},
    {21, 28, "machine_builders_code", "M21 to M28 are user functions: what they do is wired"},
    {39, 39, "m_code_not_interpreted", "turning the tool carousel (M39) is not interpreted"},
    {46, 46, "flow_control", "a jump by the pallet (M46) is not interpreted"},
    {50, 70, "machine_builders_code",
     "M50 to M70 change pallets and switch user relays: what they do is wired"},
    {82, 82, "m_code_not_interpreted", "unclamping the tool (M82) is not interpreted"},
    {95, 95, "m_code_not_interpreted", "sleep mode (M95) is not interpreted"},
    {96, 96, "flow_control", "a jump by an input (M96) is not interpreted"},
    {97, 97, "flow_control", "a call of lines of the same program (M97) is not interpreted"},
    {109, 109, "m_code_not_interpreted", "what the operator enters (M109) is not known here"},
};

}  // namespace

const FanucVariant& fanuc_variant() noexcept {
  static constexpr FanucVariant kVariant{.g_notes = kFanucG,
                                         .m_notes = kFanucM,
                                         .quiet_g = {},
                                         .quiet_m = kFanucQuietM,
                                         .most_offsets = 300,
                                         .haas_words = false,
                                         .dwell_by_point = false,
                                         .k_repeats = true,
                                         .point_matters = false,
                                         .homes_all_axes = false,
                                         .machine_frame_is_rapid = true};
  return kVariant;
}

const FanucVariant& haas_variant() noexcept {
  static constexpr FanucVariant kVariant{.g_notes = kHaasG,
                                         .m_notes = kHaasM,
                                         .quiet_g = kHaasQuietG,
                                         .quiet_m = kHaasQuietM,
                                         .most_offsets = 99,
                                         .haas_words = true,
                                         .dwell_by_point = true,
                                         .k_repeats = false,
                                         .point_matters = true,
                                         .homes_all_axes = true,
                                         .machine_frame_is_rapid = false};
  return kVariant;
}

std::span<const FanucNote> family_notes() noexcept {
  return kFamilyG;
}

std::span<const FanucQuietG> family_quiet() noexcept {
  return kFamilyQuietG;
}

}  // namespace steadyrest::nc::interpret
