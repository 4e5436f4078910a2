// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::nc::plan {

/// Warns when the feed override's next step below 100 % changes nothing for most of the cut,
/// because the programmed feed F is far above what the axes reach.
///
/// A segment of length ℓ runs at most at u, u² = min(v_limit², ½·(v_in² + v_out²) + a·ℓ), with the
/// speeds that its junctions permit. Where u ≤ r·F the step r has no effect, whatever the
/// neighbours. Segments are weighted by their time ℓ/u; only feed moves that the override may
/// change count.
[[nodiscard]] std::optional<Warning> idle_override(const PlannedPath& path,
                                                   const kernel::machine::OverrideTable& table);

}  // namespace steadyrest::nc::plan
