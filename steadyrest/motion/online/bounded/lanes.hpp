// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// The same number for each motion model. Loops over lanes are left to the compiler to vectorise.
namespace steadyrest::motion::online {

inline constexpr std::size_t kModels = 4;
using Lanes = std::array<double, kModels>;

[[nodiscard]] constexpr Lanes all(double value) noexcept {
  Lanes out{};
  out.fill(value);
  return out;
}

[[nodiscard]] inline double sum(const Lanes& lanes) noexcept {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/// e^(−y) for 0 ≤ y ≤ 4, error below 1e-5: (1 − z + z²/2 − z³/6 + z⁴/24)¹⁶ at z = y/16.
[[nodiscard]] inline double exp_of_minus(double y) noexcept {
  const double z = y * 0.0625;
  double e = 1.0 - z * (1.0 - z * (0.5 - z * (1.0 / 6.0 - z * (1.0 / 24.0))));
  e *= e;
  e *= e;
  e *= e;
  return e * e;
}

/// e^x for |x| ≤ 450, relative error below 2e-8: 2^k·e^f, f within ±½·ln 2, by its series.
[[nodiscard]] inline double fast_exp(double x) noexcept {
  constexpr double kLog2e = 1.4426950408889634;
  constexpr double kLn2 = 0.6931471805599453;
  constexpr double kRound = 6755399441055744.0;  // 1.5·2^52: adding it rounds to an integer
  const double shifted = x * kLog2e + kRound;
  const double f = x - (shifted - kRound) * kLn2;
  const double f2 = f * f;  // pairs of terms: half the dependency chain
  const double low = (1.0 + f) + f2 * (0.5 + f * (1.0 / 6.0));
  const double high = (1.0 / 24.0 + f * (1.0 / 120.0)) + f2 * (1.0 / 720.0 + f * (1.0 / 5040.0));
  const double e = low + f2 * f2 * high;
  // The low bits of `shifted` are k; only eleven of them survive the shift.
  return e * std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023U) << 52U);
}

/// Upper tail of the standard normal distribution and its density, relative error below 2e-7 for z
/// ≥ 0 (Chebyshev fit of erfc: Press et al., Numerical Recipes, §6.2).
struct Tail {
  double share = 0.0;
  double density = 0.0;
};
[[nodiscard]] inline Tail upper_tail(double z) noexcept {
  const double a = std::abs(z) * 0.7071067811865476;
  const double t = 1.0 / (1.0 + 0.5 * a);
  const double t2 = t * t;
  const double t4 = t2 * t2;
  const double p0 = (-1.26551223 + t * 1.00002368) + t2 * (0.37409196 + t * 0.09678418);
  const double p4 = (-0.18628806 + t * 0.27886807) + t2 * (-1.13520398 + t * 1.48851587);
  const double p8 = -0.82215223 + t * 0.17087277;
  const double p = p0 + t4 * (p4 + t4 * p8);
  const double gauss = fast_exp(-a * a);
  const double half = 0.5 * t * gauss * fast_exp(p);
  return {z >= 0.0 ? half : 1.0 - half, 0.3989422804014327 * gauss};
}

}  // namespace steadyrest::motion::online
