// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/sim/panel/operator_panel.hpp>
#include <steadyrest/supervisor/listening_stage.hpp>

namespace steadyrest::trial::cut {

/// The layer's action against chatter at one of the program's spindle speeds.
struct ChatterChoice {
  double speed_rev_s = 0.0;  ///< programmed, magnitude
  chatter::offline::PlanDecision decision = chatter::offline::PlanDecision::nothing;
  chatter::online::Modulation modulation;  ///< for the modulator
  /// Lowest setting of the operator's spindle switch that allows it: the layer does not exceed the
  /// switch.
  double switch_ratio = 1.0;
  std::vector<std::string> notes;  ///< of the planner, in words
};

/// Spindle speeds at which the program cuts (G1–G3), rev/s, magnitudes, ascending; G96 speeds
/// change along the way and are left out.
[[nodiscard]] std::vector<double> cutting_speeds(const nc::plan::PlannedPath& path);

/// Lowest programmed speed of a cut, G96 included; 0 when the spindle is stopped. It sets the time
/// grid of a simulated cut: the slower the spindle, the more steps a tooth pass needs.
[[nodiscard]] double slowest_cut_rev_s(const nc::plan::PlannedPath& path);

/// For each stretch that cuts under G96, and so at an unplanned speed: where, and from which speed
/// to which. A cut at a programmed speed ends a stretch; repeated lines count once.
[[nodiscard]] std::vector<nc::plan::Warning> unplanned_cuts(const nc::plan::PlannedPath& path);

/// Asks the planner for each speed. At most `kMostSpeeds`; refuses more, and what the planner
/// refuses.
[[nodiscard]] kernel::outcome::Result<std::vector<ChatterChoice>> choose(
    const chatter::offline::Process& process, const kernel::machine::Machine& machine,
    const std::vector<double>& speeds_rev_s, double depth_mm,
    const std::function<void(double share, std::string_view what)>& progress);

inline constexpr std::size_t kMostSpeeds = 32;

/// The choice for a programmed speed; nullptr if there is none.
[[nodiscard]] const ChatterChoice* choice_for(const std::vector<ChatterChoice>& choices,
                                              double programmed_rev_s) noexcept;

/// The lowest ratio of the programmed spindle speed that the layer can ask for: by the choices, by
/// the machine's own [chatter], and for a listener anything, within the envelope and the override's
/// steps. `machine`: as listener::with_modulator() made it, if it did.
[[nodiscard]] double least_spindle_ratio(const std::vector<ChatterChoice>& choices, bool listens,
                                         const kernel::machine::Machine& machine);

/// The layer's ear on the simulated machine's sensor: listener::stage_for().
[[nodiscard]] kernel::outcome::Result<supervisor::ListeningStage> listener_for(
    const chatter::offline::Process& process, const kernel::machine::Machine& machine,
    const std::vector<double>& speeds_rev_s, double depth_mm);

/// The operator turns the spindle switch up for the choices before the program starts, where 100 %
/// is not enough.
[[nodiscard]] std::vector<sim::OperatorAction> operator_for(
    const std::vector<ChatterChoice>& choices, const kernel::machine::Machine& machine);

}  // namespace steadyrest::trial::cut
