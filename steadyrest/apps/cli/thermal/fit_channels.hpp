// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::apps::cli {

/// Places of the displacements in the log, and the axes that they are called.
using FitChannels = std::vector<std::pair<std::size_t, std::string>>;

/// Those that `wanted` names as NAME or NAME=AXIS; all of the log where it names none. Refused are
/// a column that the log has not, an axis with a name that no passport takes, and two of one name.
[[nodiscard]] kernel::outcome::Result<FitChannels> fit_channels(
    const std::vector<std::string>& wanted, const thermal::offline::Log& log);

}  // namespace steadyrest::apps::cli
