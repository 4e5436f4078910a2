// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace steadyrest::kernel::machine {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

}  // namespace steadyrest::kernel::machine
