// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::cli {

struct RecordedServos {
  std::vector<contour::offline::ServoLog> logs;  ///< in the order of `places`
  std::string date;                              ///< of the run, UTC; empty: a CSV does not say
};

/// The commanded and actual positions of these axes of the machine, by their place in it, from a
/// record (SQLite) or from a table with the columns time_s, axis.command_mm.N and axis.actual_mm.N.
/// Refused: no record, no samples, columns that are missing, other axes than the machine's.
[[nodiscard]] kernel::outcome::Result<RecordedServos> read_servos(
    const std::string& file, const kernel::machine::Machine& machine,
    const std::vector<std::size_t>& places, Progress& progress);

}  // namespace steadyrest::apps::cli
