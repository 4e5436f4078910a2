// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

/// The layer with every room at work, for tests and benches of the running loop.
namespace steadyrest::rig {

/// A machine of examples/machines (`vmc-840d`, `linuxcnc-mill`) with contour, chatter (always
/// modulating), thermal and encoders on; the spindle's growth shows within seconds.
[[nodiscard]] kernel::machine::Machine everything_on(const std::string& machine);

/// Pockets with arcs of several radii, sharp corners and chords at S3000, as often as asked; ends
/// with the spindle still turning.
[[nodiscard]] std::shared_ptr<const nc::plan::PlannedPath> busy_path(
    const kernel::machine::Machine& machine, int pockets);

/// The simulated machine on it, with a tool that chatters and a vibration sensor of 10 kHz.
[[nodiscard]] std::unique_ptr<sim::SimulatedMachine> chattering(
    const kernel::machine::Machine& machine, std::shared_ptr<const nc::plan::PlannedPath> path);

/// A layer that listens to the vibration.
[[nodiscard]] supervisor::Supervisor listening(const kernel::machine::Machine& machine,
                                               const kernel::port::Capability& capability);

}  // namespace steadyrest::rig
