// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

/// LinuxCNC's own encoder component on a record: a separate program, run on files.
namespace steadyrest::motion::offline {

/// Estimates at the record's ticks (which must be evenly spaced), without acceleration (NaN) and
/// bounds. The component's base thread runs with the period of the record's clock.
///
/// Refused where the program is missing, LinuxCNC's component is not installed, or it fails.
[[nodiscard]] kernel::outcome::Result<std::vector<online::Estimate>> run_encoder_peer(
    const std::filesystem::path& program, const Record& record);

}  // namespace steadyrest::motion::offline
