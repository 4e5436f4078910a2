// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/small_inverse.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// For one piece, each mode's equation of motion is turned into an integral equation and solved at
// the Gauss nodes for unit start values and unit forces. The columns of the solution are the
// matrices Φ, K, E and R that every solver of this folder builds on.
namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;
using kernel::units::kTurn;

// Corners closer than this are one corner, apart by rounding.
constexpr double kSameAngle = 1e-10;  ///< rad

double modulo(double angle, double period) {
  const double out = angle - std::floor(angle / period) * period;
  return out >= period - kSameAngle ? 0.0 : out;
}

}  // namespace

Index directions(const Process& process) noexcept {
  return std::ranges::all_of(process.modes, [](const Mode& m) { return m.shape[1] == 0.0; }) ? 1
                                                                                             : 2;
}

// Delayed displacements only drive; the free oscillation at a frozen angle is λ²·v + λ·(D +
// 1000·Bᵀ·P·B)·v + (diag ω² + 1000·a·BᵀHB)·v = 0, with H = Σ_j H_j, D = diag 2ζω and the columns of
// B shape/√m. Times v* for |v| = 1 it is λ² + λ·d + κ = 0, d ≥ 0, and
//   |κ| ≤ v*·(diag ω² + 1000·a·‖H‖·BᵀB)·v ≤ the largest eigenvalue Λ of that matrix.
// With s² = d²/4 − κ the oscillation is |Im s|, which is largest for d = 0: |Im λ|² ≤ (|κ| +
// Re κ)/2 ≤ Λ. Process damping decays at no more than its own d ≤ 1000·‖P‖·‖BᵀB‖.
double fastest_rad_s(const Process& process, double depth_mm, double speed_rev_s) {
  if (process.modes.empty()) {
    return 0.0;
  }
  // Straight edges are the worst case, so the coefficients are taken at zero depth.
  const double at_once = CuttingCoefficients(process, 0.0).most_at_once();
  const double stiffness =
      depth_mm * at_once * std::hypot(process.cut.tangential_n_mm2, process.cut.radial_n_mm2);
  const double damping = depth_mm * at_once * process.cut.process_damping_n_mm /
                         (std::numbers::pi * process.tool.diameter_mm * speed_rev_s);
  const auto modes = static_cast<Index>(process.modes.size());
  Eigen::MatrixXd b(2, modes);
  Eigen::VectorXd free(modes);
  for (Index k = 0; k < modes; ++k) {
    const Mode& mode = process.modes[static_cast<std::size_t>(k)];
    b.col(k) << mode.shape[0], mode.shape[1];
    b.col(k) *= std::sqrt(1000.0 / mode.mass_kg);
    free[k] = std::pow(kTurn * mode.frequency_hz, 2);
  }
  const auto largest = [](const Eigen::MatrixXd& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
  };
  const Eigen::MatrixXd compliance = b.transpose() * b;
  Eigen::MatrixXd stiff = stiffness * compliance;
  stiff.diagonal() += free;
  // Their sum is on the safe side for the choice of nodes.
  return std::sqrt(largest(stiff)) + (damping > 0.0 ? damping * largest(compliance) : 0.0);
}

std::vector<double> corners_of_pass(const Process& process, const CuttingCoefficients& coefficients,
                                    double pass_rad, const std::vector<double>& others) {
  std::vector<double> all{0.0};
  for (const double angle : others) {
    all.push_back(modulo(angle, pass_rad));
  }
  const bool even = process.even_pitch();
  for (std::size_t j = 0; j < coefficients.teeth(); ++j) {
    for (const double c : coefficients.corners_rad(j)) {
      all.push_back(modulo(c, pass_rad));
      for (std::size_t k = 0; !even && k < coefficients.teeth(); ++k) {
        // A kink in the displacement returns with the delay of each tooth that reads it.
        all.push_back(modulo(c + process.pitch_rad(k), pass_rad));
      }
    }
  }
  std::ranges::sort(all);
  std::vector<double> out;
  for (const double c : all) {
    if (out.empty() || c - out.back() > kSameAngle) {
      out.push_back(c);
    }
  }
  out.push_back(pass_rad);
  return out;
}

bool cuts_at(const CuttingCoefficients& coefficients, double pass_rad, double angle_rad) noexcept {
  for (std::size_t j = 0; j < coefficients.teeth(); ++j) {
    // All teeth fold onto one pass: it cuts if any tooth cuts at any of the angles that fold onto
    // this place.
    for (double turn = 0.0; turn < kTurn - kSameAngle; turn += pass_rad) {
      if (coefficients.stiffness(j, angle_rad + turn).cwiseAbs().maxCoeff() > 0.0) {
        return true;
      }
    }
  }
  return false;
}

