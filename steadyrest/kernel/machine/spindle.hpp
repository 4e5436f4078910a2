// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/unlimited.hpp>

namespace steadyrest::kernel::machine {

struct Spindle {
  double max_rev_s = 200.0;
  double min_rev_s = 0.0;
  double acceleration_rev_s2 = 50.0;
  double inertia_kg_m2 = 0.01;
  double rated_power_w = 10e3;
  double max_torque_n_m = 70.0;
  double rated_torque_n_m = kUnlimited;  ///< RMS, continuous (S1); without it the largest torque
  double speed_tolerance_ratio = 0.10;   ///< band of the control's speed monitor about its
                                         ///< set-point; 0 = the control has none

  friend bool operator==(const Spindle&, const Spindle&) = default;
};

}  // namespace steadyrest::kernel::machine
