// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

/// The G and M words of a `Step` by name. Numbers are LinuxCNC's, whatever the dialect; those of G
/// words are times ten (G43.1 = 431).
namespace steadyrest::nc::interpret {

namespace g {

using Code = std::int16_t;

/// The code of a G word's number; −1 where it is not one. Tenths with a tolerance, since 59.1·10 is
/// not exactly 591 in binary; RS274/NGC allows 0.0001.
[[nodiscard]] inline int code_of(double number) noexcept {
  const double tenfold = number * 10.0;
  const double code = std::round(tenfold);
  const bool is = code >= 0.0 && code < 1e5 && std::abs(tenfold - code) <= 1e-3;
  return is ? static_cast<int>(code) : -1;
}

// motion
inline constexpr Code kRapid = 0;
inline constexpr Code kLinear = 10;
inline constexpr Code kArcClockwise = 20;
inline constexpr Code kArcCounterClockwise = 30;
inline constexpr Code kCubicSpline = 50;      ///< G5
inline constexpr Code kQuadraticSpline = 51;  ///< G5.1
inline constexpr Code kSplinePoint = 52;      ///< G5.2
inline constexpr Code kSplineEnd = 53;        ///< G5.3
inline constexpr Code kThread = 330;
inline constexpr Code kRigidTap = 331;
inline constexpr Code kProbeOrFail = 382;  ///< G38.2
inline constexpr Code kProbe = 383;
inline constexpr Code kProbeAwayOrFail = 384;
inline constexpr Code kProbeAway = 385;
inline constexpr Code kThreadCycle = 760;
inline constexpr Code kBreakChips = 730;  ///< G73
inline constexpr Code kTapLeft = 740;
inline constexpr Code kCycleEnd = 800;
inline constexpr Code kDrill = 810;
inline constexpr Code kDrillDwell = 820;
inline constexpr Code kPeck = 830;
inline constexpr Code kTapRight = 840;
inline constexpr Code kBoreFeedOut = 850;
inline constexpr Code kBoreStopOut = 860;
inline constexpr Code kBackBore = 870;
inline constexpr Code kBoreHandOut = 880;
inline constexpr Code kBoreDwell = 890;

// once
inline constexpr Code kDwell = 40;
inline constexpr Code kSetData = 100;  ///< G10
inline constexpr Code kHome = 280;
inline constexpr Code kStoreHome = 281;
inline constexpr Code kSecondHome = 300;
inline constexpr Code kStoreSecondHome = 301;
inline constexpr Code kShift = 520;
inline constexpr Code kMachineFrame = 530;
inline constexpr Code kSetOrigin = 920;  ///< G92
inline constexpr Code kForgetOrigin = 921;
inline constexpr Code kOriginOff = 922;
inline constexpr Code kOriginOn = 923;

// modes
inline constexpr Code kDiameter = 70;
inline constexpr Code kRadius = 80;
inline constexpr Code kPlaneXy = 170;
inline constexpr Code kPlaneZx = 180;
inline constexpr Code kPlaneYz = 190;
inline constexpr Code kInch = 200;
inline constexpr Code kMillimetre = 210;
inline constexpr Code kCutterOff = 400;
inline constexpr Code kCutterLeft = 410;
inline constexpr Code kCutterLeftBy = 411;  ///< G41.1: D is the diameter
inline constexpr Code kCutterRight = 420;
inline constexpr Code kCutterRightBy = 421;
inline constexpr Code kToolLength = 430;
inline constexpr Code kToolLengthByWords = 431;  ///< G43.1
inline constexpr Code kAddToolLength = 432;      ///< G43.2
inline constexpr Code kToolLengthOff = 490;
inline constexpr Code kWorkOffset1 = 540;
inline constexpr Code kWorkOffset2 = 550;
inline constexpr Code kWorkOffset3 = 560;
inline constexpr Code kWorkOffset4 = 570;
inline constexpr Code kWorkOffset5 = 580;
inline constexpr Code kWorkOffset6 = 590;
inline constexpr Code kWorkOffset7 = 591;  ///< G59.1
inline constexpr Code kWorkOffset8 = 592;
inline constexpr Code kWorkOffset9 = 593;
/// fanuc G54.1 P, haas G154 P, G110 …: see FanucWords::offset. Not in the table of groups.
inline constexpr Code kMoreOffsets = 541;
inline constexpr Code kExactPath = 610;
inline constexpr Code kExactStop = 611;  ///< G61.1
inline constexpr Code kContinuous = 640;
inline constexpr Code kAbsolute = 900;
inline constexpr Code kCentreAbsolute = 901;
inline constexpr Code kIncremental = 910;
inline constexpr Code kCentreIncremental = 911;
inline constexpr Code kInverseTime = 930;
inline constexpr Code kPerMinute = 940;
inline constexpr Code kPerRevolution = 950;
inline constexpr Code kCuttingSpeed = 960;
inline constexpr Code kSpindleSpeed = 970;
inline constexpr Code kRetractToInitial = 980;
inline constexpr Code kRetractToR = 990;

// of the fanuc family: in FanucWords, not in the table of groups
inline constexpr Code kPocketClockwise = 120;         ///< haas G12
inline constexpr Code kPocketCounterClockwise = 130;  ///< haas G13
inline constexpr Code kPolarOff = 150;
inline constexpr Code kPolarOn = 160;
inline constexpr Code kToolLengthNegative = 440;
/// G76 and G87, which shift by Q: numbers of our own among the cycles.
inline constexpr Code kFineBore = 861;
inline constexpr Code kBackBoreByShift = 871;
inline constexpr Code kScalingOff = 500;
inline constexpr Code kMirrorOff = 501;
inline constexpr Code kScaling = 510;
inline constexpr Code kMirror = 511;
inline constexpr Code kRotation = 680;
inline constexpr Code kRotationOff = 690;
inline constexpr Code kHolesOnCircle = 700;  ///< haas G70
inline constexpr Code kHolesOnArc = 710;
inline constexpr Code kHolesOnLine = 720;

}  // namespace g

/// Place of a work offset among them, by its code: G54 … G59 are 540, 550, … 590; G59.1 … G59.3 are
/// 591, 592, 593.
[[nodiscard]] constexpr std::size_t place_of_offset(int code) noexcept {
  return static_cast<std::size_t>(code <= g::kWorkOffset6 ? (code - g::kWorkOffset1) / 10
                                                          : 5 + (code - g::kWorkOffset6));
}

namespace m {

using Code = std::int16_t;

inline constexpr Code kStop = 0;
inline constexpr Code kOptionalStop = 1;
inline constexpr Code kEnd = 2;
inline constexpr Code kEndAndRewind = 30;
inline constexpr Code kPalletStop = 60;
inline constexpr Code kClockwise = 3;
inline constexpr Code kCounterClockwise = 4;
inline constexpr Code kSpindleStop = 5;
inline constexpr Code kOrient = 19;
inline constexpr Code kToolChange = 6;
inline constexpr Code kToolInSpindle = 61;
inline constexpr Code kMist = 7;
inline constexpr Code kFlood = 8;
inline constexpr Code kCoolantOff = 9;
inline constexpr Code kOverridesOn = 48;
inline constexpr Code kOverridesOff = 49;
inline constexpr Code kFeedOverride = 50;
inline constexpr Code kSpindleOverride = 51;
inline constexpr Code kAdaptiveFeed = 52;
inline constexpr Code kFeedHold = 53;
inline constexpr Code kOutputOnWithMove = 62;
inline constexpr Code kOutputOffWithMove = 63;
inline constexpr Code kOutputOn = 64;
inline constexpr Code kOutputOff = 65;
inline constexpr Code kWaitForInput = 66;
inline constexpr Code kAnalogWithMove = 67;
inline constexpr Code kAnalog = 68;
inline constexpr Code kKeepModes = 70;
inline constexpr Code kForgetModes = 71;
inline constexpr Code kRestoreModes = 72;
inline constexpr Code kKeepModesForCall = 73;
inline constexpr Code kCall = 98;
inline constexpr Code kReturn = 99;

}  // namespace m

}  // namespace steadyrest::nc::interpret
