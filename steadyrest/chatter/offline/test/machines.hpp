// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

#include <steadyrest/kernel/machine/machine.hpp>

/// Machines for the planner's tests.
namespace steadyrest::chatter::offline::test {

/// A strong and light spindle with these override steps; each test removes something.
inline kernel::machine::Machine light_spindle(std::initializer_list<int> percent) {
  kernel::machine::Machine m;
  m.spindle.max_rev_s = 500.0;
  m.spindle.acceleration_rev_s2 = 1000.0;
  m.spindle.inertia_kg_m2 = 1e-4;
  m.spindle.rated_power_w = 1e5;
  m.spindle.max_torque_n_m = 1e3;
  m.spindle.speed_tolerance_ratio = 0.0;
  m.envelope.spindle_slew_1_s = 100.0;
  m.spindle_override.scan_period_s = 0.005;
  for (const int p : percent) {
    m.spindle_override.ratio.push_back(0.01 * p);
  }
  for (int p = 0; p <= 120; p += 5) {
    m.feed_override.ratio.push_back(0.01 * p);
  }
  m.feed_override.scan_period_s = 0.005;
  return m;
}

}  // namespace steadyrest::chatter::offline::test
