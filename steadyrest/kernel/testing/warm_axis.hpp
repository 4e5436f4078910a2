// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/thermal.hpp>

namespace steadyrest::kernel::testing {

/// Z grows by 10 µm at 100 rev/s, with a time constant of ten minutes.
inline machine::ThermalAxis warm_z() {
  machine::ThermalAxis z;
  z.name = "Z";
  z.mode.emplace_back();
  z.mode[0].tau_s = 600.0;
  z.mode[0].speed_rev_s = {0.0, 100.0};
  z.mode[0].level_mm = {0.0, 0.010};
  return z;
}

}  // namespace steadyrest::kernel::testing
