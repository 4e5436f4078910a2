// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

/// Words do not simply name work coordinates: a mirror image, scaling, rotation (G51.1, G51, G68)
/// or polar coordinates (G16) are in force.
[[nodiscard]] inline bool has_worded_end(const State& state) noexcept {
  return state.text_frame.on || state.polar.on;
}

/// Where the words of a block lead then, in work coordinates; unnamed axes stay.
[[nodiscard]] Axes worded_end(const Step& step, const State& state) noexcept;

/// G16: takes the radius and angle of a block that moves, once for each move; worded_end() uses
/// them. False when the block is refused.
bool take_polar(const Step& step, State& state, Refusals& refusals);

}  // namespace steadyrest::nc::interpret
