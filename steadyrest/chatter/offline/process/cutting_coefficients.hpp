// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <steadyrest/chatter/offline/process/process.hpp>

/// The force response of a tooth to a change of its chip, by spindle angle θ.
///
/// Tooth j is at φ_j = θ − Σ_{i=1…j} pitch_i and cuts while entry ≤ φ_j ≤ exit, the angle taken
/// within one turn. To Δ = (x, y) minus the surface left by the tooth in front it responds with
/// F = −a·H_j(θ)·Δ, H = u·nᵀ with n = (sin φ, cos φ), u = Kt·(cos φ, −sin φ) + Kr·(sin φ, cos φ);
/// and to the velocity with F = −a·P_j(θ)·(ẋ, ẏ), P = C/v·n·nᵀ. With helix both are the mean over
/// the height 0 … a, in closed form; they then depend on the depth. Unit of H: N/mm², of P:
/// N·s/mm². Source: Altintas and Budak, CIRP Annals 44 (1995) 357; reference values and angles:
/// Insperger and Stépán.
namespace steadyrest::chatter::offline {

class CuttingCoefficients {
 public:
  /// `depth_mm` matters only for helical teeth.
  CuttingCoefficients(const Process& process, double depth_mm);

  [[nodiscard]] std::size_t teeth() const noexcept { return offset_rad_.size(); }
  [[nodiscard]] Eigen::Matrix2d stiffness(std::size_t tooth, double angle_rad) const noexcept;
  /// At 1 rev/s of the spindle; divide by the speed.
  [[nodiscard]] Eigen::Matrix2d damping(std::size_t tooth, double angle_rad) const noexcept;
  /// Angles within [0, 2π) at which this tooth's response is not smooth.
  [[nodiscard]] std::vector<double> corners_rad(std::size_t tooth) const;
  /// The most teeth whose stiffness acts in one direction: the largest ‖Σ_j H_j(θ)‖₂ over |(Kt,
  /// Kr)|. For straight edges; helical ones never have more.
  [[nodiscard]] double most_at_once() const;

 private:
  /// ∫ of sin², sin·cos, cos² over the engaged part of the edge, per unit of depth.
  [[nodiscard]] Eigen::Vector3d squares(std::size_t tooth, double angle_rad) const noexcept;

  Cut cut_;
  double entry_rad_;
  double exit_rad_;
  double repeats_rad_;        ///< the pitch where it is even, else a turn
  double lag_rad_ = 0.0;      ///< of the edge's top behind its tip
  double damping_n_s_ = 0.0;  ///< C over the cutting speed at 1 rev/s
  std::vector<double> offset_rad_;
};

}  // namespace steadyrest::chatter::offline
