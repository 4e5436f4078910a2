// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/chatter/offline/depth_line.hpp>
#include <steadyrest/chatter/offline/process.hpp>
#include <steadyrest/chatter/offline/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::offline {

/// The lowest depth in mm at which the cut becomes unstable, to 1e-9; empty: stable up to
/// `most_depth_mm`.
///
/// Depths are tried in steps of 1/256 of the greatest, growing to 6 % of the depth: an unstable
/// island that is narrower can be missed. Refuses what DepthLine refuses.
[[nodiscard]] kernel::outcome::Result<std::optional<double>> limit_depth_mm(
    const Process& process, double speed_rev_s, const Modulation& modulation, double most_depth_mm);

/// The same along a line that is made already.
[[nodiscard]] std::optional<double> limit_depth_mm(DepthLine& line, double most_depth_mm);

}  // namespace steadyrest::chatter::offline
