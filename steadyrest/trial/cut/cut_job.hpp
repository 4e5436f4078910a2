// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/sim/cut/cutting_vibration.hpp>
#include <steadyrest/trial/cut/chatter_choice.hpp>
#include <steadyrest/trial/cut/recorder.hpp>

namespace steadyrest::trial::cut {

/// One part on the simulated machine.
struct Job {
  kernel::machine::Machine machine;
  std::shared_ptr<const nc::plan::PlannedPath> path;
  bool with_layer = false;  ///< the supervisor acts; without it nobody touches the overrides
  // Designated initialisers may leave these out.
  // NOLINTBEGIN(readability-redundant-member-init)
  std::optional<sim::CuttingVibration::Config> cutting = {};  ///< empty: it cuts air
  std::vector<ChatterChoice> choices = {};  ///< what the modulator runs at which programmed speed
  std::optional<supervisor::ListeningStage> listener = {};  ///< it hears the vibration
  // NOLINTEND(readability-redundant-member-init)
  /// Called now and then with the share of the path that is cut, 0 … 1.
  std::function<void(double share)> progress = [](double) {};
};

/// Whoever stands beside the control: gets each frame, gives the cycle's command, and may leave its
/// estimates of the axes' motion in the frame, to be judged.
using Layer = std::function<kernel::signal::Command(kernel::signal::Frame&)>;
using OnSample = std::function<void(const Sample&)>;

/// Cuts the part and keeps the record. The contour error is that of the true tool against the
/// commanded path, which no layer can see; the layer has the encoders alone.
///
/// Refuses what the simulated machine or the supervisor refuse, and a cut that stands still for
/// ten simulated minutes.
[[nodiscard]] kernel::outcome::Result<Recorder> run(const Job& job);

/// The same with any layer (or none) and every sample handed out; `job.with_layer` is not looked
/// at.
[[nodiscard]] kernel::outcome::Result<void> run(const Job& job, const Layer& layer,
                                                const OnSample& on_sample);

}  // namespace steadyrest::trial::cut
