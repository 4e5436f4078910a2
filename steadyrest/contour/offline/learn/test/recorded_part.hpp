// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/contour/offline/learn/part_record.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>

namespace steadyrest::contour::offline::test {

/// The record of a path that was cut on axes of this gain, whatever the machine file says:
/// ẋ = k·(c − x), integrated in steps far below 1/k between the control's commands.
inline PartRecord recorded_part(const kernel::machine::Machine& machine,
                                const nc::plan::PlannedPath& path, double gain_1_s) {
  constexpr int kSteps = 50;
  auto control = nc::plan::Interpolator::make(machine, nc::plan::whole(path)).value();
  PartRecord record;
  record.file = "part.csv";
  record.period_s = machine.control.interpolator_period_s;
  const double step_s = record.period_s / kSteps;
  kernel::signal::Point command{};
  kernel::signal::Point actual{};
  for (auto at = control.update({}); !at.finished; at = control.update({})) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double moves_mm = (at.position[axis] - command[axis]) / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        command[axis] += 0.5 * moves_mm;
        actual[axis] += step_s * gain_1_s * (command[axis] - actual[axis]);
        command[axis] += 0.5 * moves_mm;
      }
    }
    record.time_s.push_back(record.period_s * static_cast<double>(record.time_s.size() + 1));
    record.command_mm.push_back(command);
    record.actual_mm.push_back(actual);
  }
  return record;
}

}  // namespace steadyrest::contour::offline::test
