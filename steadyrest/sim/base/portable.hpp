// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// Elementary functions made only of + − × ÷ and √, which IEEE 754 rounds in exactly one way.
///
/// The C library picks its exp, log and sin by processor (with or without fused multiply-add), and
/// the last bit may differ. A simulation that promises the same bytes for the same seed cannot call
/// them in its loop. Error against the true value: below 1e-15 relative for `exp` and `log`, below
/// 1e-15 absolute for `sin_turn`.
namespace steadyrest::sim::portable {

/// 1/i and 1/(i·(i − 1)), rounded once: no division in the series.
inline constexpr auto kReciprocal = [] {
  std::array<double, 24> table{};
  for (std::size_t i = 1; i < table.size(); ++i) {
    table[i] = 1.0 / static_cast<double>(i);
  }
  return table;
}();
inline constexpr auto kReciprocalPair = [] {
  std::array<double, 24> table{};
  for (std::size_t i = 2; i < table.size(); ++i) {
    table[i] = 1.0 / static_cast<double>(i * (i - 1));
  }
  return table;
}();

/// eˣ for x ∈ [−700, 700]; 0 below, e⁷⁰⁰ above. Reduction x = k·ln 2 + r, then the series in r.
[[nodiscard]] inline double exp(double x) noexcept {
  constexpr double kLog2E = 1.4426950408889634;
  constexpr double kLn2High = 6.93147180369123816490e-01;
  constexpr double kLn2Low = 1.90821492927058770002e-10;
  if (x < -700.0) {
    return 0.0;
  }
  if (x > 700.0) {
    x = 700.0;
  }
  const double k = std::floor(x * kLog2E + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double sum = 1.0;
  for (std::size_t i = 13; i > 0; --i) {
    sum = 1.0 + sum * r * kReciprocal[i];
  }
  const auto exponent = static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023);
  return sum * std::bit_cast<double>(exponent << 52U);
}

/// ln x for finite x > 0. x = m·2ᵉ with m ∈ [√½, √2), then 2·artanh((m − 1)/(m + 1)).
[[nodiscard]] inline double log(double x) noexcept {
  constexpr double kLn2 = 0.69314718055994530942;
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.70710678118654752) {
    m *= 2.0;
    --exponent;
  }
  const double f = (m - 1.0) / (m + 1.0);
  const double f2 = f * f;
  double sum = 0.0;
  for (std::size_t i = 11; i-- > 0;) {
    sum = sum * f2 + kReciprocal[2 * i + 1];
  }
  return 2.0 * f * sum + exponent * kLn2;
}

/// sin(2π·turns) for any finite argument below 2⁵² turns.
[[nodiscard]] inline double sin_turn(double turns) noexcept {
  constexpr double kTwoPi = 6.28318530717958647693;
  double t = turns - std::floor(turns + 0.5);
  if (t > 0.25) {
    t = 0.5 - t;
  } else if (t < -0.25) {
    t = -0.5 - t;
  }
  const double y = kTwoPi * t;
  const double y2 = y * y;
  double sum = 1.0;
  for (std::size_t i = 21; i > 1; i -= 2) {
    sum = 1.0 - sum * y2 * kReciprocalPair[i];
  }
  return y * sum;
}

}  // namespace steadyrest::sim::portable
