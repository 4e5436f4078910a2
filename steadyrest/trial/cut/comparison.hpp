// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/trial/cut/recorder.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

namespace steadyrest::trial::cut {

/// The two records side by side, as the report shows them. The texts of the worst lines come from
/// the program's file; if it cannot be read they stay empty.
[[nodiscard]] ReportData compare(const std::filesystem::path& program,
                                 const kernel::machine::Machine& machine, const Recorder& without,
                                 const Recorder& with);

/// One record as the report shows it.
[[nodiscard]] Run run_of(const Recorder& record);

}  // namespace steadyrest::trial::cut
