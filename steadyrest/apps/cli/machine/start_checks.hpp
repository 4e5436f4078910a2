// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/apps/cli/shared/findings.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/realtime.hpp>
#include <steadyrest/passport/file/consistency.hpp>

/// What `doctor` finds without running the layer; `run` looks for the same before it starts.
namespace steadyrest::apps::cli {

/// Of the machine file and this computer's clock.
[[nodiscard]] std::vector<passport::Finding> start_findings(
    const kernel::machine::Machine& machine);
/// Warnings; on the simulated machine, which nothing can hurt, notes.
[[nodiscard]] std::vector<passport::Finding> real_time_findings(
    const kernel::machine::Machine& machine, const steadyrest::live::RealTime& granted);

}  // namespace steadyrest::apps::cli
