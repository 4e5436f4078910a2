// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace steadyrest::kernel::override::test {

inline constexpr double kCycle_s = 0.001;  ///< control cycle of the tests

}  // namespace steadyrest::kernel::override::test
