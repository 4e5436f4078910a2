// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/passport/keys/schema.hpp>

// The thermal model's keys. Its law is x' = (G(n) − x)/τ for each mode, and gain·(lagged
// temperature − reference) for the surroundings (thermal/README.md).
namespace steadyrest::passport {
using kernel::machine::kMaxThermalLevels;
using kernel::machine::Thermal;
using kernel::machine::ThermalAmbient;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

std::span<const Key<Thermal>> thermal_keys() noexcept {
  static const std::array kKeys = {
      Key<Thermal>{"enabled", &Thermal::enabled, 0, 0,
                   "The layer offsets the axes on line to cancel the forecast drift."},
      Key<Thermal>{
          // The paper's k: the part of the tolerance that drift may use up. Measured parts shift it
          // by one level at a time.
          "shares", &Thermal::share, 0.01, 1,
          "Share k of the tolerance allowed for drift, level by level, falling: k0, k1, k2, k3.",
          Need::optional, For::any, 8},
      Key<Thermal>{"level", &Thermal::level, 0, 7, "The level in force."},
      Key<Thermal>{"max_offset_um", &Thermal::max_offset_mm, 0, 1000,
                   "Limit of any thermal correction."},
      Key<Thermal>{"slope_um_min", &Thermal::slope_mm_s, 0.001, 1000,
                   "Largest rate of change of the on-line correction."},
      Key<Thermal>{
          "retract_slope_um_min", &Thermal::retract_slope_mm_s, 0, 60'000,
          "The same while no tool is in the cut (rapids, tool changes and any standstill after "
          "them); 0 = `slope_um_min`. The envelope's `offset_slew_um_s` still applies."},
      Key<Thermal>{"state_s", &Thermal::state_s, -1e12, 1e12, "Log time of the `state_um` values."},
  };
  return kKeys;
}

/// Noise and drift set the width of the band and the weight of a reading.
std::span<const Key<ThermalAxis>> thermal_axis_keys() noexcept {
  static const std::array kKeys = {
      Key<ThermalAxis>{"name", &ThermalAxis::name, 1, 32,
                       "The axis that drifts, or the name of a displacement that no axis corrects.",
                       Need::mandatory},
      Key<ThermalAxis>{"noise_um", &ThermalAxis::noise_mm, 0, 1000, "RMS noise of a reading."},
      // What no mode explains is modelled as noise with a memory, so that a reading corrects the
      // near future more than the distant one.
      Key<ThermalAxis>{"drift_um", &ThermalAxis::drift_mm, 0, 1000,
                       "RMS of the unmodelled part, a first-order process."},
      Key<ThermalAxis>{"drift_tau_min", &ThermalAxis::drift_tau_s, 0.1, 1e5,
                       "Time constant of that process."},
      Key<ThermalAxis>{"drift_state_um", &ThermalAxis::drift_state_mm, -1e5, 1e5,
                       "Its value at `state_s`."},
      Key<ThermalAxis>{
          "zero_um", &ThermalAxis::zero_mm, -1e6, 1e6,
          "The gauge reading in the log at zero displacement; only forecasts of that log use it."},
      Key<ThermalAxis>{
          "max_speed_rpm", &ThermalAxis::max_speed_rev_s, 0, 1e6,
          "Fastest spindle speed in the fit; 0 = unknown. No forecast beyond 1.2 times that."},
      Key<ThermalAxis>{
          // The parameters were fitted together and their errors are correlated; the band of a
          // forecast needs the whole matrix.
          "covariance", &ThermalAxis::covariance, -1e12, 1e12,
          "Lower triangle, row by row, of the covariance of the linear parameters (µm, µm/K): the "
          "levels or coefficients of each mode, then the ambient gains.",
          Need::optional, For::any, 65536},
  };
  return kKeys;
}

/// tau_min applies with the spindle turning: windage carries heat away, so a spindle often cools
/// more slowly at rest (rest_tau_min).
std::span<const Key<ThermalMode>> thermal_mode_keys() noexcept {
  static const std::array kKeys = {
      Key<ThermalMode>{"tau_min", &ThermalMode::tau_s, 0.01, 1e5,
                       "Time constant with the spindle turning.", Need::mandatory},
      Key<ThermalMode>{"rest_tau_min", &ThermalMode::rest_tau_s, 0, 1e5,
                       "Time constant with the spindle stopped; 0 = `tau_min`."},
      Key<ThermalMode>{"speeds_rpm", &ThermalMode::speed_rev_s, 0, 1e6,
                       "Spindle speeds of the table of levels, rising.", Need::optional, For::any,
                       kMaxThermalLevels},
      Key<ThermalMode>{"levels_um", &ThermalMode::level_mm, -1e4, 1e4,
                       "Displacement the mode settles at, for each speed; linear between them.",
                       Need::optional, For::any, kMaxThermalLevels},
      Key<ThermalMode>{"polynomial_um", &ThermalMode::polynomial_mm, -1e6, 1e6,
                       "Instead of a table: coefficients of n, n², …, with n in 1000 rev/min.",
                       Need::optional, For::any, 8},
      Key<ThermalMode>{
          "cutting_percent", &ThermalMode::cutting_ratio, 0, 10000,
          "Level during feed moves, relative to the level otherwise; 100 = no change."},
      Key<ThermalMode>{"coolant_percent", &ThermalMode::coolant_ratio, 0, 10000,
                       "Level with coolant on, relative to the level without it; 100 = no change."},
      Key<ThermalMode>{"feed_um_m_min", &ThermalMode::feed_s, -1e4, 1e4,
                       "Added to the level per m/min of feed."},
      Key<ThermalMode>{"tau_sd_percent", &ThermalMode::tau_sd_ratio, 0, 1000,
                       "Standard deviation of the time constant."},
      Key<ThermalMode>{"state_um", &ThermalMode::state_mm, -1e5, 1e5,
                       "Displacement of the mode at `state_s`."},
  };
  return kKeys;
}

/// The lag is that of the machine, not of the air: iron follows the room by hours.
std::span<const Key<ThermalAmbient>> thermal_ambient_keys() noexcept {
  static const std::array kKeys = {
      Key<ThermalAmbient>{"sensor", &ThermalAmbient::sensor, 1, 32,
                          "Temperature column in the log.", Need::mandatory},
      Key<ThermalAmbient>{"tau_min", &ThermalAmbient::tau_s, 0, 1e5,
                          "Lag of the machine behind it; 0 = none."},
      Key<ThermalAmbient>{"gain_um_k", &ThermalAmbient::gain_mm_k, -1e4, 1e4,
                          "Displacement per kelvin.", Need::mandatory},
      Key<ThermalAmbient>{"reference_c", &ThermalAmbient::reference_c, -50, 150,
                          "Temperature at zero displacement."},
      Key<ThermalAmbient>{"state_c", &ThermalAmbient::state_c, -50, 150,
                          "Lagged temperature at `state_s`."},
  };
  return kKeys;
}

}  // namespace steadyrest::passport
