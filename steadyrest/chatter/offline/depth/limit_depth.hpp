// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <steadyrest/chatter/offline/depth/depth_line.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::offline {

/// The lowest depth in mm at which the cut becomes unstable, to 1e-9; empty: stable up to
/// `most_depth_mm`.
///
/// Depths are tried in steps of 1/256 of the greatest, or of the depth below which no speed is
/// unstable where that is less, growing to 6 % of the depth. Where ρ has a
/// maximum among them that may pass 1, by the slopes on its sides, it is sought by golden sections,
/// so that an unstable island narrower than the steps is found. One that leaves no trace in ρ at
/// the depths about it, where another multiplier leads for less than a step, can still be missed.
/// Refuses what DepthLine refuses.
[[nodiscard]] kernel::outcome::Result<std::optional<double>> limit_depth_mm(
    const Process& process, double speed_rev_s, const Modulation& modulation, double most_depth_mm);

/// A depth in mm below which no constant speed is unstable (process damping left out), whatever the
/// phases and directions: all teeth are taken to cut at once, all modes to answer at their largest.
[[nodiscard]] double safe_depth_mm(const Process& process);

/// A depth in mm with ρ ≥ 1 beside a maximum of ρ that was seen at `middle_mm`: between the depths
/// on its sides, ln ρ at all three below 0 and highest in the middle. Empty: ρ stays below 1.
[[nodiscard]] std::optional<double> island_mm(DepthLine& line,
                                              const std::array<double, 3>& depth_mm,
                                              const std::array<double, 3>& log_radius);

/// The same along a line that is made already; nothing is sought below `from_mm`, unless it is
/// unstable there.
[[nodiscard]] std::optional<double> limit_depth_mm(DepthLine& line, double most_depth_mm,
                                                   double from_mm = 0.0);

}  // namespace steadyrest::chatter::offline