// Of each mode v = v₀ − 2ζω·∫v − ω²·∫q + (1000/m)·∫f with q = q₀ + ∫v; 1000: N/kg to mm/s².
// Collocated for the velocity, not the displacement: integrating twice is well conditioned,
// differentiating is not. A force along b excites the mode by shape_b, and the mode moves the tool
// along c by shape_c.
ModalAnswers modal_answers(const Process& process, const GaussNodes& gauss,
                           const Eigen::VectorXd& sigma_s, Index directions, bool rates) {
  const Index n = sigma_s.size();
  const Index size = n * directions;
  const auto modes = static_cast<Index>(process.modes.size());
  // S·diag(σ) integrates over time from the piece's start to each node, `end` to the piece's end.
  const Eigen::MatrixXd s = gauss.integral * sigma_s.asDiagonal();
  const Eigen::MatrixXd s2 = s * s;
  const Eigen::RowVectorXd end = gauss.weight.cwiseProduct(sigma_s).transpose();
  ModalAnswers out{Eigen::MatrixXd::Zero(size, 2 * modes),
                   Eigen::MatrixXd::Zero(rates ? size : 0, 2 * modes),
                   Eigen::MatrixXd::Zero(size, size),
                   Eigen::MatrixXd::Zero(rates ? size : 0, size),
                   Eigen::MatrixXd::Zero(2 * modes, 2 * modes),
                   Eigen::MatrixXd::Zero(2 * modes, size)};
  SmallInverse inverse;
  for (Index m = 0; m < modes; ++m) {
    const Mode& mode = process.modes[static_cast<std::size_t>(m)];
    const double w = kTurn * mode.frequency_hz;
    const double d = 2.0 * mode.damping_ratio * w;
    inverse.make(d * s + w * w * s2, 1.0);
    // Columns: from q₀, from v₀/ω, from the force.
    Eigen::MatrixXd right(n, n + 2);
    right.col(0) = -w * w * s.rowwise().sum();
    right.col(1).setConstant(w);
    right.rightCols(n) = 1000.0 / mode.mass_kg * s;
    Eigen::MatrixXd v(n, n + 2);
    for (Index col = 0; col < n + 2; ++col) {
      inverse.apply({right.col(col).data(), static_cast<std::size_t>(n)},
                    {v.col(col).data(), static_cast<std::size_t>(n)});
    }
    // Everything else follows from v by one more integration, without another solve.
    Eigen::MatrixXd q = s * v;
    q.col(0).array() += 1.0;
    const Eigen::RowVectorXd q_end = end * v;
    Eigen::RowVectorXd v_end = -w * w * (end * q) - d * q_end;
    v_end.tail(n) += 1000.0 / mode.mass_kg * end;
    out.e.block(2 * m, 2 * m, 1, 2) = q_end.head(2);
    out.e.block(2 * m + 1, 2 * m, 1, 2) = v_end.head(2) / w;
    out.e(2 * m, 2 * m) += 1.0;
    out.e(2 * m + 1, 2 * m + 1) += 1.0;
    for (Index c = 0; c < directions; ++c) {
      const double shape = mode.shape[static_cast<std::size_t>(c)];
      out.phi.block(c * n, 2 * m, n, 2) = shape * q.leftCols(2);
      out.r.block(2 * m, c * n, 1, n) = shape * q_end.tail(n);
      out.r.block(2 * m + 1, c * n, 1, n) = shape * v_end.tail(n) / w;
      if (rates) {
        out.phi_rate.block(c * n, 2 * m, n, 2) = shape * v.leftCols(2);
      }
      for (Index b = 0; b < directions; ++b) {
        const double both = shape * mode.shape[static_cast<std::size_t>(b)];
        out.k.block(c * n, b * n, n, n) += both * q.rightCols(n);
        if (rates) {
          out.k_rate.block(c * n, b * n, n, n) += both * v.rightCols(n);
        }
      }
    }
  }
  return out;
}

std::vector<std::complex<double>> free_multipliers(const Process& process, double length_s) {
  std::vector<std::complex<double>> out;
  out.reserve(process.modes.size());
  // μ = e^{(−ζ + i√(1−ζ²))·ωt}.
  for (const Mode& mode : process.modes) {
    const double turn = kTurn * mode.frequency_hz * length_s;
    const double z = mode.damping_ratio;
    out.push_back(std::exp(std::complex<double>(-z, std::sqrt(1.0 - z * z)) * turn));
  }
  return out;
}

Eigen::MatrixXd free_answer(const Process& process, double length_s) {
  const auto modes = static_cast<Index>(process.modes.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2 * modes, 2 * modes);
  // q = e^{−ζωt}·[(cos ω_d t + ζω/ω_d·sin ω_d t)·q₀ + ω/ω_d·sin ω_d t·(v₀/ω)], v/ω likewise. With
  // v/ω in place of v both rows have the unit of a length, and the norms of the growth make sense.
  for (Index m = 0; m < modes; ++m) {
    const Mode& mode = process.modes[static_cast<std::size_t>(m)];
    const double z = mode.damping_ratio;
    // The process file allows ζ up to 0.999, so the root is never 0.
    const double root = std::sqrt(1.0 - z * z);
    const double turn = kTurn * mode.frequency_hz * length_s;
    const double decay = std::exp(-z * turn);
    const double c = decay * std::cos(root * turn);
    const double s = decay * std::sin(root * turn) / root;
    out.block<2, 2>(2 * m, 2 * m) << c + z * s, s, -s, c - z * s;
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
