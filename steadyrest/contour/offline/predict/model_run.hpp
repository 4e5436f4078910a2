// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <steadyrest/contour/online/servo_model.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// The servo model of X, Y and Z.
using ServoModels = std::array<online::AxisModel, 3>;
/// As the machine file has it; axes that it lacks are as stiff as the stiffest.
[[nodiscard]] ServoModels servo_models(std::span<const kernel::machine::Axis> axes);
/// Of the first three axes, mm.
[[nodiscard]] std::array<double, 3> backlash_mm(
    std::span<const kernel::machine::Axis> axes) noexcept;
/// The lowest gain, 1/s.
[[nodiscard]] double softest_gain_1_s(const ServoModels& models) noexcept;

/// How far each axis is behind its command, s: g = (1 − a)/k.
[[nodiscard]] std::array<double, 3> first_lags_s(const ServoModels& models) noexcept;

/// For each segment of a changed path, the original path lengths at its start and end, mm.
struct PathMap {
  std::vector<double> start_mm;
  std::vector<double> end_mm;
};
/// Of a path against itself.
[[nodiscard]] PathMap same_path(const nc::plan::PlannedPath& path);

/// What is run.
struct ModelRun {
  const kernel::machine::Machine& machine;
  const nc::plan::PlannedPath& path;      ///< that the control runs
  const nc::plan::PlannedPath& original;  ///< that the part should have
  const PathMap& map;
  ServoModels model;
  /// Other models that follow the same commands: what the model's uncertainty makes of it.
  std::vector<ServoModels> others;
  std::array<double, 3> backlash_mm{};  ///< between the motors and the tool
  /// What the tool is off by beyond the model, by original path length: added to all errors.
  std::function<kernel::signal::Point(double foot_mm)> unknown = nullptr;
};

/// One sample of the run; `other_error_mm` and the sample are valid during the call only.
struct ModelSample {
  double time_s = 0.0;
  double position_mm = 0.0;   ///< of the command on the path that is run
  double command_mm_s = 0.0;  ///< along that path
  double progress_mm = 0.0;   ///< of the command, as original path length
  double foot_mm = 0.0;       ///< original path length that the tool is at
  double error_mm = 0.0;      ///< contour error, signed as in online::ContourError
  /// How much larger the error was since the sample before, where the tool passes a corner.
  double more_mm = 0.0;
  kernel::signal::Point off_mm{};  ///< from the tool to its foot
  std::uint32_t line = 0;          ///< of the path that is run
  std::size_t segment = 0;
  bool cuts = false;                       ///< the command is in a feed move, and so is the tool
  bool arriving = false;                   ///< the command waits, the tool still cuts …
  bool ended = false;                      ///< … behind the program's end: no part of its time
  std::span<const double> other_error_mm;  ///< magnitudes, for each of `others`
};

/// Runs a planned program on the servo model: the control's setpoints (nc/plan, 100 % override),
/// the exact step of each axis's law, the distance of the tool to the original path.
///
///   τ·ẍ + ẋ = k·(c − x) + a·ċ;   error = min |p(s) − x| near the place that the map gives.
///
/// The errors of `others` are taken square to the path at the foot of `model`: good to (k − k′)²v²
/// /(2Rk⁴), the square of a difference of lags. Samples are 0.1/k of the softest axis apart, at
/// least one interpolator period. The tool follows the motors within the
/// backlash, and after a stop until it has arrived (Arriving), at the program's end too. Not in it:
/// friction, cutting forces. Returns the cycle time in s; the spindle takes its ramps. Refused:
/// what the planner refuses.
[[nodiscard]] kernel::outcome::Result<double> run_model(
    const ModelRun& run, const std::function<void(const ModelSample&)>& on_sample);

}  // namespace steadyrest::contour::offline
