// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tests/lines/line_chain.hpp>
#include <tests/ports/fake_port.hpp>
#include <tests/ports/hal_mill.hpp>
#include <tests/ports/lines_mill.hpp>
#include <tests/ports/subject.hpp>

#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/recording_port.hpp>
#include <steadyrest/record/replay_port.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::ports {
namespace {

using kernel::file::testing::OwnFolder;
using kernel::machine::Machine;

Machine machine_of(const std::string& name) {
  return passport::read(STEADYREST_SOURCE_DIR "/examples/machines/" + name + ".toml").value();
}

std::uint32_t code_of(const kernel::machine::OverrideTable& config, double ratio) {
  const auto table = kernel::override::Table::make(config).value();
  return table.code(table.nearest_step(ratio).value());
}

std::unique_ptr<kernel::port::Port> simulation_of(const Machine& machine,
                                                  const std::vector<Turn>& turns) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  const auto path = std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_text("G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=9 F2000\nM30\n",
                          config, machine, "circles.mpf")
          .value());
  std::vector<sim::OperatorAction> actions;
  for (const Turn& turn : turns) {
    actions.push_back({.time_s = turn.time_s,
                       .act = sim::OperatorAct::turn_feed,
                       .code = code_of(machine.feed_override, turn.ratio)});
  }
  return sim::SimulatedMachine::make(
             {.machine = machine, .path = path, .operator_actions = std::move(actions)})
      .value();
}

/// Of a machine as the PLC and the interpolator have it, and a cycle.
double in_force_of(const Machine& machine) {
  return machine.feed_override.dead_time_s + machine.feed_override.scan_period_s +
         2.0 * machine.control.interpolator_period_s;
}

Subject linuxcnc(const std::vector<Turn>& turns, bool offsets) {
  Subject subject;
  subject.machine = machine_of("linuxcnc-mill");
  const auto hal = std::make_shared<HalMill>(turns, offsets);
  subject.port = adapters::linuxcnc::LinuxCncPort::make(
                     {.units = {.axes = 3, .servo_period_s = HalMill::kPeriod_s}}, *hal)
                     .value();
  subject.in_force_s = 0.1;  // the factor rises by 15 1/s
  subject.cut_link = [hal] { hal->lost = true; };
  subject.mend_link = [hal] { hal->lost = false; };
  subject.beside = hal;
  return subject;
}

}  // namespace

Subject simulated(const std::vector<Turn>& turns) {
  Subject subject;
  subject.machine = machine_of("vmc-840d");
  subject.machine.envelope.max_path_offset_mm = 0.1;
  subject.port = simulation_of(subject.machine, turns);
  subject.in_force_s = in_force_of(subject.machine);
  return subject;
}

Subject simulated_without_offsets(const std::vector<Turn>& turns) {
  Subject subject;
  subject.machine = machine_of("vmc-840d");
  subject.machine.envelope.max_offset_mm = 0.0;
  subject.machine.spindle_override = {};
  subject.port = simulation_of(subject.machine, turns);
  subject.in_force_s = in_force_of(subject.machine);
  return subject;
}

Subject replayed(const std::vector<Turn>& turns) {
  Subject subject = simulated(turns);
  const auto folder = std::make_shared<OwnFolder>();
  const std::string file = folder->at("run.sqlite");
  {
    const auto writer = record::RecordWriter::make(
                            {.file = file,
                             .info = {.cycle_s = subject.machine.control.interpolator_period_s,
                                      .capability = subject.port->capability()}})
                            .value();
    record::RecordingPort port(*subject.port, *writer);
    for (int i = 0; i < 800 && port.read(); ++i) {
      port.record({});
    }
  }
  auto replay = record::ReplayPort::open(file).value();
  auto* const shown = replay.get();
  subject.port = std::move(replay);
  subject.beside = folder;
  subject.obeys = false;
  subject.in_cycle = false;
  subject.cut_link = [shown] {
    while (shown->read()) {  // its end is all that it can lose
    }
  };
  return subject;
}

Subject on_linuxcnc(const std::vector<Turn>& turns) {
  return linuxcnc(turns, false);
}

Subject on_linuxcnc_with_offsets(const std::vector<Turn>& turns) {
  return linuxcnc(turns, true);
}

Subject on_lines(const std::vector<Turn>& turns) {
  return LinesMill::subject(test::lines::wired_840d(0.0), turns);
}

Subject fake(const std::vector<Turn>& turns) {
  Subject subject;
  subject.machine = machine_of("vmc-840d");
  auto port = std::make_unique<FakePort>(subject.machine, turns);
  auto* const made = port.get();
  subject.port = std::move(port);
  subject.in_force_s = 2.0 * FakePort::kPeriod_s;
  subject.cut_link = [made] { made->lost = true; };
  subject.mend_link = [made] { made->lost = false; };
  return subject;
}

}  // namespace steadyrest::ports
