// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/thermal/online/state_filter.hpp>

/// An axis of two thermal modes and its filter.
namespace steadyrest::thermal::online::test {

using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

inline ThermalMode mode(double tau_s, double level_mm) {
  ThermalMode mode;
  mode.tau_s = tau_s;
  mode.speed_rev_s = {0.0, 100.0};
  mode.level_mm = {0.0, level_mm};
  return mode;
}

inline ThermalAxis two_modes() {
  ThermalAxis axis;
  axis.mode = {mode(900.0, 0.015), mode(5400.0, 0.035)};
  axis.mode[0].rest_tau_s = 1300.0;
  axis.noise_mm = 0.0005;
  axis.drift_mm = 0.003;
  axis.drift_tau_s = 7200.0;
  return axis;
}

inline StateFilter made(const StateFilter::Config& config) {
  auto filter = StateFilter::make(config);
  EXPECT_TRUE(filter);
  return std::move(*filter);
}

}  // namespace steadyrest::thermal::online::test
