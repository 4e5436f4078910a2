// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The part of `steadyrest cut` that is about a batch of parts and the heat of the machine.
namespace steadyrest::apps::cli {

struct CutBatchOptions {
  unsigned parts = 0;  ///< 0 = no batch
  double pause_min = 2.0;
  double break_min = 0.0;
  unsigned break_after = 0;
  double tolerance_um = 10.0;
};

/// Where the batch's own report goes inside that of the cut.
[[nodiscard]] std::string batch_folder(const std::string& report);

void add_cut_batch_options(Verb& verb, CutBatchOptions& options);

/// Makes the batch and adds `batch` to the other keys: `parts[]`, and for each way (`without`,
/// `text`, `online`) its `largest_um`, `rms_um`, `improvement` and `worse_parts`. With a directory
/// for reports its page goes into the folder `batch` there.
[[nodiscard]] kernel::outcome::Result<void> put_batch(
    Answer& answer, const CutBatchOptions& options, const ProgramOptions& program,
    const kernel::machine::Machine& machine, const std::string& directory, Progress& progress);

}  // namespace steadyrest::apps::cli
