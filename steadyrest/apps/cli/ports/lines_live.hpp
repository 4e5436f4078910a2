// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>

#include <steadyrest/apps/cli/ports/live_port.hpp>

namespace steadyrest::apps::cli::live {

/// A control behind its override lines. With a recorder and a program, the place on the program's
/// path is found from the encoders. Refused: what the lines lack, a module that does not answer, a
/// panel whose word is not in the table.
[[nodiscard]] std::expected<LivePort, Refusals> open_lines(const kernel::machine::Machine& machine,
                                                           const ProgramOptions& program);

/// What a first reading shows, for `doctor`: the link, and whether the panel's words are known.
[[nodiscard]] std::vector<passport::Finding> lines_findings(
    const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::cli::live
