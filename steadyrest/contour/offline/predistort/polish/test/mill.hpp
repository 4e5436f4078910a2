// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/contour/offline/predistort/polish/chain_motion.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

inline constexpr double kMillGain_1_s = 20.0;

/// Three axes of 20 1/s and 2000 mm/s², 3000 along the path, trapezoids, 1 ms;
/// the control stops where LinuxCNC does.
inline kernel::machine::Machine slow_mill() {
  kernel::machine::Machine machine;
  machine.control.interpolator_period_s = 0.001;
  machine.control.max_path_acceleration_mm_s2 = 3000.0;
  machine.control.junction_deviation_mm = 0.0;
  machine.control.junction_share = 0.1;
  machine.control.block_time_s = 0.001;
  machine.axes.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    auto& axis = machine.axes[i];
    axis.name = std::string(1, "XYZ"[i]);
    axis.servo_gain_1_s = kMillGain_1_s;
    axis.max_acceleration_au_s2 = 2000.0;
    axis.max_speed_au_s = 200.0;
    axis.min_au = -500.0;
    axis.max_au = 500.0;
  }
  return machine;
}

/// ẋ = k·(c − x) for a command that is constant in each period: written for tests, on its own.
inline std::vector<kernel::signal::Point> first_order(
    const std::vector<kernel::signal::Point>& command, double gain_1_s, double period_s) {
  const double stays = std::exp(-gain_1_s * period_s);
  std::vector<kernel::signal::Point> out;
  kernel::signal::Point x = command.front();
  for (const auto& c : command) {
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = c[i] + (x[i] - c[i]) * stays;
    }
    out.push_back(x);
  }
  return out;
}

}  // namespace steadyrest::contour::offline
