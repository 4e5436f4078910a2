// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// sinumerik: the tolerances of the path from `State::smoothing`, to be called after any change of
/// it or of the path mode.
///
///   continuous: tolerance = CTOL where G642, G643 or G645 rounds and CTOL is given, else ADIS
///   lines in a row become one within CTOL while a compressor is on, else within the tolerance
///
/// CTOL applies to "all compressor functions" and "all rounding types except G641 and G644" ("Job
/// planning", "Programmable contour/orientation tolerance"). Without CTOL the control rounds by
/// G642 within a setting of its own (MD33100), which is not known: ADIS is taken.
inline void apply_smoothing(State& state) noexcept {
  if (state.path_mode != PathMode::continuous) {
    return;
  }
  const Smoothing& smoothing = state.smoothing;
  const bool given = smoothing.tolerance_mm >= 0.0;
  state.path_tolerance_mm =
      smoothing.by_tolerance && given ? smoothing.tolerance_mm : smoothing.distance_mm;
  state.merge_tolerance_mm = smoothing.compressor && given ? smoothing.tolerance_mm : -1.0;
}

}  // namespace steadyrest::nc::interpret
