// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// The path that a changed one is made for: each block has its own segments, none is merged with
/// its neighbours, and a small rounding of corners counts as none. Refused: what the interpreter or
/// the planner refuses.
[[nodiscard]] kernel::outcome::Result<nc::plan::PlannedPath> shaped_path(
    const std::string& file, const nc::interpret::Config& config, kernel::machine::Machine machine);

}  // namespace steadyrest::contour::offline
