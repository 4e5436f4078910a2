// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/plan/plan.hpp>

/// The paper's machine and its plan.
namespace steadyrest::thermal::offline::test {

using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

// The one-mode curve that gives the paper's example: τ 53.475 min, levels 35.2245 and 49.0785 µm.
inline online::ThermalModel paper() {
  ThermalAxis axis;
  ThermalMode mode;
  mode.tau_s = 53.475 * 60.0;
  mode.speed_rev_s = {0.0, 10.0, 20.0, 30.0};
  mode.level_mm = {0.0, 0.0352245, 0.0490785, 0.0420};
  axis.mode = {mode};
  return *online::ThermalModel::make(axis);
}

inline Cyclogram stages(const std::vector<std::pair<double, double>>& minutes_and_speed) {
  Cyclogram out;
  for (const auto& [minutes, speed] : minutes_and_speed) {
    Transition t;
    t.minutes = minutes;
    t.seconds = 60.0 * minutes;
    t.speed_rev_s = speed;
    out.transition.push_back(t);
  }
  return out;
}

inline AxisCorrections planned(const online::ThermalModel& model, const Cyclogram& cyclogram,
                               const PlanRequest& request) {
  const auto plan = plan_corrections("Z", curve_of(model, cyclogram), cyclogram, request);
  EXPECT_TRUE(plan) << kernel::outcome::text(plan.error());
  return plan.value_or(AxisCorrections{});
}

inline std::vector<double> whole_minutes(const std::vector<double>& seconds) {
  std::vector<double> out;
  out.reserve(seconds.size());
  for (const double s : seconds) {
    out.push_back(std::round(s / 60.0));
  }
  return out;
}

}  // namespace steadyrest::thermal::offline::test
