// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/cycle/cycle_calls.hpp>

namespace steadyrest::nc::interpret {

/// The value at this place is not left out.
[[nodiscard]] constexpr bool given(const read::Flow& call, std::size_t place) noexcept {
  return place < call.count && (call.given >> place & 1U) != 0;
}
/// The control treats an omitted value as zero.
[[nodiscard]] constexpr double value(const read::Flow& call, std::size_t place) noexcept {
  return given(call, place) ? call.values[place] : 0.0;
}

// Places of the values that all drilling cycles have.
inline constexpr std::size_t kRtp = 0;   ///< retraction plane
inline constexpr std::size_t kRfp = 1;   ///< reference plane
inline constexpr std::size_t kSdis = 2;  ///< safety clearance
inline constexpr std::size_t kDp = 3;    ///< depth
inline constexpr std::size_t kDpr = 4;   ///< depth below the reference plane
inline constexpr std::size_t kDtb = 5;   ///< dwell at the bottom, of most

/// One hole, in mm along the normal axis of the plane.
struct CycleCalls::Hole {
  std::size_t normal = 2;
  double reference_mm = 0.0;
  double start_mm = 0.0;  ///< reference plane and safety clearance
  double bottom_mm = 0.0;
  double retract_mm = 0.0;
};

/// Metric coarse threads, ISO 261: the pitch of a nominal size in mm; 0 where there is none.
[[nodiscard]] double coarse_pitch(double size) noexcept;

}  // namespace steadyrest::nc::interpret
