// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <steadyrest/contour/online/axis_step.hpp>
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

/// What each axis may be as well; together all combinations, those of Z fastest. None where an axis
/// has none.
struct OtherModels {
  std::array<std::vector<online::AxisModel>, 3> axis;

  [[nodiscard]] std::size_t size() const noexcept {
    return axis[0].size() * axis[1].size() * axis[2].size();
  }
  [[nodiscard]] ServoModels operator[](std::size_t i) const {
    const std::size_t z = axis[2].size();
    const std::size_t yz = axis[1].size() * z;
    return {axis[0][i / yz], axis[1][i % yz / z], axis[2][i % z]};
  }
};

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
  OtherModels others;
  std::array<double, 3> backlash_mm{};  ///< between the motors and the tool
  /// What the tool is off by beyond the model, by original path length: added to all errors.
  std::function<kernel::signal::Point(double foot_mm)> unknown = nullptr;
};

/// Where the modelled axes are and how they move.
struct AxesState {
  online::ServoState servo;           ///< behind the command
  kernel::signal::Point mean_mm_s{};  ///< of the command, over the last step
  kernel::signal::Point tool_mm{};    ///< within the backlash of the motors
};

/// Of one of the other models.
struct OtherError {
  double error_mm = 0.0;  ///< its magnitude
  double peak_mm = 0.0;   ///< the largest since the sample before
};

/// One sample of the run; `others` and the sample are valid during the call only.
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
  AxesState axes;
  std::uint32_t line = 0;  ///< of the path that is run
  std::size_t segment = 0;
  bool cuts = false;      ///< the command is in a feed move, and so is the tool
  bool arriving = false;  ///< the command waits, the tool still cuts …
  bool ended = false;     ///< … behind the program's end: no part of its time
  std::span<const OtherError> others;
};

/// Runs a planned program on the servo model: the control's setpoints (nc/plan, 100 % override),
/// the exact step of each axis's law, the distance of the tool to the original path.
///
///   τ·ẍ + ẋ = k·(c − x) + a·ċ;   error = min |p(s) − x| near the place that the map gives.
///
/// The errors of `others` are taken square to the path at the foot of `model` where that is good to
/// 1 µm, else they are searched for around it. Samples are 0.1/k of the softest axis apart, at
/// least one interpolator period. The tool follows the motors within the
/// backlash, and after a stop until it has arrived (Arriving), at the program's end too. Not in it:
/// friction, cutting forces. Returns the cycle time in s; the spindle takes its ramps. Refused:
/// what the planner refuses.
[[nodiscard]] kernel::outcome::Result<double> run_model(
    const ModelRun& run, const std::function<void(const ModelSample&)>& on_sample);

}  // namespace steadyrest::contour::offline
