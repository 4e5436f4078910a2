// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstddef>
#include <numbers>

#include <Eigen/Eigenvalues>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>

/// First-order semi-discretization as in the literature, for one mode along x, straight teeth of
/// even pitch and constant speed (Insperger, Stépán, Turi 2008), with the teeth's angles taken
/// within one turn.
namespace steadyrest::chatter::offline::test {

/// |μ| of one tooth pass with m steps in it. The state is x, ẋ and the m previous displacements;
/// the transition matrix is the product of m matrices of (m + 2)².
inline double radius_by_semi_discretization(const Process& process, double speed_rev_s,
                                            double depth_mm, int m) {
  const Mode& mode = process.modes[0];
  const double wn = 2.0 * std::numbers::pi * mode.frequency_hz;
  const double pass_rad = 2.0 * std::numbers::pi / static_cast<double>(process.tool.teeth);
  const double dt = 1.0 / (static_cast<double>(process.tool.teeth) * speed_rev_s) / m;
  const CuttingCoefficients coefficients(process, 0.0);
  constexpr int kMean = 20;  // points for the mean of h over a step
  Eigen::MatrixXd phi = Eigen::MatrixXd::Identity(m + 2, m + 2);
  for (int i = 0; i < m; ++i) {
    double h = 0.0;
    for (int s = 0; s < kMean; ++s) {
      const double angle = (i + (s + 0.5) / kMean) * pass_rad / m;
      for (std::size_t j = 0; j < process.tool.teeth; ++j) {
        h += coefficients.stiffness(j, angle)(0, 0) / kMean;
      }
    }
    const double cut = 1000.0 / mode.mass_kg * depth_mm * h;
    // e^{A·dt} of ẍ + d·ẋ + b·x = 0 in closed form.
    const double d = 2.0 * mode.damping_ratio * wn;
    const double b = wn * wn + cut;
    const std::complex<double> wd = std::sqrt(std::complex<double>(b - 0.25 * d * d));
    const double decay = std::exp(-0.5 * d * dt);
    const double c = (decay * std::cos(wd * dt)).real();
    const double s = (decay * std::sin(wd * dt) / wd).real();
    Eigen::Matrix2d a;
    a << 0.0, 1.0, -b, -d;
    Eigen::Matrix2d p;
    p << c + 0.5 * d * s, s, -b * s, c - 0.5 * d * s;
    const Eigen::Matrix2d j0 = a.inverse() * (p - Eigen::Matrix2d::Identity());
    const Eigen::Matrix2d j1 = a.inverse() * (j0 - dt * Eigen::Matrix2d::Identity()) / dt;
    const Eigen::Vector2d force(0.0, cut);
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(m + 2, m + 2);
    step.topLeftCorner(2, 2) = p;
    step.block(0, m, 2, 1) += j1 * force;
    step.block(0, m + 1, 2, 1) += (j0 - j1) * force;
    step(2, 0) = 1.0;
    for (int k = 3; k < m + 2; ++k) {
      step(k, k - 1) = 1.0;
    }
    phi = (step * phi).eval();
  }
  return phi.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace steadyrest::chatter::offline::test
