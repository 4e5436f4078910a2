// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace steadyrest::chatter::offline {

/// Gauss–Legendre collocation on [0, 1] with n nodes: integrals from 0 to each node are exact for
/// polynomials of degree n − 1, the integral to 1 for degree 2n − 1.
struct GaussNodes {
  Eigen::VectorXd node;         ///< n, rising
  Eigen::VectorXd weight;       ///< n, of ∫₀¹
  Eigen::MatrixXd integral;     ///< n×n: (S·f)_i = ∫₀^{node_i}
  Eigen::MatrixXd integral2;    ///< S·S
  Eigen::VectorXd barycentric;  ///< n, weights of Lagrange's interpolation

  /// Weights that give the value at x from the values at the nodes.
  [[nodiscard]] Eigen::RowVectorXd interpolation(double x) const;

  /// The nodes for n; built once, safe to call from several threads. 1 ≤ n ≤ kMost.
  static const GaussNodes& of(Eigen::Index n);
  static constexpr Eigen::Index kMost = 64;
};

}  // namespace steadyrest::chatter::offline
