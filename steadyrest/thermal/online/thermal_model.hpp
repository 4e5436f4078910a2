// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::thermal::online {

using kernel::machine::kMaxThermalAmbients;
using kernel::machine::kMaxThermalModes;

/// What heats the machine; constant over one step.
struct Drive {
  double speed_rev_s = 0.0;  ///< of the spindle, signed
  double feed_mm_s = 0.0;    ///< mean speed along the path
  bool cutting = false;      ///< in feed moves
  /// Share of the time spent cutting, where the step is longer than a move.
  double cutting_share = 1.0;
  bool coolant = false;
  /// In the order of the passport's ambient inputs; NaN: unknown, the last value is held.
  std::array<double, kMaxThermalAmbients> ambient_c{};
};

/// Displacement of one axis by its thermal modes and surroundings:
///   x_i' = (G_i − x_i)/τ_i,  θ_j' = (T_j − θ_j)/τ_j,  δ = Σ x_i + Σ b_j·(θ_j − θ_j0)
/// in exact exponential steps, so the step size does not matter while the inputs are constant.
/// Levels are linear between the points of a table and constant beyond its ends.
class ThermalModel {
 public:
  using Config = kernel::machine::ThermalAxis;

  struct State {
    std::array<double, kMaxThermalModes> mode_mm{};
    std::array<double, kMaxThermalAmbients> ambient_c{};  ///< lagged; NaN: not seen yet
  };

  /// Refuses time constants that are not positive and inconsistent tables.
  [[nodiscard]] static kernel::outcome::Result<ThermalModel> make(const Config& config);

  /// The displacement in mm after `elapsed_s` ≥ 0 of `drive`. A sensor's first temperature also
  /// becomes its lagged one. An input that is not finite, or a negative time, changes nothing.
  double update(double elapsed_s, const Drive& drive) noexcept;

  [[nodiscard]] double displacement_mm() const noexcept;
  /// The mode's final level.
  [[nodiscard]] double level_mm(std::size_t mode, const Drive& drive) const noexcept;
  /// The mode's time constant in force.
  [[nodiscard]] double tau_s(std::size_t mode, const Drive& drive) const noexcept;
  /// e^(−elapsed/τ) of a mode: what is left of its distance from the level.
  [[nodiscard]] double decay(std::size_t mode, double elapsed_s, const Drive& drive) noexcept {
    return kept(mode_decay_[mode], tau_s(mode, drive), elapsed_s);
  }
  [[nodiscard]] const Config& config() const noexcept { return config_; }

  [[nodiscard]] const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept;
  /// Sets only the modes.
  void set_modes(const std::array<double, kMaxThermalModes>& mode_mm) noexcept {
    state_.mode_mm = mode_mm;
  }
  /// Cold: no displacement, no temperature seen.
  void reset() noexcept;

 private:
  explicit ThermalModel(Config config);
  /// Steps usually have one period: keeps the exponential of each time constant.
  struct Decay {
    double tau_s = -1.0;
    double elapsed_s = -1.0;
    double factor = 1.0;
  };
  [[nodiscard]] static double kept(Decay& decay, double tau_s, double elapsed_s) noexcept;
  void lag(double elapsed_s, const Drive& drive) noexcept;
  void sum_up_ambient() noexcept;

  Config config_;
  State state_;
  std::array<Decay, kMaxThermalModes> mode_decay_{};
  /// One per distinct time constant of the ambient inputs, and the index of each input's own.
  std::array<Decay, kMaxThermalAmbients> lag_decay_{};
  std::size_t lags_ = 0;
  std::array<std::size_t, kMaxThermalAmbients> lag_of_{};
  double lag_elapsed_s_ = -1.0;
  std::array<double, kMaxThermalAmbients> left_{};  ///< their exponentials, for that time
  std::array<double, kMaxThermalAmbients> gain_mm_k_{};
  std::array<double, kMaxThermalAmbients> reference_c_{};
  double ambient_mm_ = 0.0;  ///< the inputs' part of the displacement, as the state has it
};

}  // namespace steadyrest::thermal::online
