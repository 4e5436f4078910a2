// SPDX-License-Identifier: Apache-2.0
// The forecast from a program's cyclogram against the simulated machine, which runs that program
// period by period with a thermal model of its own.
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/thermal/offline/plan/curve.hpp>

namespace steadyrest::trial::batch {
namespace {

using kernel::machine::Machine;

/// A head that coolant cools to one half and cutting warms by half as much again, and a screw that
/// the feed warms.
Machine mill() {
  Machine machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/thermal-batch/machine.toml").value();
  auto& z = machine.thermal.axis.at(0);
  z.ambient.clear();
  z.mode[0].tau_s = 20.0;
  z.mode[0].cutting_ratio = 1.5;
  z.mode[1].tau_s = 60.0;
  z.mode[1].coolant_ratio = 0.5;
  z.mode[1].feed_s = 0.0002;
  machine.simulation.thermal_tau_error_ratio.clear();
  machine.simulation.thermal_gain_error_ratio.clear();
  machine.simulation.room_swing_k = 0.0;
  return machine;
}

double forecast_um(const Machine& machine, const std::string& program) {
  auto timer = nc::plan::SegmentTimer::make(machine).value();
  EXPECT_TRUE(nc::interpret::run_text(program, {}, timer).value().refused.empty());
  const auto cyclogram =
      thermal::offline::cyclogram_of(timer.take_cyclogram().value().cyclogram, "program");
  const auto model = thermal::online::ThermalModel::make(machine.thermal.axis[0]).value();
  return 1e3 * thermal::offline::curve_of(model, cyclogram).at(cyclogram.total_s());
}

double truth_um(const Machine& machine, const std::string& program) {
  nc::plan::PathBuilder builder(machine);
  EXPECT_TRUE(nc::interpret::run_text(program, {}, builder).value().refused.empty());
  auto simulated =
      sim::SimulatedMachine::make(
          {.machine = machine,
           .path = std::make_shared<const nc::plan::PlannedPath>(builder.take().value())})
          .value();
  while (!simulated->finished()) {
    EXPECT_TRUE(simulated->read());
  }
  return 1e3 * simulated->truth().heat_mm[2];
}

std::string passes(const std::string& head, int count) {
  std::string text = head;
  for (int i = 0; i < count; ++i) {
    text += "G1 X150 F3000\nG0 Z5\nG4 P1.5\nG0 X0\nG1 Z0 F1000\n";
  }
  return text;
}

// The forecast knows the program's text, the machine runs it: with a correct passport both must
// grow alike.
TEST(ForecastOfAProgram, IsWhatTheSimulatedMachineDoes) {
  const Machine machine = mill();
  const std::string start = "G21 G90 G61\nS4000 M3\n";
  const std::string dry = passes(start, 12) + "M2\n";
  const std::string wet = passes(start + "M8\n", 12) + "M2\n";
  const std::string both = passes(passes(start, 6) + "M7\n", 6) + "M9\nM5\nT1 M6\nM2\n";
  for (const std::string& program : {dry, wet, both}) {
    const double truth = truth_um(machine, program);
    EXPECT_GT(truth, 10.0);
    EXPECT_NEAR(forecast_um(machine, program), truth, 0.01 * truth);
  }
  EXPECT_LT(truth_um(machine, wet), 0.8 * truth_um(machine, dry)) << "coolant is no small matter";
}

}  // namespace
}  // namespace steadyrest::trial::batch
