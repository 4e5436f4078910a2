// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace steadyrest::bench::hostile {

/// splitmix64: the same hunt from the same seed on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  /// 0 … 1.
  double share() noexcept { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  double within(double low, double high) noexcept { return low + (high - low) * share(); }
  bool one_in(std::uint64_t n) noexcept { return next() % n == 0; }
  std::size_t below(std::size_t n) noexcept { return static_cast<std::size_t>(next() % n); }
  template <class T>
  T of(std::initializer_list<T> values) noexcept {
    return values.begin()[below(values.size())];
  }

 private:
  std::uint64_t state_;
};

}  // namespace steadyrest::bench::hostile
