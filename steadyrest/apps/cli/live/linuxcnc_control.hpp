// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <memory>
#include <optional>
#include <vector>

#include <steadyrest/adapters/linuxcnc/control_peer.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/program_watch.hpp>
#include <steadyrest/passport/file/consistency.hpp>

namespace steadyrest::apps::cli::live {

/// LinuxCNC's state, read by a process that is started again when it has ended. Copies share it.
class ControlSource {
 public:
  explicit ControlSource(kernel::machine::Machine machine) : machine_(std::move(machine)) {}

  /// The first state. Refused: none within the time.
  Result<adapters::linuxcnc::ControlState> first(double timeout_s);
  /// The newest; nothing where none came within the time.
  Result<std::optional<steadyrest::live::LoadedProgram>> operator()(double wait_s);

 private:
  Result<void> start();

  kernel::machine::Machine machine_;
  std::shared_ptr<adapters::linuxcnc::ControlPeer> peer_;
  /// While no program ran; what a program sets itself does not count.
  std::optional<steadyrest::live::LoadedProgram> at_rest_;
};

/// Compares the machine file with the control. Refused: another version of LinuxCNC, a machine file
/// of another machine, limits beyond the control's. A control whose status or configuration cannot
/// be read is a finding, no reason not to start.
[[nodiscard]] std::expected<std::vector<passport::Finding>, Refusals> compare_with_control(
    ControlSource& source, const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::cli::live
