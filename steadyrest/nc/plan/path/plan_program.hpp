// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::nc::plan {

/// Plans the moves that `run` sends to its sink. Refused, by file and line: what the interpreter or
/// the planner refuses.
[[nodiscard]] kernel::outcome::Result<PlannedPath> plan_moves(
    const kernel::machine::Machine& machine, const std::string& file,
    const std::function<kernel::outcome::Result<interpret::Report>(interpret::Sink&)>& run);

/// A whole program as the control plans it.
[[nodiscard]] kernel::outcome::Result<PlannedPath> plan_file(
    const std::string& file, const interpret::Config& config,
    const kernel::machine::Machine& machine);

/// The same, with the segments marked (SegmentPlan::from_start) that depend on `config.start`: a
/// run from another start places them elsewhere. In a relative program that is every segment.
[[nodiscard]] kernel::outcome::Result<PlannedPath> plan_file_from_start(
    const std::string& file, const interpret::Config& config,
    const kernel::machine::Machine& machine);

/// The path as the program writes it: each block has its own segments, none is merged with its
/// neighbours, and a small rounding of corners (kSmallRounding_mm) counts as none. A part is judged
/// by it, and corrections are made for it.
[[nodiscard]] kernel::outcome::Result<PlannedPath> plan_programmed(
    kernel::machine::Machine machine, const std::string& file,
    const std::function<kernel::outcome::Result<interpret::Report>(interpret::Sink&)>& run);

[[nodiscard]] kernel::outcome::Result<PlannedPath> plan_programmed_file(
    const std::string& file, const interpret::Config& config,
    const kernel::machine::Machine& machine);

/// The same for a text in memory; `file` is its name in a refusal.
[[nodiscard]] kernel::outcome::Result<PlannedPath> plan_text(
    std::string_view text, const interpret::Config& config, const kernel::machine::Machine& machine,
    const std::string& file);

}  // namespace steadyrest::nc::plan
