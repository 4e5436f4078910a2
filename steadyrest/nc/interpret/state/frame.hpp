// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::interpret {

/// X and Y turned by an angle about Z, counter-clockwise seen from +Z; the others unchanged. Exact
/// for 0.
[[nodiscard]] Axes turned(const Axes& axes, double angle_deg) noexcept;

}  // namespace steadyrest::nc::interpret
