// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>

/// A machine without faults but its lag, and programs planned for it.
namespace steadyrest::contour::offline::test {

/// Three equal axes of this gain and a control period of 2 ms.
inline kernel::machine::Machine ideal_mill(double gain_1_s = 50.0) {
  kernel::machine::Machine machine;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    axis.servo_gain_1_s = gain_1_s;
    machine.axes.push_back(axis);
  }
  machine.control.interpolator_period_s = 0.002;
  return machine;
}

/// In mm and mm/min, absolute, in the XY plane, on the exact path; the moves end with a line end.
inline std::string exact_program(const std::string& moves) {
  return "G21 G90 G94 G17 G61\n" + moves + "M2\n";
}

inline nc::plan::PlannedPath planned_text(const kernel::machine::Machine& machine,
                                          const std::string& program) {
  nc::plan::PathBuilder builder(machine);
  const auto report = nc::interpret::run_text(program, {}, builder);
  EXPECT_TRUE(report.has_value() && report->refused.empty());
  return builder.take().value();
}
inline nc::plan::PlannedPath planned_moves(const kernel::machine::Machine& machine,
                                           const std::string& moves) {
  return planned_text(machine, exact_program(moves));
}

}  // namespace steadyrest::contour::offline::test
