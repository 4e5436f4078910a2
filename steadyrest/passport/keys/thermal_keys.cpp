// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/passport/keys/schema.hpp>

namespace steadyrest::passport {
using kernel::machine::kMaxThermalLevels;
using kernel::machine::Thermal;
using kernel::machine::ThermalAmbient;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

std::span<const Key<Thermal>> thermal_keys() noexcept {
  static const std::array kKeys = {
      Key<Thermal>{"enabled", &Thermal::enabled, 0, 0,
                   "The layer moves the axes on line against the displacement that it forecasts."},
      Key<Thermal>{"shares", &Thermal::share, 0.01, 1,
                   "Shares k of the tolerance that heat may take, level by level, falling: k0, k1, "
                   "k2, k3.",
                   Need::optional, For::any, 8},
      Key<Thermal>{"level", &Thermal::level, 0, 7, "The level in force."},
      Key<Thermal>{"max_offset_um", &Thermal::max_offset_mm, 0, 1000,
                   "No thermal correction goes beyond it."},
      Key<Thermal>{"slope_um_min", &Thermal::slope_mm_s, 0.001, 1000,
                   "How fast the on-line correction may change."},
      Key<Thermal>{"retract_slope_um_min", &Thermal::retract_slope_mm_s, 0, 60'000,
                   "The same while no tool is in the cut (rapids, tool changes and what follows "
                   "them standing); 0 = `slope_um_min`. The envelope's `offset_slew_um_s` holds."},
      Key<Thermal>{"state_s", &Thermal::state_s, -1e12, 1e12,
                   "Time in the log at which the modes had their `state_um`."},
  };
  return kKeys;
}

std::span<const Key<ThermalAxis>> thermal_axis_keys() noexcept {
  static const std::array kKeys = {
      Key<ThermalAxis>{"name", &ThermalAxis::name, 1, 32,
                       "The axis that it displaces, or the name of a displacement that no axis "
                       "corrects.",
                       Need::mandatory},
      Key<ThermalAxis>{"noise_um", &ThermalAxis::noise_mm, 0, 1000, "RMS of one reading."},
      Key<ThermalAxis>{"drift_um", &ThermalAxis::drift_mm, 0, 1000,
                       "RMS of what the model does not know, a first-order process."},
      Key<ThermalAxis>{"drift_tau_min", &ThermalAxis::drift_tau_s, 0.1, 1e5,
                       "Time constant of that process."},
      Key<ThermalAxis>{"drift_state_um", &ThermalAxis::drift_state_mm, -1e5, 1e5,
                       "What it had come to at `state_s`."},
      Key<ThermalAxis>{"zero_um", &ThermalAxis::zero_mm, -1e6, 1e6,
                       "What the gauge of the log shows where nothing displaces the machine; only "
                       "forecasts of that log go by it."},
      Key<ThermalAxis>{"max_speed_rpm", &ThermalAxis::max_speed_rev_s, 0, 1e6,
                       "Fastest spindle speed that was fitted; 0 = not known. No forecast beyond "
                       "1.2 times that."},
      Key<ThermalAxis>{
          "covariance", &ThermalAxis::covariance, -1e12, 1e12,
          "Lower triangle, row by row, of the covariance of the linear parameters (µm, "
          "µm/K): for each mode its levels or coefficients, then the ambient gains.",
          Need::optional, For::any, 65536},
  };
  return kKeys;
}

std::span<const Key<ThermalMode>> thermal_mode_keys() noexcept {
  static const std::array kKeys = {
      Key<ThermalMode>{"tau_min", &ThermalMode::tau_s, 0.01, 1e5,
                       "Time constant while the spindle turns.", Need::mandatory},
      Key<ThermalMode>{"rest_tau_min", &ThermalMode::rest_tau_s, 0, 1e5,
                       "Time constant while it stands; 0 = `tau_min`."},
      Key<ThermalMode>{"speeds_rpm", &ThermalMode::speed_rev_s, 0, 1e6,
                       "Spindle speeds of the table of levels, rising.", Need::optional, For::any,
                       kMaxThermalLevels},
      Key<ThermalMode>{"levels_um", &ThermalMode::level_mm, -1e4, 1e4,
                       "Displacement that the mode settles at, by speed; straight between them.",
                       Need::optional, For::any, kMaxThermalLevels},
      Key<ThermalMode>{"polynomial_um", &ThermalMode::polynomial_mm, -1e6, 1e6,
                       "Instead of a table: coefficients of n, n², …, n in 1000 rev/min.",
                       Need::optional, For::any, 8},
      Key<ThermalMode>{"cutting_percent", &ThermalMode::cutting_ratio, 0, 10000,
                       "Of the level, while feed moves are made."},
      Key<ThermalMode>{"coolant_percent", &ThermalMode::coolant_ratio, 0, 10000,
                       "Of the level, with coolant."},
      Key<ThermalMode>{"feed_um_m_min", &ThermalMode::feed_s, -1e4, 1e4,
                       "Added to the level for each m/min of feed."},
      Key<ThermalMode>{"tau_sd_percent", &ThermalMode::tau_sd_ratio, 0, 1000,
                       "Standard deviation of the time constant."},
      Key<ThermalMode>{"state_um", &ThermalMode::state_mm, -1e5, 1e5,
                       "The mode's displacement at `state_s`."},
  };
  return kKeys;
}

std::span<const Key<ThermalAmbient>> thermal_ambient_keys() noexcept {
  static const std::array kKeys = {
      Key<ThermalAmbient>{"sensor", &ThermalAmbient::sensor, 1, 32,
                          "Column of the temperature in a log.", Need::mandatory},
      Key<ThermalAmbient>{"tau_min", &ThermalAmbient::tau_s, 0, 1e5,
                          "Time by which the machine lags behind it; 0 = none."},
      Key<ThermalAmbient>{"gain_um_k", &ThermalAmbient::gain_mm_k, -1e4, 1e4,
                          "Displacement for each kelvin.", Need::mandatory},
      Key<ThermalAmbient>{"reference_c", &ThermalAmbient::reference_c, -50, 150,
                          "Temperature at which it displaces nothing."},
      Key<ThermalAmbient>{"state_c", &ThermalAmbient::state_c, -50, 150,
                          "The lagged temperature at `state_s`."},
  };
  return kKeys;
}

}  // namespace steadyrest::passport
