// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include <steadyrest/kernel/machine/chatter.hpp>

namespace steadyrest::kernel::machine {

/// As machine files and the command line write them, in the order of `SpeedLaw`.
inline constexpr std::array<std::string_view, 7> kSpeedLawNames = {
    "constant", "square", "pulse", "triangle", "sine", "random", "stop"};

}  // namespace steadyrest::kernel::machine
