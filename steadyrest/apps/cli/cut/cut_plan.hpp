// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <memory>
#include <vector>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::apps::cli::cut {

using PathPointer = std::shared_ptr<const nc::plan::PlannedPath>;

/// The program as the machine's control plans it, with warnings about what the machine cannot do.
struct Planned {
  PathPointer path;
  std::vector<nc::plan::Warning> warnings;
  std::size_t warning_count = 0;
  nc::interpret::Report report;  ///< of the reading
};

/// Refused with a whole answer, since every refused word is listed in it.
[[nodiscard]] std::expected<Planned, Answer> plan(const ProgramOptions& options,
                                                  const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::cli::cut
