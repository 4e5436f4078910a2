// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/chatter/offline/cycle/gauss_nodes.hpp>
#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>

/// What every map of a pass consists of: pieces within which everything is smooth, and the modes'
/// response within a piece.
namespace steadyrest::chatter::offline {

/// Over one piece, collocated at n Gauss nodes; c directions, m modes. Displacements are stored
/// direction by direction; the state is q and v/ω of each mode.
struct ModalAnswers {
  Eigen::MatrixXd phi;       ///< displacement at the nodes from the state at the start, cn×2m
  Eigen::MatrixXd phi_rate;  ///< its rate
  Eigen::MatrixXd k;         ///< displacement from the forces at the nodes, cn×cn
  Eigen::MatrixXd k_rate;
  Eigen::MatrixXd e;  ///< state at the end from the state at the start, 2m×2m
  Eigen::MatrixXd r;  ///< … from the forces, 2m×cn
};

/// `sigma_s`: the piece's length over the speed at each node. The rates stay empty without process
/// damping. [I + 2ζω·Σ + ω²·Σ²]·v = v₀ − ω²·q₀·Σ1 + Σ·f with Σ = S·diag(σ).
[[nodiscard]] ModalAnswers modal_answers(const Process& process, const GaussNodes& gauss,
                                         const Eigen::VectorXd& sigma_s, Eigen::Index directions,
                                         bool rates);

/// e of the above for the free vibration over that time, in closed form.
[[nodiscard]] Eigen::MatrixXd free_answer(const Process& process, double length_s);

/// Multipliers of the free vibration over that time, one of each conjugate pair.
[[nodiscard]] std::vector<std::complex<double>> free_multipliers(const Process& process,
                                                                 double length_s);

/// 1: only x vibrates, else 2.
[[nodiscard]] Eigen::Index directions(const Process& process) noexcept;

/// An upper bound on the rate of any oscillation, or decay by process damping, at this depth and
/// speed: √Λ + 1000·a·z·C/v·‖BᵀB‖, Λ the largest eigenvalue of diag ω² + 1000·a·z·|(Kt, Kr)|·BᵀB,
/// with shape/√m of each mode as the columns of B and z teeth cutting at once.
[[nodiscard]] double fastest_rad_s(const Process& process, double depth_mm, double speed_rev_s);

/// Angles within a pass, rising from 0 to its end, at which the cut is not smooth, including those
/// in `others`. With uneven pitch, each kink returns with every tooth's delay.
[[nodiscard]] std::vector<double> corners_of_pass(const Process& process,
                                                  const CuttingCoefficients& coefficients,
                                                  double pass_rad,
                                                  const std::vector<double>& others = {});

/// Whether a tooth cuts at this angle of the pass.
[[nodiscard]] bool cuts_at(const CuttingCoefficients& coefficients, double pass_rad,
                           double angle_rad) noexcept;

}  // namespace steadyrest::chatter::offline
