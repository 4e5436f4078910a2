// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/sim/heat/thermal_growth.hpp>
#include <steadyrest/sim/machine_body.hpp>

/// Axes that grow as in the paper, and with the room.
namespace steadyrest::sim::test {

using kernel::machine::Thermal;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

inline constexpr double kMinute = 60.0;

/// Marusich's example: one mode of Z.
inline Thermal paper() {
  ThermalMode mode;
  mode.tau_s = 53.475 * kMinute;
  mode.speed_rev_s = {0.0, 1000.0 / 60.0, 2000.0 / 60.0};
  mode.level_mm = {0.0, 0.0352245, 0.0490785};
  ThermalAxis axis;
  axis.mode = {mode};
  Thermal thermal;
  thermal.axis = {axis};
  return thermal;
}

inline Thermal ambient(double gain_mm_k, double tau_s) {
  Thermal thermal = paper();
  thermal.axis[0].mode[0].level_mm = {0.0, 0.0, 0.0};
  thermal.axis[0].ambient = {{.tau_s = tau_s, .gain_mm_k = gain_mm_k}};
  return thermal;
}

}  // namespace steadyrest::sim::test
