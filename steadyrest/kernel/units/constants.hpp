// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <numbers>

/// Numbers that every room needs.
namespace steadyrest::kernel::units {

inline constexpr double kTurn = 2.0 * std::numbers::pi;                       ///< rad in a turn
inline constexpr double kDegree = std::numbers::pi / 180.0;                   ///< rad in a degree
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();      ///< a value not known
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();  ///< no limit

}  // namespace steadyrest::kernel::units
