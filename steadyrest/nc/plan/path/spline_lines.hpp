// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::plan {

inline constexpr int kLeastHalvings = 2;
inline constexpr int kMostHalvings = 12;

/// A spline as straight moves along its chords, in order. Each knot span is halved until the middle
/// of the curve lies within `tolerance_mm` of its chord, at least `kLeastHalvings` times (an
/// inflexion in the middle hides the first deviation) and at most `kMostHalvings` times.
void spline_lines(const interpret::Move& move, double tolerance_mm,
                  const std::function<void(const interpret::Move&)>& line);

}  // namespace steadyrest::nc::plan
