// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/plan/cyclogram.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::offline {

/// In units of the fit's fastest speed: no forecast is made for faster ones.
inline constexpr double kBeyondFitted = 1.2;

/// Of the linear parameters, in the passport's order and units (µm, µm/K); 0 if it states none.
[[nodiscard]] Eigen::MatrixXd covariance_um2(const kernel::machine::ThermalAxis& axis);

/// How uncertain a model's displacement is, if it was known at the beginning. Variance:
///   φᵀ·C·φ + Σ (∂δ/∂ln τ_i)²·σ_i² + d²·(1 − e^(−2t/τ_d))
/// φ the model's response to a unit of each linear parameter, C their covariance, σ_i the standard
/// deviation of ln τ_i, d and τ_d the drift that the model does not know. Exact steps, like the
/// model's own.
class Uncertainty {
 public:
  explicit Uncertainty(const online::ThermalModel& model);

  /// One step with constant inputs; `before` is the model's state at its start.
  void step(double elapsed_s, const online::Drive& drive,
            const online::ThermalModel::State& before);
  /// Standard deviation of the displacement now, mm.
  [[nodiscard]] double sd_mm() const;
  /// The displacement's present response to the parameters.
  struct Answer {
    Eigen::VectorXd linear;         ///< mm per mm, and K
    std::vector<double> by_tau_mm;  ///< ∂δ/∂ln τ
  };
  [[nodiscard]] Answer answer() const { return {phi_, by_tau_mm_}; }
  /// Variance from the parameters of the change since then, mm².
  [[nodiscard]] double parameter_variance_mm2(const Answer& since) const;
  /// ∂δ/∂(linear parameter), in the passport's order; mm per mm, and K.
  [[nodiscard]] const Eigen::VectorXd& sensitivity() const noexcept { return phi_; }

 private:
  online::ThermalModel model_;              ///< source of levels and time constants
  std::vector<online::ThermalModel> unit_;  ///< one for each linear parameter of the modes
  Eigen::MatrixXd covariance_um2_;
  Eigen::VectorXd phi_;
  std::vector<double> by_tau_mm_;
  std::vector<double> ambient_start_c_;
  double elapsed_s_ = 0.0;
};

struct ForecastPoint {
  double time_s = 0.0;
  std::size_t transition = 0;
  double displacement_mm = 0.0;
  double sd_mm = 0.0;
};

/// 95 % of the readings lie within this many standard deviations.
inline constexpr double kBand = 1.96;

/// The displacement every `step_s` and at the end of each transition, from the model's present
/// state on. `ambient_c` as for curve_of().
[[nodiscard]] std::vector<ForecastPoint> forecast(online::ThermalModel model,
                                                  const Cyclogram& cyclogram, double step_s,
                                                  const std::vector<double>& ambient_c = {});

}  // namespace steadyrest::thermal::offline
