// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <steadyrest/live/pace.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::live::test {

/// Time that passes as the test says: a cycle's work takes `work_s`.
class FakePace final : public Pace {
 public:
  Wake wait() noexcept override {
    ++waits;
    return wake;
  }
  [[nodiscard]] double now_s() const noexcept override {
    now += work_s;
    return now;
  }
  Wake wake;
  double work_s = 1e-5;
  int waits = 0;
  mutable double now = 0.0;
};

/// The 840D cutting a circle of R 10 mm at F4000, and a layer for it.
struct Desk {
  Desk()
      : machine(passport::read(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d.toml").value()) {
    machine.contour.enabled = true;
    nc::interpret::Config config;
    config.dialect = machine.control.dialect;
    config.axes = "XYZ";
    const auto path = std::make_shared<const nc::plan::PlannedPath>(
        nc::plan::plan_text("G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 F4000\nG4 F2\nM30\n",
                            config, machine, "circle.mpf")
            .value());
    port = sim::SimulatedMachine::make({.machine = machine, .path = path}).value();
    layer.emplace(supervisor::Supervisor::make(machine, port->capability()).value());
  }
  kernel::machine::Machine machine;
  std::unique_ptr<sim::SimulatedMachine> port;
  std::optional<supervisor::Supervisor> layer;
  FakePace pace;
};

}  // namespace steadyrest::live::test
