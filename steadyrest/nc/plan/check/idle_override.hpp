// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::nc::plan {

/// The warning where the feed override's next step below 100 % changes nothing for most of the cut,
/// since the programmed feed F is far above what the axes do.
///
/// No segment of length ℓ is passed faster than u, u² = min(v_limit², ½·(v_in² + v_out²) + a·ℓ),
/// with the speeds that its junctions permit. Where u ≤ r·F the step r has no effect, whatever the
/// neighbours are. It is weighed by the time ℓ/u, feed moves that the override may change alone.
[[nodiscard]] std::optional<Warning> idle_override(const PlannedPath& path,
                                                   const kernel::machine::OverrideTable& table);

}  // namespace steadyrest::nc::plan
