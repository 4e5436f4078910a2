// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

#include <steadyrest/chatter/offline/cycle/gauss_nodes.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;

/// P_0 … P_n at x.
Eigen::VectorXd legendre(double x, Index n) {
  Eigen::VectorXd p(n + 1);
  p[0] = 1.0;
  if (n > 0) {
    p[1] = x;
  }
  for (Index k = 1; k < n; ++k) {
    const auto m = static_cast<double>(k);
    p[k + 1] = ((2.0 * m + 1.0) * x * p[k] - m * p[k - 1]) / (m + 1.0);
  }
  return p;
}

GaussNodes make(Index n) {
  GaussNodes out;
  Eigen::VectorXd x(n);
  Eigen::VectorXd w(n);
  for (Index i = 0; i < n; ++i) {
    // The usual first guess for the zeros of P_n; a few Newton steps finish it.
    double z = -std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) /
                         (static_cast<double>(n) + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 20; ++step) {
      const Eigen::VectorXd p = legendre(z, n);
      const double lower = n > 0 ? p[n - 1] : 0.0;
      // P_n′ from the recurrence (1 − z²)·P_n′ = n·(P_{n−1} − z·P_n).
      slope = static_cast<double>(n) * (z * p[n] - lower) / (z * z - 1.0);
      const double change = p[n] / slope;
      z -= change;
      if (std::abs(change) < 1e-16) {
        break;
      }
    }
    x[i] = z;
    w[i] = 2.0 / ((1.0 - z * z) * slope * slope);
  }
  // From [−1, 1] to [0, 1].
  out.node = 0.5 * (x.array() + 1.0);
  out.weight = 0.5 * w;
  // ℓ_j = w_j·Σ_k (2k+1)/2·P_k(x_j)·P_k, and ∫₋₁ˣ P_k = (P_{k+1} − P_{k−1})/(2k + 1).
  Eigen::MatrixXd p(n + 1, n);
  for (Index i = 0; i < n; ++i) {
    p.col(i) = legendre(x[i], n);
  }
  out.integral.resize(n, n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      // k = 0: ∫₋₁ˣ P_0 = 1 + x. The interpolant has degree n − 1, so the series ends there; ¼ is
      // the ½ of the series times the ½ of the shorter interval.
      double sum = 1.0 + x[i];
      for (Index k = 1; k < n; ++k) {
        sum += p(k, j) * (p(k + 1, i) - p(k - 1, i));
      }
      out.integral(i, j) = 0.25 * w[j] * sum;
    }
  }
  out.integral2 = out.integral * out.integral;
  out.barycentric.resize(n);
  for (Index j = 0; j < n; ++j) {
    // Barycentric weights at Legendre points (Wang and Xiang 2012): ±√((1 − x²)·w), a common factor
    // left out.
    const double sign = j % 2 == 0 ? 1.0 : -1.0;
    out.barycentric[j] = sign * std::sqrt((1.0 - x[j] * x[j]) * w[j]);
  }
  return out;
}

}  // namespace

Eigen::RowVectorXd GaussNodes::interpolation(double x) const {
  Eigen::RowVectorXd out(node.size());
  for (Index j = 0; j < node.size(); ++j) {
    const double d = x - node[j];
    // On the node itself the formula divides by 0.
    if (std::abs(d) < 1e-14) {
      out.setZero();
      out[j] = 1.0;
      return out;
    }
    out[j] = barycentric[j] / d;
  }
  return out / out.sum();
}

const GaussNodes& GaussNodes::of(Index n) {
  // All threads of a lobe map use these; each size is built once and then only read.
  static std::array<GaussNodes, static_cast<std::size_t>(kMost) + 1> made;
  static std::array<std::once_flag, static_cast<std::size_t>(kMost) + 1> once;
  const auto slot = static_cast<std::size_t>(n);
  std::call_once(once[slot], [&] { made[slot] = make(n); });
  return made[slot];
}

}  // namespace steadyrest::chatter::offline
