// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <expected>
#include <memory>
#include <optional>
#include <vector>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/control_peer.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/path/program_watch.hpp>
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
  std::unexpected<Refusal> ended(Refusal why);

  kernel::machine::Machine machine_;
  std::shared_ptr<adapters::linuxcnc::ControlPeer> peer_;
  /// While no program ran; what a program sets itself does not count.
  std::optional<steadyrest::live::LoadedProgram> at_rest_;
  /// Of the process that ended last, and when the next may begin.
  std::optional<Refusal> ended_;
  std::chrono::steady_clock::time_point begins_again_;
};

/// The configuration that the control runs, as it was read at the start.
struct ControlFile {
  adapters::linuxcnc::config::IniFile ini;
  adapters::linuxcnc::config::Configuration configuration;
};

struct Compared {
  std::vector<passport::Finding> findings;
  bool shown = true;                ///< the control showed its status
  std::optional<ControlFile> file;  ///< none: it could not be read
};

/// Compares the machine file with the control. Refused: another version of LinuxCNC, a
/// configuration that the layer cannot work on, a machine file of another machine, limits beyond
/// the control's. A control whose status or INI file cannot be read is a finding, no reason not to
/// start.
[[nodiscard]] std::expected<Compared, Refusals> compare_with_control(
    ControlSource& source, const kernel::machine::Machine& machine);

/// Whether a layer that began with `running` may go on with `wanted`. `control`: null, not known.
[[nodiscard]] Result<void> accepts(const kernel::machine::Machine& running,
                                   const std::optional<ControlFile>& control,
                                   const kernel::machine::Machine& wanted);

}  // namespace steadyrest::apps::cli::live
