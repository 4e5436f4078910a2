// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include <steadyrest/nc/interpret/decode/codes.hpp>

namespace steadyrest::nc::interpret {
namespace {

// Codes are the word times ten: G54 is 540, G59.1 is 591. The modal groups are those of RS274/NGC
// (NISTIR 6556) with LinuxCNC's additions: a block takes one word of each group.
struct Range {
  int first;
  int last;
  GGroup group;
};

constexpr std::array kGroups = {
    Range{g::kRapid, g::kRapid, GGroup::motion},
    Range{g::kLinear, g::kLinear, GGroup::motion},
    Range{g::kArcClockwise, g::kArcClockwise, GGroup::motion},
    Range{g::kArcCounterClockwise, g::kArcCounterClockwise, GGroup::motion},
    Range{g::kDwell, g::kDwell, GGroup::non_modal},
    Range{g::kDiameter, g::kDiameter, GGroup::lathe_diameter},
    Range{g::kRadius, g::kRadius, GGroup::lathe_diameter},
    Range{g::kSetData, g::kSetData, GGroup::non_modal},
    Range{g::kPlaneXy, g::kPlaneXy, GGroup::plane},
    Range{g::kPlaneZx, g::kPlaneZx, GGroup::plane},
    Range{g::kPlaneYz, g::kPlaneYz, GGroup::plane},
    Range{g::kInch, g::kInch, GGroup::units},
    Range{g::kMillimetre, g::kMillimetre, GGroup::units},
    Range{g::kHome, g::kStoreHome, GGroup::non_modal},
    Range{g::kSecondHome, g::kStoreSecondHome, GGroup::non_modal},
    Range{g::kThread, g::kRigidTap, GGroup::motion},
    Range{g::kCubicSpline, g::kSplineEnd, GGroup::motion},
    Range{g::kThreadCycle, g::kThreadCycle, GGroup::motion},
    Range{g::kProbeOrFail, g::kProbeAway, GGroup::motion},
    Range{g::kCutterOff, g::kCutterOff, GGroup::cutter},
    Range{g::kCutterLeft, g::kCutterLeftBy, GGroup::cutter},
    Range{g::kCutterRight, g::kCutterRightBy, GGroup::cutter},
    Range{g::kToolLength, g::kAddToolLength, GGroup::tool_length},
    Range{g::kToolLengthOff, g::kToolLengthOff, GGroup::tool_length},
    Range{g::kShift, g::kShift, GGroup::non_modal},
    Range{g::kMachineFrame, g::kMachineFrame, GGroup::non_modal},
    Range{g::kWorkOffset1, g::kWorkOffset1, GGroup::work_offset},
    Range{g::kWorkOffset2, g::kWorkOffset2, GGroup::work_offset},
    Range{g::kWorkOffset3, g::kWorkOffset3, GGroup::work_offset},
    Range{g::kWorkOffset4, g::kWorkOffset4, GGroup::work_offset},
    Range{g::kWorkOffset5, g::kWorkOffset5, GGroup::work_offset},
    Range{g::kWorkOffset6, g::kWorkOffset9, GGroup::work_offset},
    Range{g::kExactPath, g::kExactStop, GGroup::path_mode},
    Range{g::kContinuous, g::kContinuous, GGroup::path_mode},
    Range{g::kBreakChips, g::kBreakChips, GGroup::motion},
    Range{g::kTapLeft, g::kTapLeft, GGroup::motion},
    Range{g::kCycleEnd, g::kCycleEnd, GGroup::motion},
    Range{g::kDrill, g::kDrill, GGroup::motion},
    Range{g::kDrillDwell, g::kDrillDwell, GGroup::motion},
    Range{g::kPeck, g::kPeck, GGroup::motion},
    Range{g::kTapRight, g::kTapRight, GGroup::motion},
    Range{g::kBoreFeedOut, g::kBoreFeedOut, GGroup::motion},
    Range{g::kBoreStopOut, g::kBoreStopOut, GGroup::motion},
    Range{g::kBackBore, g::kBackBore, GGroup::motion},
    Range{g::kBoreHandOut, g::kBoreHandOut, GGroup::motion},
    Range{g::kBoreDwell, g::kBoreDwell, GGroup::motion},
    Range{g::kAbsolute, g::kAbsolute, GGroup::distance},
    Range{g::kCentreAbsolute, g::kCentreAbsolute, GGroup::arc_centre},
    Range{g::kIncremental, g::kIncremental, GGroup::distance},
    Range{g::kCentreIncremental, g::kCentreIncremental, GGroup::arc_centre},
    Range{g::kSetOrigin, g::kOriginOn, GGroup::non_modal},
    Range{g::kInverseTime, g::kInverseTime, GGroup::feed_mode},
    Range{g::kPerMinute, g::kPerMinute, GGroup::feed_mode},
    Range{g::kPerRevolution, g::kPerRevolution, GGroup::feed_mode},
    Range{g::kCuttingSpeed, g::kCuttingSpeed, GGroup::spindle_mode},
    Range{g::kSpindleSpeed, g::kSpindleSpeed, GGroup::spindle_mode},
    Range{g::kRetractToInitial, g::kRetractToInitial, GGroup::retract},
    Range{g::kRetractToR, g::kRetractToR, GGroup::retract},
};

constexpr std::size_t kCodes = 1000;
constexpr std::uint8_t kUnknown = 0xff;

// One entry for each code up to G99.9, filled in at compile time: a G word costs one look-up.
constexpr auto kGroupOfG = [] {
  std::array<std::uint8_t, kCodes> table{};
  table.fill(kUnknown);
  for (const Range& range : kGroups) {
    for (int code = range.first; code <= range.last; ++code) {
      table[static_cast<std::size_t>(code)] = static_cast<std::uint8_t>(range.group);
    }
  }
  return table;
}();

struct RefusedRange {
  int first;
  int last;
  std::string_view text;
};

// Known words that are not interpreted get their own text, so that nobody looks for a typing error.
constexpr std::array kRefusedG = {
    RefusedRange{g::kCutterLeft, g::kCutterLeftBy,
                 "cutter radius compensation (G41) is not interpreted; let the CAM system "
                 "compensate"},
    RefusedRange{g::kCutterRight, g::kCutterRightBy,
                 "cutter radius compensation (G42) is not interpreted; let the CAM system "
                 "compensate"},
    RefusedRange{700, 722, "a lathe cycle is not interpreted"},
};

constexpr std::array kRefusedM = {
    RefusedRange{m::kOrient, m::kOrient,
                 "spindle orientation (M19) is not interpreted in this dialect"},
    RefusedRange{m::kOutputOnWithMove, m::kKeepModesForCall,
                 "M62-M73 are not interpreted in this dialect"},
    RefusedRange{m::kCall, m::kReturn,
                 "a subprogram call or return (M98, M99) is not interpreted in this dialect"},
    RefusedRange{100, 199, "user-defined M words (M100-M199) depend on the machine"},
};

}  // namespace

// One look-up; anything outside the table is unknown.
GroupOfG group_of_g(int code) noexcept {
  if (code < 0 || code >= static_cast<int>(kCodes)) {
    return {};
  }
  const std::uint8_t group = kGroupOfG[static_cast<std::size_t>(code)];
  return {.known = group != kUnknown, .group = static_cast<GGroup>(group)};
}

// M words are few and close together, hence a switch. M98 and M99 form a group, since a block
// either calls or returns.
GroupOfM group_of_m(int code) noexcept {
  switch (code) {
    case m::kStop:
    case m::kOptionalStop:
    case m::kEnd:
    case m::kEndAndRewind:
    case m::kPalletStop:
      return {.known = true, .group = MGroup::stopping};
    case m::kToolChange:
    case m::kToolInSpindle:
      return {.known = true, .group = MGroup::tool_change};
    case m::kClockwise:
    case m::kCounterClockwise:
    case m::kSpindleStop:
    case m::kOrient:
      return {.known = true, .group = MGroup::spindle};
    case m::kMist:
    case m::kFlood:
    case m::kCoolantOff:
      return {.known = true, .group = MGroup::coolant};
    case m::kOverridesOn:
    case m::kOverridesOff:
    case m::kFeedOverride:
    case m::kSpindleOverride:
    case m::kAdaptiveFeed:
    case m::kFeedHold:
      return {.known = true, .group = MGroup::override_switch};
    case m::kOutputOnWithMove:
    case m::kOutputOffWithMove:
    case m::kOutputOn:
    case m::kOutputOff:
    case m::kWaitForInput:
    case m::kAnalogWithMove:
    case m::kAnalog:
      return {.known = true, .group = MGroup::io};
    case m::kKeepModes:
    case m::kForgetModes:
    case m::kRestoreModes:
    case m::kKeepModesForCall:
      return {.known = true, .group = MGroup::modes};
    case m::kCall:
    case m::kReturn:
      return {.known = true, .group = MGroup::program};
    default:
      return {};
  }
}

// Empty for an unknown code. Only refusals come here, so a search will do.
std::string_view known_but_refused_g(int code) noexcept {
  for (const RefusedRange& note : kRefusedG) {
    if (code >= note.first && code <= note.last) {
      return note.text;
    }
  }
  return {};
}

std::string_view known_but_refused_m(int code) noexcept {
  for (const RefusedRange& note : kRefusedM) {
    if (code >= note.first && code <= note.last) {
      return note.text;
    }
  }
  return {};
}

}  // namespace steadyrest::nc::interpret
