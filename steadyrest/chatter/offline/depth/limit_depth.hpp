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
/// unstable if that is less, growing to 6 % of the depth. A maximum of ρ among them that may exceed
/// 1, judged by the slopes on its sides, is searched by golden section, so that unstable islands
/// narrower than the steps are found. An island that leaves no trace in ρ at the depths around it,
/// where another multiplier leads for less than a step, can still be missed. Refuses what DepthLine
/// refuses.
[[nodiscard]] kernel::outcome::Result<std::optional<double>> limit_depth_mm(
    const Process& process, double speed_rev_s, const Modulation& modulation, double most_depth_mm);

/// A depth in mm below which no constant speed is unstable (ignoring process damping), whatever the
/// phases and directions: it assumes that all teeth cut at once and all modes respond at their
/// largest.
[[nodiscard]] double safe_depth_mm(const Process& process);

/// A depth in mm with ρ ≥ 1 near a maximum of ρ seen at `middle_mm`, between the depths on either
/// side; ln ρ is below 0 at all three and highest in the middle. Empty: ρ stays below 1.
[[nodiscard]] std::optional<double> island_mm(DepthLine& line,
                                              const std::array<double, 3>& depth_mm,
                                              const std::array<double, 3>& log_radius);

/// The same along an existing line; the search starts at `from_mm`, unless the cut is unstable
/// there.
[[nodiscard]] std::optional<double> limit_depth_mm(DepthLine& line, double most_depth_mm,
                                                   double from_mm = 0.0);

}  // namespace steadyrest::chatter::offline
