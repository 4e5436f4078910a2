// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/units/constants.hpp>

/// The encoder that the tests of the motion stage read, and how fast its axis swings.
namespace steadyrest::supervisor::test {

inline constexpr double kCount_mm = 0.001;
inline constexpr double kClock_s = 1e-7;
inline constexpr double kRate_1_s = kernel::units::kTurn * 2.0;  ///< 2 Hz

}  // namespace steadyrest::supervisor::test
