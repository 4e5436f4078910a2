// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace steadyrest::nc::interpret {

inline constexpr int kProbe = 5061;       // … 5069; 5070 tells whether it touched
inline constexpr int kHome = 5161;        // … 5169
inline constexpr int kSecondHome = 5181;  // … 5189
inline constexpr int kG92InForce = 5210;
inline constexpr int kG92 = 5211;  // … 5219
inline constexpr int kActiveOffset = 5220;
inline constexpr int kOffsets = 5221;  // nine of twenty numbers each; the tenth is the rotation
inline constexpr int kOffsetStride = 20;
inline constexpr int kInput = 5399;  // what M66 has read
inline constexpr int kTool = 5400;
inline constexpr int kToolOffset = 5401;    // … 5409
inline constexpr int kToolDiameter = 5410;  // then front angle, back angle, orientation
inline constexpr int kPosition = 5420;      // … 5428
inline constexpr int kAxes = 9;
inline constexpr int kDebugging = 5599;     // whether (DEBUG,…) shows: 1 at the start
inline constexpr int kChangerFault = 5600;  // and 5601: the tool changer's, read-only

constexpr bool within(int index, int first) noexcept {
  return index >= first && index < first + kAxes;
}
constexpr bool reads_only(int index) noexcept {
  return (index >= kTool && index < kToolDiameter + 4) || within(index, kPosition) ||
         index == kG92InForce || index == kActiveOffset;
}

// Values that only the running machine knows.
inline bool of_machine(std::string_view name) noexcept {
  return name.starts_with("_hal[") || name.starts_with("_ini[") || name == "_current_pocket" ||
         name == "_selected_pocket" || name == "_metric_machine";
}

}  // namespace steadyrest::nc::interpret
