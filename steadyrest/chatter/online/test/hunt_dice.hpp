// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

/// Chance for the hunts: the same numbers on every machine.
namespace steadyrest::chatter::online::test {

/// splitmix64
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  std::uint64_t below(std::uint64_t n) { return (next() >> 11U) % n; }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  double within(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11U) * 0x1.0p-53;
  }
  double unfit() {
    constexpr std::array kUnfit{std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(), -1.0, 1e300};
    return kUnfit[below(kUnfit.size())];
  }

 private:
  std::uint64_t state_;
};

}  // namespace steadyrest::chatter::online::test
