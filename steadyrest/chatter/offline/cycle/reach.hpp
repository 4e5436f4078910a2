// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Which cuts the solvers can handle, and why not the others.
///
/// The work and the memory of the map of a pass grow with the waves that the fastest vibration
/// makes in it, w = T·√(ω² + 1000·a·z·K/m)/2π with T the time of a pass, K = |(Kt, Kr)| and z teeth
/// cutting at once (`fastest_rad_s` has the bound for several modes): few where the spindle is fast
/// and the depth small, without limit where either is absurd. The solvers handle some 300 waves;
/// there a lobe is 1/300 of the speed wide, the border is within 2 % of the absolute limit at every
/// speed, and ln ρ is good only to 1e-4, because a vibration, and the rounding with it, may grow
/// 10¹²-fold on its way. At the other end, a vibration of less than 1e-4 of a wave per pass decays
/// by less than the solvers' error of 1e-9.
namespace steadyrest::chatter::offline {

/// Waves between two teeth (in a revolution if the pitch is uneven) of the fastest oscillation at
/// this depth, including forces and process damping.
[[nodiscard]] double fastest_waves(const Process& process, double slowest_rev_s, double depth_mm);

/// The same for the free vibration of highest frequency, by which the lobes are counted.
[[nodiscard]] double free_waves(const Process& process, double speed_rev_s) noexcept;

/// The refusal where the cut is beyond reach, with the speeds and depths that are not. A cut within
/// reach is so at every smaller depth. `passes`: in the principal period.
[[nodiscard]] std::optional<kernel::outcome::Refusal> beyond_reach(const Process& process,
                                                                   double slowest_rev_s,
                                                                   double most_depth_mm,
                                                                   std::size_t passes = 1);

}  // namespace steadyrest::chatter::offline
