// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/sim/cut/cutting_process.hpp>

/// A process of the chatter room, cut on the simulated machine.
namespace steadyrest::trial::vibration {

/// The process as plain data; the direction gives the place of the finished wall.
[[nodiscard]] sim::Cutting cutting_of(const chatter::offline::Process& process, double depth_mm);

struct CutSettings {
  double speed_rev_s = 0.0;  ///< mean, > 0
  double depth_mm = 0.0;     ///< > 0
  // Designated initialisers may leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  chatter::offline::Modulation modulation = {};
  double steps_per_period = 40.0;
};

/// How a small vibration grows while the tool stays in the cut: ln of the growth over a tooth's
/// mean pitch, averaged over whole periods of the law. Below 0: stable by simulation. No feed,
/// runout or edge force, so that only the disturbance vibrates; measured over the second half of
/// `pitches` (whole periods of the law; more if four of them need it).
[[nodiscard]] kernel::outcome::Result<double> log_growth_per_tooth(
    const chatter::offline::Process& process, const CutSettings& settings,
    std::size_t pitches = 2000);

/// One step of the full, non-linear cut.
struct Moment {
  double t_s = 0.0;
  double angle_rad = 0.0;
  double speed_rev_s = 0.0;
  sim::CuttingProcess::Output cut;
};

/// Cuts for `seconds` from a tool at rest and a smooth surface, with the process's feed.
[[nodiscard]] kernel::outcome::Result<void> simulate(
    const chatter::offline::Process& process, const CutSettings& settings, double seconds,
    const std::function<void(const Moment&)>& sink);

}  // namespace steadyrest::trial::vibration
