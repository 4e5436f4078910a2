// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/override/gray.hpp>

namespace steadyrest::sim::test {

/// Gray code of a switch with the positions 0, 10 … 120 %.
inline std::uint32_t code_of(int percent) {
  return kernel::override::gray_code(static_cast<std::uint32_t>(percent) / 10U + 1U);
}

}  // namespace steadyrest::sim::test
