// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::apps::cli {

/// Places of the displacements in the log, and the names of their axes.
using FitChannels = std::vector<std::pair<std::size_t, std::string>>;

/// Those that `wanted` names as NAME or NAME=AXIS; all in the log if it names none. Refused: a
/// column that the log lacks, an axis name that no passport accepts, and duplicate names.
[[nodiscard]] kernel::outcome::Result<FitChannels> fit_channels(
    const std::vector<std::string>& wanted, const thermal::offline::Log& log);

}  // namespace steadyrest::apps::cli
