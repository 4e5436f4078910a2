// SPDX-License-Identifier: Apache-2.0
// first_cut MACHINE.toml PROGRAM.mpf: cuts a SINUMERIK program with the layer acting; prints for
// each reason the mean feed override that was commanded and for how many cycles.
#include <cstdio>
#include <expected>
#include <map>
#include <memory>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace kernel = steadyrest::kernel;
namespace nc = steadyrest::nc;
namespace passport = steadyrest::passport;
namespace sim = steadyrest::sim;
namespace supervisor = steadyrest::supervisor;

namespace {

struct Row {
  double percent = 0.0;
  int cycles = 0;
};

/// The program as the control plans it. `value()` throws the refusal, which main() prints.
std::shared_ptr<const nc::plan::PlannedPath> plan(const char* program,
                                                  const kernel::machine::Machine& machine) {
  nc::plan::PathBuilder builder(machine);
  nc::interpret::Config control;
  control.dialect = nc::read::Dialect::sinumerik;
  const auto report = nc::interpret::run_file(program, control, builder).value();
  if (!report.refused.empty()) {
    throw std::bad_expected_access(nc::interpret::first_refusal(report, program));
  }
  return std::make_shared<const nc::plan::PlannedPath>(builder.take().value());
}

/// A path is cut when the command is this close to its end.
constexpr double kClose_mm = 1e-6;

double end_mm(const nc::plan::PlannedPath& path) {
  const auto& segments = path.segments;
  return segments.empty() ? 0.0 : segments.back().position_mm + segments.back().length_mm;
}

void cut(const char* machine_file, const char* program) {
  const auto machine = passport::read(machine_file).value();
  const auto path = plan(program, machine);
  // a real machine's port would be made here instead
  std::unique_ptr<kernel::port::Port> port = sim::SimulatedMachine::make({machine, path}).value();
  auto layer = supervisor::Supervisor::make(machine, port->capability()).value();
  layer.set_mode(kernel::machine::Mode::act);
  std::map<kernel::outcome::Reason, Row> rows;
  for (double at_mm = 0.0; at_mm < end_mm(*path) - kClose_mm;) {
    const auto frame = port->read().value();
    const auto command = layer.update(frame);
    if (command.write) {
      port->write(command).value();
    }
    Row& row = rows[command.feed_reason];
    row.percent += (100.0 * command.feed_ratio - row.percent) / ++row.cycles;
    at_mm = frame.path_position_mm;
  }
  for (const auto& [reason, row] : rows) {
    fmt::print("{:3.0f} %{:7} cycles  {}\n", row.percent, row.cycles, sentence(reason));
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    fmt::print(stderr, "usage: first_cut MACHINE.toml PROGRAM.mpf\n");
    return 2;
  }
  cut(argv[1], argv[2]);
} catch (const std::bad_expected_access<kernel::outcome::Refusal>& refused) {
  fmt::print(stderr, "{}\n", text(refused.error()));
  return 2;
}
