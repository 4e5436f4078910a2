// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/units/constants.hpp>

/// Cuts that the literature gives figures for, and one in closed form.
namespace steadyrest::chatter::offline::test {

/// One mode, two straight teeth: Insperger and Stépán.
inline Process benchmark_cut(double radial_immersion, Direction direction) {
  Process p;
  p.tool.teeth = 2;
  p.cut.radial_immersion = radial_immersion;
  p.cut.direction = direction;
  p.cut.tangential_n_mm2 = 600.0;
  p.cut.radial_n_mm2 = 200.0;
  Mode mode;
  mode.frequency_hz = 922.0;
  mode.damping_ratio = 0.011;
  mode.mass_kg = 0.03993;
  p.modes = {mode};
  return p;
}

inline constexpr double kTurned_hz = 100.0;
inline constexpr double kTurned_N_mm = 5000.0;

/// Turning along x, by the radial force alone: below 0 the tool digs in as it yields.
inline Process turned(double damping_ratio, double radial_n_mm2) {
  Process p;
  p.cut.operation = Operation::turning;
  p.cut.tangential_n_mm2 = 1.0;
  p.cut.radial_n_mm2 = radial_n_mm2;
  Mode mode;
  mode.frequency_hz = kTurned_hz;
  mode.damping_ratio = damping_ratio;
  mode.mass_kg = 1000.0 * kTurned_N_mm / std::pow(kernel::units::kTurn * kTurned_hz, 2);
  p.modes = {mode};
  return p;
}

}  // namespace steadyrest::chatter::offline::test
