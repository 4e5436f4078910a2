// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>

#include <steadyrest/adapters/linuxcnc/control_state.hpp>
#include <steadyrest/apps/cli/ports/live_port.hpp>
#include <steadyrest/live/path/program_watch.hpp>

namespace steadyrest::apps::cli::live {

/// A running LinuxCNC with the path of the program that it has loaded. Refused: what its HAL lacks.
[[nodiscard]] std::expected<LivePort, Refusals> open_linuxcnc(
    const kernel::machine::Machine& machine, const ProgramOptions& program);

/// How the interpreter starts on a control in this state. Refused: a variable file that is damaged.
[[nodiscard]] Result<steadyrest::live::LoadedProgram> loaded_program(
    const adapters::linuxcnc::ControlState& state, const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::cli::live
