// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::plan {

/// How far an axis goes in one move, in machine coordinates, including the bulges of arcs.
struct Reach {
  double low_mm = 0.0;
  double high_mm = 0.0;
};
[[nodiscard]] Reach reach_of(const interpret::Move& move, std::size_t axis) noexcept;

}  // namespace steadyrest::nc::plan
