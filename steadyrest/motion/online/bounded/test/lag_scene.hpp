// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <steadyrest/motion/online/bounded/lag_smoother.hpp>

/// A motion at five counts a cycle, seen twice in each, and what is known of it at any instant by
/// one dense Gaussian over the state and all observations: no filter, nothing that runs backwards.
namespace steadyrest::motion::online::test {

inline constexpr double kLagCycle_s = 1e-3;
inline constexpr double kLagJerk = 1e10;   ///< counts²/s⁵
inline constexpr double kLagNoise = 1e-4;  ///< counts²

/// Time and position of each passage.
inline std::vector<std::pair<double, double>> lag_passages(int ticks) {
  std::vector<std::pair<double, double>> out;
  for (int half = 0; half < 2 * ticks; ++half) {
    const double t_s = (0.5 * half + 0.3) * kLagCycle_s;
    const double noise = 0.01 * std::sin(12.9898 * half * half);
    out.emplace_back(t_s, 5e3 * t_s + 0.4 * std::sin(300.0 * t_s) + noise);
  }
  return out;
}

/// The smoother after so many ticks, behind filters that have seen all passages.
inline LagSmoother lag_fed(std::size_t lag, int ticks, double rest = 0.0) {
  LagSmoother out(lag);
  ModelBank bank;
  for (std::size_t j = 0; j < kModels; ++j) {
    bank.set(j, {{0.0, 5e3, 1e4}, {1.0, 0.0, 0.0, 1e6, 0.0, 1e8}});
  }
  const auto passages = lag_passages(ticks);
  for (std::size_t i = 0; i < passages.size(); ++i) {
    const auto& [t_s, z] = passages[i];
    bank.predict(t_s, all(kLagJerk), all(0.0));
    bank.update(all(z), all(kLagNoise));
    out.observed(t_s, all(z), all(kLagNoise));
    if (i % 2 == 1) {
      LagSmoother::Look look;
      look.t_s = 0.5 * static_cast<double>(i + 1) * kLagCycle_s;
      bank.predict(look.t_s, all(kLagJerk), all(0.0));
      look.bank = bank;
      look.weight = all(0.25 * (1.0 - rest));
      look.weight_rest = rest;
      look.rest_x = 0.375;
      out.looked(look);
    }
  }
  return out;
}

/// The state t later, where the acceleration keeps.
inline Eigen::Matrix3d lag_moved(double t) {
  Eigen::Matrix3d out;
  out << 1, t, t * t / 2, 0, 1, t, 0, 0, 1;
  return out;
}

/// cov(state at s, state at t) of white jerk, from the same start as the filters.
inline Eigen::Matrix3d lag_covariance(double s, double t) {
  const double e = std::min(s, t);
  Eigen::Matrix3d q;
  q << std::pow(e, 5) / 20, std::pow(e, 4) / 8, std::pow(e, 3) / 6, std::pow(e, 4) / 8,
      std::pow(e, 3) / 3, e * e / 2, std::pow(e, 3) / 6, e * e / 2, e;
  const Eigen::Matrix3d start = Eigen::Vector3d(1.0, 1e6, 1e8).asDiagonal();
  const Eigen::Matrix3d both = lag_moved(e) * start * lag_moved(e).transpose() + kLagJerk * q;
  return lag_moved(s - e) * both * lag_moved(t - e).transpose();
}

/// x, v and a at `at_s` from all passages up to `until_s`.
inline Eigen::Vector3d lag_known(double at_s, double until_s, int ticks) {
  const Eigen::Vector3d start(0.0, 5e3, 1e4);
  std::vector<std::pair<double, double>> seen = lag_passages(ticks);
  std::erase_if(seen, [&](const auto& each) { return each.first > until_s; });
  const auto n = static_cast<Eigen::Index>(seen.size());
  Eigen::MatrixXd observed(n, n);
  Eigen::MatrixXd state(3, n);
  Eigen::VectorXd off(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [t_s, z] = seen[static_cast<std::size_t>(i)];
    off(i) = z - (lag_moved(t_s) * start)(0);
    state.col(i) = lag_covariance(at_s, t_s).col(0);
    for (Eigen::Index k = 0; k < n; ++k) {
      observed(i, k) = lag_covariance(t_s, seen[static_cast<std::size_t>(k)].first)(0, 0);
    }
    observed(i, i) += kLagNoise;
  }
  return lag_moved(at_s) * start + state * observed.ldlt().solve(off);
}

}  // namespace steadyrest::motion::online::test
