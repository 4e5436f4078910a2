// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>

namespace steadyrest::nc::interpret {

/// One hole of a canned cycle, in mm along the normal axis of the plane.
struct Interpreter::Hole {
  PlaneAxes axes;
  double initial_mm;  ///< where the cycle was begun
  double retract_mm;  ///< R plane
  double bottom_mm;
  double clear_mm;  ///< where the cycle ends: R plane (G99) or initial level (G98)
};

}  // namespace steadyrest::nc::interpret
