// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/motion/online/bounded/lanes.hpp>

/// Kalman filters of position, velocity and acceleration, one for each motion model, in UD form.
///
/// Model: ẋ = v, v̇ = a, ȧ = −δ·a + w with white jerk w of density S [count²/s⁵] and decay δ [1/s].
/// Covariance P = U·D·Uᵀ, U unit upper triangular, D diagonal. Time update by weighted Gram–Schmidt
/// (Thornton), measurement update after Bierman: both keep P positive whatever the rounding, which
/// the plain form does not (reference: Bierman, Factorization Methods for Discrete Sequential
/// Estimation, 1977). Unit of length: the count.
namespace steadyrest::motion::online {

/// Mean and symmetric covariance of one model; P in the order xx, xv, xa, vv, va, aa.
struct Moments {
  std::array<double, 3> mean{};
  std::array<double, 6> covariance{};
};

struct ModelBank {
  double t_s = 0.0;
  Lanes x{}, v{}, a{};
  Lanes u12{}, u13{}, u23{};
  Lanes d1{}, d2{}, d3{};

  /// Variances of the position.
  [[nodiscard]] Lanes position_variance() const noexcept;
  [[nodiscard]] double velocity_variance(std::size_t model) const noexcept {
    return d2[model] + u23[model] * u23[model] * d3[model];
  }

  /// Moves to `t_s`; never back.
  void predict(double to_s, const Lanes& jerk_density, const Lanes& decay_1_s) noexcept;

  /// Measurement of the position: z with variance r.
  void update(const Lanes& z, const Lanes& r) noexcept;

  /// Multiplies P.
  void inflate(const Lanes& factor) noexcept;

  /// Of model j.
  [[nodiscard]] Moments moments(std::size_t j) const noexcept;
  void set(std::size_t j, const Moments& m) noexcept;
};

}  // namespace steadyrest::motion::online
