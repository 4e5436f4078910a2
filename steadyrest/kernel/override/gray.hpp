// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// Gray code of switch positions.
///
/// Law: position p has the code p ⊕ ⌊p/2⌋, so that neighbours differ in exactly one bit. A rotary
/// switch of a SINUMERIK panel counts its positions from 1: the table's index i (MD12030[i]) has
/// the code gray(i + 1), and 00000, which an open cable would show, is never a position.
/// Source: SINUMERIK 840D sl Commissioning Manual, HT2 rotary switch.
namespace steadyrest::kernel::override {

[[nodiscard]] constexpr std::uint32_t gray_code(std::uint32_t position) noexcept {
  return position ^ (position >> 1U);
}

/// The inverse: the position that has this code.
[[nodiscard]] constexpr std::uint32_t gray_position(std::uint32_t code) noexcept {
  for (std::uint32_t shift = 1; shift < 32; shift *= 2) {
    code ^= code >> shift;
  }
  return code;
}

/// Code of table index i on a switch whose positions count from 1 (SINUMERIK): never 0.
[[nodiscard]] constexpr std::uint32_t sinumerik_code(std::size_t index) noexcept {
  return gray_code(static_cast<std::uint32_t>(index) + 1U);
}

}  // namespace steadyrest::kernel::override
