// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace steadyrest::adapters::lines {

/// A word that should have come, and the one that did.
struct WordPair {
  std::uint32_t sent = 0;
  std::uint32_t seen = 0;
};

/// What is wrong with one wire of a word.
struct WireFault {
  enum class Kind : std::uint8_t {
    stuck_off,  ///< always 0, though it should change
    stuck_on,   ///< always 1
    inverted,   ///< the opposite of what should come
    swapped,    ///< carries the bit `other`
    swapped_inverted,
    bridged,  ///< on whenever this bit or `other` is: two wires touch
    unclear   ///< wrong in some words, by none of these
  };
  std::size_t bit = 0;
  Kind kind = Kind::unclear;
  std::size_t other = 0;

  friend bool operator==(const WireFault&, const WireFault&) = default;
};

/// The wires that explain all pairs, lowest bit first; empty: every word came as it was sent. The
/// words should make each of the `bits` change, and no two of them change alike, as the words of a
/// whole table do.
[[nodiscard]] std::vector<WireFault> diagnose(std::span<const WordPair> words, std::size_t bits);

/// `bit 2 is inverted`; bits count from 0, the lowest.
[[nodiscard]] std::string text_of(const WireFault& fault);

}  // namespace steadyrest::adapters::lines
