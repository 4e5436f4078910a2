// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// The recorder: turns an encoder input into edges with their times.
///
/// Its headers are self-contained: freestanding C++20, integers only, no allocation, no division,
/// fit for a microcontroller (-ffreestanding -fno-exceptions -fno-rtti). Cells and lines are those
/// of `estimator.hpp`: line k is the border between the cells k − 1 and k, so that
///   up   from cell c passes line c + 1, which is the new count;
///   down from cell c passes line c,     which is the old count,
/// and up over line k followed by down over line k names the same k twice.
///
/// Two front ends produce the same events, for an `EdgeRing`:
///   QuadratureDecoder  levels A, B, sampled with a clock            → every edge
///   LatchedDecoder     count and time of the last edge, once a cycle → the last edge of each cycle
/// The counters are never reset. The clock in `EdgeEvent::ticks` is unwrapped, monotone, in ticks
/// of the input's own clock; its zero is the clock's value at the first call.
namespace steadyrest::motion::online {

/// What is not certain about an event.
inline constexpr std::uint8_t kTimeUnknown = 1;     ///< `ticks` means only "not later than"
inline constexpr std::uint8_t kLineGuessed = 2;     ///< line and direction are the likelier of two
inline constexpr std::uint8_t kCountUncertain = 4;  ///< the counter may have wrapped unseen

/// The axis passed a line.
struct EdgeEvent {
  std::int64_t line = 0;
  std::uint64_t ticks = 0;     ///< unwrapped clock
  std::uint32_t lost = 0;      ///< at least this many edges before this one are missing (saturates)
  std::int8_t direction = 1;   ///< +1, −1
  std::uint8_t uncertain = 0;  ///< kTimeUnknown | kLineGuessed | kCountUncertain
};

namespace detail {

/// to − from of two counters of `bits` (1…64) bits, as the nearest of the possible values.
[[nodiscard]] constexpr std::int64_t wrapped_difference(std::uint64_t to, std::uint64_t from,
                                                        unsigned bits) noexcept {
  const unsigned shift = 64U - bits;
  return static_cast<std::int64_t>((to - from) << shift) >> shift;
}

[[nodiscard]] constexpr std::uint64_t mask(unsigned bits) noexcept {
  return ~std::uint64_t{0} >> (64U - bits);
}

[[nodiscard]] constexpr unsigned width(unsigned bits) noexcept {
  return bits < 1 ? 1U : (bits > 64 ? 64U : bits);
}

/// Counters wrap, also at the ends of 64 bits.
[[nodiscard]] constexpr std::int64_t wrapping_sum(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

[[nodiscard]] constexpr std::uint64_t magnitude(std::int64_t value) noexcept {
  const auto bits = static_cast<std::uint64_t>(value);
  return value < 0 ? std::uint64_t{0} - bits : bits;
}

constexpr void add_saturated(std::uint32_t& sum, std::uint64_t more) noexcept {
  const std::uint64_t room = ~std::uint32_t{0} - std::uint64_t{sum};
  sum = more > room ? ~std::uint32_t{0} : sum + static_cast<std::uint32_t>(more);
}

}  // namespace detail

}  // namespace steadyrest::motion::online
