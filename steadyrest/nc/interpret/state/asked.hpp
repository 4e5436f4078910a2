// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

/// Modes of the control as bits: the groups of the G words, then these.
using ModeMask = std::uint32_t;
[[nodiscard]] constexpr ModeMask mode(GGroup group) noexcept {
  return ModeMask{1} << static_cast<unsigned>(group);
}
inline constexpr ModeMask kToolMode = ModeMask{1} << kGGroups;  ///< which tool is in the spindle
inline constexpr ModeMask kSpindleMode = kToolMode << 1U;       ///< M3 M4 M5
inline constexpr ModeMask kCoolantMode = kToolMode << 2U;       ///< M7 M8 M9
inline constexpr ModeMask kOverrideMode = kToolMode << 3U;      ///< M48 …
inline constexpr ModeMask kFeedMode = kToolMode << 4U;          ///< F
inline constexpr ModeMask kSpeedMode = kToolMode << 5U;         ///< S
inline constexpr ModeMask kFrameMode = kToolMode << 6U;         ///< shift, rotation, scale, mirror
inline constexpr ModeMask kTransformMode = kToolMode << 7U;     ///< TRAORI, a swivelled plane
inline constexpr ModeMask kCallMode = kToolMode << 8U;  ///< a modal call that is not understood
/// All that an unknown word may change; a modal call is seen to be one.
inline constexpr ModeMask kModes = ((kTransformMode << 1U) - 1U) & ~mode(GGroup::non_modal);
/// They move nothing, and give no word another meaning.
inline constexpr ModeMask kHarmlessModes = kToolMode | kSpindleMode | kCoolantMode | kOverrideMode |
                                           kSpeedMode | mode(GGroup::spindle_mode);

/// What the expressions of a line have read from the control: values that the program may not have
/// set, so that they may come from the state in which it started.
struct Asked {
  std::uint32_t positions = 0;  ///< axes whose work position was read, a mask
  ModeMask modes = 0;
  std::string value;  ///< the first value that the program certainly has not set, as written
  /// Work offsets whose numbers (#5221 …) it has set, a mask; kShift: G92's.
  std::uint32_t offsets_set = 0;
  static constexpr std::uint32_t kShift = std::uint32_t{1} << 31U;

  void about(std::string_view name) {
    if (value.empty()) {
      value = name;
    }
    any = true;
  }
  void about_position(std::size_t axis) noexcept {
    positions |= std::uint32_t{1} << axis;
    any = true;
  }
  void about_mode(ModeMask mode) noexcept {
    modes |= mode;
    any = true;
  }
  void about_offset(std::uint32_t mask) noexcept {
    offsets_set |= mask;
    any = true;
  }
  void clear() {
    if (any) {
      *this = {};
    }
  }
  bool any = false;
};

}  // namespace steadyrest::nc::interpret
