// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::online::test {

/// Nothing but the spindle's speed.
inline Drive turning(double speed_rev_s) {
  Drive drive;
  drive.speed_rev_s = speed_rev_s;
  return drive;
}

}  // namespace steadyrest::thermal::online::test
