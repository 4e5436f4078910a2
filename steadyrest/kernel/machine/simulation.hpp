// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace steadyrest::kernel::machine {

/// Numbers that belong to the simulated machine alone.
struct Simulation {
  std::uint64_t seed = 1;
  double position_noise_mm = 0.0;  ///< RMS of what disturbs the true position (vibration, load)
  // Heat: the truth is the thermal passport, altered by these errors.
  std::vector<double>
      thermal_tau_error_ratio;  ///< in the order of Thermal::terms(); the last for the rest
  std::vector<double> thermal_gain_error_ratio;  ///< likewise: of the levels and ambient gains
  double room_c = 20.0;                          ///< mean temperature of the room
  double room_swing_k = 0.0;                     ///< amplitude over the day, warmest at 15:00
  double room_noise_k = 0.0;                     ///< RMS of what doors and draughts do to it
  double room_start_s = 8.0 * 3600.0;            ///< time of day at which the simulation begins
  double sensor_noise_k = 0.0;                   ///< RMS of one reading of a temperature
  double probe_noise_mm = 0.0;                   ///< RMS of one reading of the probe
};

}  // namespace steadyrest::kernel::machine
