// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/format.h>
#include <tests/rig/everything_on.hpp>

#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::rig {
namespace {

using kernel::machine::Machine;

constexpr double kSensor_hz = 10'000.0;
constexpr double kDepth_mm = 1.0;

kernel::machine::ThermalAxis growing(const char* axis) {
  kernel::machine::ThermalAxis out;
  out.name = axis;
  for (const double tau_s : {5.0, 60.0, 600.0}) {
    auto& mode = out.mode.emplace_back();
    mode.tau_s = tau_s;
    mode.speed_rev_s = {0.0, 50.0};
    mode.level_mm = {0.0, 0.01};
  }
  out.ambient.push_back({.sensor = "room", .tau_s = 100.0, .gain_mm_k = 0.002});
  return out;
}

std::string pocket(int number) {
  const int r = 2 + number % 5;
  std::string text = fmt::format(
      "G0 X0 Y-20\nG1 X{0} Y-20 F{2}\nG3 X30 Y{1} I0 J{3}\nG1 X30 Y10\nG3 X20 Y20 I-10 J0\nG1 X-30 "
      "Y20\nG1 X-30 Y-20\nG1 X0 Y-20\n",
      30 - r, -20 + r, 1500 + 500 * (number % 6), r);
  for (int i = 1; i <= 12; ++i) {
    text += fmt::format("G1 X{:g} Y{}\n", 1.5 * i, -20 + 2 * (i % 2));
  }
  return text;
}

}  // namespace

Machine everything_on(const std::string& machine) {
  Machine out =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/" + machine + ".toml").value();
  out.contour.enabled = true;
  out.chatter.enabled = true;
  out.chatter.m_code_on = 0;
  out.chatter.m_code_off = 0;
  out.thermal.enabled = true;
  out.thermal.slope_mm_s = 0.01;
  out.thermal.axis = {growing("X"), growing("Z")};
  out.envelope.offset_slew_mm_s = 0.05;
  return out;
}

std::shared_ptr<const nc::plan::PlannedPath> busy_path(const Machine& machine, int pockets) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  std::string text = "G17 G90 G94\nS3000 M3\n";
  for (int i = 0; i < pockets; ++i) {
    text += pocket(i);
  }
  text += "M2\n";
  return std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_text(text, config, machine, "busy.nc").value());
}

std::unique_ptr<sim::SimulatedMachine> chattering(
    const Machine& machine, std::shared_ptr<const nc::plan::PlannedPath> path) {
  sim::CuttingVibration::Config cutting;
  cutting.cut.modes = {{.frequency_hz = 922.0, .damping_ratio = 0.011, .mass_kg = 0.04}};
  cutting.cut.depth_mm = kDepth_mm;
  cutting.slowest_rev_s = 20.0;
  cutting.steps_per_period = 8.0;
  cutting.sensor_rate_hz = kSensor_hz;
  return sim::SimulatedMachine::make(
             {.machine = machine, .path = std::move(path), .cutting = std::move(cutting)})
      .value();
}

supervisor::Supervisor listening(const Machine& machine,
                                 const kernel::port::Capability& capability) {
  auto layer = supervisor::Supervisor::make(machine, capability).value();
  chatter::online::BetterSpeed::Config config;
  config.detector.sample_rate_hz = kSensor_hz;
  config.table.step_ratio = machine.spindle_override.ratio;
  config.table.max_ratio = 1.0;
  config.table.speed_rev_s = {20.0, 35.0, 40.0, 45.0, 100.0};
  config.table.limit_depth_mm = {0.1, 0.1, 2.0, 0.1, 0.1};
  auto stage =
      supervisor::ListeningStage::make({.better = std::move(config), .depth_mm = kDepth_mm});
  static_cast<void>(layer.listen(stage.value()));
  return layer;
}

}  // namespace steadyrest::rig
