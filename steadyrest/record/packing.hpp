// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace steadyrest::record {

/// Packs a column of 64-bit values without loss.
///
/// dᵢ = vᵢ − vᵢ₋₁ modulo 2⁶⁴ with v₋₁ = 0; then byte 0 of all d, byte 1 of all d, …; then zlib. A
/// column that hardly changes is a few dozen bytes; zlib's checksum finds damage.
[[nodiscard]] std::vector<std::byte> pack(std::span<const std::uint64_t> values);

/// Exactly `count` values; empty where the data is damaged or holds another number of them.
[[nodiscard]] std::optional<std::vector<std::uint64_t>> unpack(std::span<const std::byte> packed,
                                                               std::size_t count);

}  // namespace steadyrest::record
