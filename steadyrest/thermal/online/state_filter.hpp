// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::online {

/// The thermal model of one axis, corrected by readings of its displacement: a Kalman filter on the
/// states of the modes x_i, a slow bias d and one scale g of all levels.
///
///   x_i' = (g·G_i − x_i)/τ_i,   d: the passport's drift, a first-order process, or without one
///   a random walk;   g constant;   δ = Σ x_i + d + Σ b_j·(θ_j − θ_j0)
///
/// Steps are exact, like the model's: x_i ← a_i·x_i + (1 − a_i)·G_i·g with a_i = e^(−h/τ_i). The
/// drift gains the variance d²·(1 − a_d²), the walk w²·h.
///
/// A reading z with standard deviation r has the innovation ν = z − δ of variance S = HPHᵀ + r². It
/// is taken where |ν| ≤ gate·√S, else it is an outlier and changes nothing. e = ν/√S, limited to
/// ±gate so that one outlier alone proves nothing. The last 12 readings show whether the model
/// fits: from the fourth on Σe² must stay below the 99.9 % point of χ²_N, and |Σe|/√N below that of
/// the normal law. It fits again when the window says so, or after rezero().
///
/// Fixed size, noexcept, no allocation. Source: R. E. Kalman 1960; Y. Bar-Shalom, X. R. Li,
/// T. Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, §5.4
/// (consistency).
class StateFilter {
 public:
  static constexpr std::size_t kBias = kMaxThermalModes;
  static constexpr std::size_t kGain = kMaxThermalModes + 1;
  static constexpr std::size_t kStates = kMaxThermalModes + 2;
  /// Readings that decide whether the model fits. Limited to ±3 each, a lasting error of e shows
  /// when e·√N > 3.09: one standard deviation in 10 readings. Test
  /// ASmallErrorThatStaysIsToldFromNoise.
  static constexpr std::size_t kWindow = 12;
  /// Fewer prove nothing: with four, two at ±3 still reach neither point, 18 < 18.5 of χ²₄ and 6/√4
  /// < 3.09. Test AnOutlierChangesNothingAndAloneSaysNothing.
  static constexpr std::size_t kLeast = 4;

  struct Config {
    kernel::machine::ThermalAxis axis;
    double start_sd_mm = 0.0;    ///< of the displacement at the start, ≥ 0
    double gain_sd_ratio = 0.1;  ///< of g at the start, ≥ 0; 0 = the passport's levels are exact
    double walk_mm_sqrt_s = 0.002 / 60.0;  ///< w, ≥ 0; 2 µm in an hour
    double reading_sd_mm = 0.0005;  ///< of a reading, if neither it nor the passport has one; > 0
    double gate_sd = 3.0;           ///< > 0
    double max_bias_mm = 0.1;       ///< limit of |d|
    double min_gain = 0.5;          ///< limits of g
    double max_gain = 2.0;
  };

  struct Reading {
    double displacement_mm = 0.0;
    double sd_mm = 0.0;  ///< 0 = the passport's noise
  };

  /// What became of a reading.
  struct Verdict {
    /// thermal_reading_taken, thermal_reading_outlier, or input_not_finite
    kernel::outcome::Reason reason = kernel::outcome::Reason::none;
    double innovation_mm = 0.0;
    double innovation_sd_mm = 0.0;
    bool clamped = false;  ///< bias or scale is at its limit
  };

  using Covariance = std::array<std::array<double, kStates>, kStates>;

  struct State {
    ThermalModel::State model;
    double bias_mm = 0.0;
    double gain = 1.0;
    Covariance covariance{};                   ///< mm², of the modes, the bias and the scale
    std::array<double, kWindow> innovation{};  ///< e of the last readings, a ring
    std::size_t readings = 0;                  ///< since the start
    bool clamped = false;                      ///< by the last reading that was taken
  };

  [[nodiscard]] static kernel::outcome::Result<StateFilter> make(const Config& config);

  /// The displacement in mm after `elapsed_s` ≥ 0 of `drive`. Input that is not finite, or negative
  /// time, changes nothing.
  double update(double elapsed_s, const Drive& drive) noexcept;
  /// A reading of the present displacement.
  Verdict measure(const Reading& reading) noexcept;
  /// Takes the reading regardless of the gate; the bias becomes the difference. Earlier readings no
  /// longer count against the model. Does nothing when the reading is not finite.
  void rezero(const Reading& reading) noexcept;

  [[nodiscard]] double displacement_mm() const noexcept;
  /// Standard deviation of the displacement, without the reading's own.
  [[nodiscard]] double sd_mm() const noexcept;
  [[nodiscard]] double bias_mm() const noexcept { return state_.bias_mm; }
  /// g, the scale of all levels.
  [[nodiscard]] double gain() const noexcept { return state_.gain; }
  /// none, or thermal_model_unfit.
  [[nodiscard]] kernel::outcome::Reason fault() const noexcept;
  [[nodiscard]] const ThermalModel& model() const noexcept { return model_; }

  [[nodiscard]] State state() const noexcept;
  /// Rejects a state that is not finite: the filter starts over.
  void restore(const State& state) noexcept;
  /// Cold.
  void reset() noexcept;
  /// From known states of the modes and lagged temperatures.
  void start(const ThermalModel::State& state) noexcept;

 private:
  StateFilter(const Config& config, ThermalModel model);
  void spread(double elapsed_s, const std::array<double, kMaxThermalModes>& left,
              const std::array<double, kMaxThermalModes>& gained_mm) noexcept;
  [[nodiscard]] double variance_mm2() const noexcept;
  [[nodiscard]] double reading_sd_mm(const Reading& reading) const noexcept;
  [[nodiscard]] bool clamp() noexcept;

  Config config_;  ///< its axis is the model's
  ThermalModel model_;
  std::size_t modes_;
  State state_;  ///< only state() fills in `model`
  struct BiasStep {
    double elapsed_s = -1.0;
    double left = 1.0;
    double variance_mm2 = 0.0;
  } bias_step_;
};

}  // namespace steadyrest::thermal::online
