// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The exact step of two linear differential equations: position and velocity over a time.
namespace steadyrest::sim {

struct Matrix2 {
  double xx, xv, vx, vv;
};

/// exp of a 2×2 matrix by scaling and squaring: products only, so the same bits everywhere.
/// Norm ≤ 0.25 after scaling: twelve terms leave 0.25¹³/13! ≈ 2·10⁻¹⁸.
[[nodiscard]] Matrix2 exponential(Matrix2 a) noexcept;

}  // namespace steadyrest::sim
