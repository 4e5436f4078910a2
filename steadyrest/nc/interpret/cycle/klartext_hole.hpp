// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/cycle/klartext_cycles.hpp>

namespace steadyrest::nc::interpret {

/// One hole, in mm along the tool axis.
struct KlartextCycles::Hole {
  std::size_t normal = 2;
  double surface_mm = 0.0;
  double clear_mm = 0.0;  ///< set-up clearance above the surface
  double bottom_mm = 0.0;
  double second_mm = 0.0;     ///< second set-up clearance
  double clearance_mm = 0.0;  ///< Q200 itself
};

}  // namespace steadyrest::nc::interpret
