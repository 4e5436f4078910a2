// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::trial::timing {

/// A path with many decisions for the layer, planned with the machine's own limits.
///
/// In the plane of the machine's first two axes, around the middle of their travel and within it,
/// at the highest feed that machine and axes permit and at a quarter of it: rounded rectangles (r =
/// 2, 4, 8, 12 mm), a zigzag of 1.5 mm with sharp corners, a circle in chords of 0.1 mm. Where the
/// travel is less than 60 mm everything shrinks.
///
/// `least_s`: it takes at least this long at 100 %. Refuses a machine with fewer than two axes.
[[nodiscard]] kernel::outcome::Result<std::shared_ptr<const nc::plan::PlannedPath>> demanding_path(
    const kernel::machine::Machine& machine, double least_s);

}  // namespace steadyrest::trial::timing
