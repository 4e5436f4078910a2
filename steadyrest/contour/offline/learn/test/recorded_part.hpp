// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>

#include <steadyrest/contour/offline/learn/part_record.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>

namespace steadyrest::contour::offline::test {

/// What cuts a part, whatever the machine file says.
struct CuttingAxes {
  double gain_1_s = 50.0;
  double lag_s = 0.0;     ///< of the velocity loop
  double noise_mm = 0.0;  ///< of each encoder, RMS
};

/// The record of a path that was cut on such axes: τ·v̇ + v = k·(c − x), ẋ = v, integrated in steps
/// far below 1/k between the control's commands.
inline PartRecord recorded_part(const kernel::machine::Machine& machine,
                                const nc::plan::PlannedPath& path, const CuttingAxes& axes) {
  constexpr int kSteps = 50;
  auto control = nc::plan::Interpolator::make(machine, nc::plan::whole(path)).value();
  PartRecord record;
  record.file = "part.csv";
  record.period_s = machine.control.interpolator_period_s;
  const double step_s = record.period_s / kSteps;
  const double follows = axes.lag_s > 0.0 ? step_s / axes.lag_s : 1.0;
  kernel::signal::Point command{};
  kernel::signal::Point actual{};
  kernel::signal::Point speed_mm_s{};
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (auto at = control.update({}); !at.finished; at = control.update({})) {
    kernel::signal::Point seen = actual;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double moves_mm = (at.position[axis] - command[axis]) / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        command[axis] += 0.5 * moves_mm;
        const double asked_mm_s = axes.gain_1_s * (command[axis] - actual[axis]);
        speed_mm_s[axis] += follows * (asked_mm_s - speed_mm_s[axis]);
        actual[axis] += step_s * speed_mm_s[axis];
        command[axis] += 0.5 * moves_mm;
      }
      seen[axis] = actual[axis] + axes.noise_mm * noise(random);
    }
    record.time_s.push_back(record.period_s * static_cast<double>(record.time_s.size() + 1));
    record.command_mm.push_back(command);
    record.actual_mm.push_back(seen);
  }
  return record;
}
inline PartRecord recorded_part(const kernel::machine::Machine& machine,
                                const nc::plan::PlannedPath& path, double gain_1_s) {
  return recorded_part(machine, path, CuttingAxes{.gain_1_s = gain_1_s});
}

}  // namespace steadyrest::contour::offline::test
