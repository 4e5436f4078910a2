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
#include <steadyrest/trial/cut/true_error.hpp>

namespace steadyrest::trial::cut {

/// One part on the simulated machine.
struct Job {
  kernel::machine::Machine machine;
  std::shared_ptr<const nc::plan::PlannedPath> path;
  bool with_layer = false;  ///< the supervisor acts; without it nobody touches the overrides
  // Designated initialisers may leave these out.
  // NOLINTBEGIN(readability-redundant-member-init)
  std::optional<kernel::machine::Machine> believed =
      {};  ///< what the layer is told; empty: `machine`
  std::optional<sim::CuttingVibration::Config> cutting = {};  ///< empty: it cuts air
  std::vector<ChatterChoice> choices = {};  ///< the modulator's law for each programmed speed
  std::optional<supervisor::ListeningStage> listener = {};  ///< it hears the vibration
  std::shared_ptr<const Original> against =
      {};  ///< contour errors refer to it; empty: Original::of_itself()
  // NOLINTEND(readability-redundant-member-init)
  /// Called with every frame of the control, before a layer sees it.
  std::function<void(const kernel::signal::Frame& frame)> on_frame = [](const auto&) {};
  /// Called now and then with the share of the path done, 0 … 1.
  std::function<void(double share)> progress = [](double) {};
};

/// Any layer next to the control: gets each frame, returns the cycle's command, and may leave its
/// estimates of the axes' motion in the frame for scoring.
using Layer = std::function<kernel::signal::Command(kernel::signal::Frame&)>;
using OnSample = std::function<void(const Sample&)>;

/// Cuts the part and keeps the record. The contour error is the true tool's against the commanded
/// path, or against that of the original (true_error.hpp), which no layer can see; the layer has
/// only the encoders, and only the program's own path.
///
/// Refuses what the simulated machine or the supervisor refuse, and a cut that makes no progress
/// for ten simulated minutes.
[[nodiscard]] kernel::outcome::Result<Recorder> run(const Job& job);

/// The same with any layer (or none), handing out every sample; ignores `job.with_layer`.
[[nodiscard]] kernel::outcome::Result<void> run(const Job& job, const Layer& layer,
                                                const OnSample& on_sample);

}  // namespace steadyrest::trial::cut
