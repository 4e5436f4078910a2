// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/adapters/lines/wire_diagnosis.hpp>

// Each wire alone: the first explanation that holds in every word, the most common ones first.
namespace steadyrest::adapters::lines {
namespace {

using Kind = WireFault::Kind;

bool bit_of(std::uint32_t word, std::size_t bit) {
  return (word >> bit & 1U) != 0;
}

template <class Holds>
bool always(std::span<const WordPair> words, Holds holds) {
  return std::ranges::all_of(words, holds);
}

std::optional<WireFault> fault_of(std::span<const WordPair> words, std::size_t bit,
                                  std::size_t bits) {
  const auto seen = [bit](const WordPair& pair) { return bit_of(pair.seen, bit); };
  if (always(words, [&](const WordPair& p) { return seen(p) == bit_of(p.sent, bit); })) {
    return std::nullopt;
  }
  if (always(words, [&](const WordPair& p) { return !seen(p); })) {
    return WireFault{.bit = bit, .kind = Kind::stuck_off, .other = bit};
  }
  if (always(words, seen)) {
    return WireFault{.bit = bit, .kind = Kind::stuck_on, .other = bit};
  }
  if (always(words, [&](const WordPair& p) { return seen(p) != bit_of(p.sent, bit); })) {
    return WireFault{.bit = bit, .kind = Kind::inverted, .other = bit};
  }
  for (const Kind kind : {Kind::swapped, Kind::swapped_inverted, Kind::bridged}) {
    for (std::size_t other = 0; other < bits; ++other) {
      const auto explains = [&](const WordPair& p) {
        const bool from = bit_of(p.sent, other);
        return kind == Kind::swapped            ? seen(p) == from
               : kind == Kind::swapped_inverted ? seen(p) != from
                                                : seen(p) == (from || bit_of(p.sent, bit));
      };
      if (other != bit && always(words, explains)) {
        return WireFault{.bit = bit, .kind = kind, .other = other};
      }
    }
  }
  return WireFault{.bit = bit, .kind = Kind::unclear, .other = bit};
}

}  // namespace

std::vector<WireFault> diagnose(std::span<const WordPair> words, std::size_t bits) {
  std::vector<WireFault> faults;
  for (std::size_t bit = 0; bit < bits; ++bit) {
    if (const auto fault = fault_of(words, bit, bits)) {
      faults.push_back(*fault);
    }
  }
  return faults;
}

std::string text_of(const WireFault& fault) {
  switch (fault.kind) {
    case Kind::stuck_off:
      return fmt::format("bit {} stays 0: a broken wire, a dead line, or one that is not wired",
                         fault.bit);
    case Kind::stuck_on:
      return fmt::format("bit {} stays 1: it touches the supply, or the line is dead", fault.bit);
    case Kind::inverted:
      return fmt::format("bit {} is inverted", fault.bit);
    case Kind::swapped:
      return fmt::format("bit {} carries bit {}: wires are swapped", fault.bit, fault.other);
    case Kind::swapped_inverted:
      return fmt::format("bit {} carries bit {}, inverted", fault.bit, fault.other);
    case Kind::bridged:
      return fmt::format("bit {} is on whenever bit {} is: the wires touch", fault.bit,
                         fault.other);
    case Kind::unclear:
      break;
  }
  return fmt::format("bit {} is wrong in some words only: a loose contact, or too slow", fault.bit);
}

}  // namespace steadyrest::adapters::lines
