// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <steadyrest/kernel/machine/chatter.hpp>

namespace steadyrest::kernel::machine {

/// As machine files and the command line write them, in the order of `SpeedLaw`.
inline constexpr std::array<std::string_view, 7> kSpeedLawNames = {
    "constant", "square", "pulse", "triangle", "sine", "random", "stop"};
static_assert(kSpeedLawNames.size() == static_cast<std::size_t>(SpeedLaw::stop) + 1,
              "each law has its name; `stop` is the last");

}  // namespace steadyrest::kernel::machine
