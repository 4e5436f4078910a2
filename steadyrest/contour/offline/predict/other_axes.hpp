// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/online/axis_step.hpp>
#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// An axis that follows its command, and the tool within the backlash of its motor.
class ModelAxis {
 public:
  ModelAxis(const online::AxisModel& model, double period_s, double backlash_mm) noexcept
      : step_(online::AxisStep::of(model, period_s)), half_mm_(0.5 * backlash_mm) {}

  /// One period to this command, with its mean velocity and the change since the period before.
  void step(double command_mm, double mean_mm_s, double change_mm_s) noexcept {
    const online::AxisStep& s = step_;
    const double e = error_mm_;
    const double w = velocity_mm_s_;
    error_mm_ = s.ee * e + s.ew * w + s.e_mean * mean_mm_s + s.e_change * change_mm_s;
    velocity_mm_s_ = s.we * e + s.ww * w + s.w_mean * mean_mm_s + s.w_change * change_mm_s;
    // z = min(max(z, x − b/2), x + b/2)
    const double motor_mm = command_mm - error_mm_;
    tool_mm_ = std::clamp(tool_mm_, motor_mm - half_mm_, motor_mm + half_mm_);
  }
  [[nodiscard]] double error_mm() const noexcept { return error_mm_; }
  [[nodiscard]] double velocity_mm_s() const noexcept { return velocity_mm_s_; }
  [[nodiscard]] double tool_mm() const noexcept { return tool_mm_; }

 private:
  online::AxisStep step_;
  double half_mm_;
  double error_mm_ = 0.0;
  double velocity_mm_s_ = 0.0;
  double tool_mm_ = 0.0;
};

/// The model's foot on the original path.
struct ModelFoot {
  kernel::signal::PathView path;
  const online::ContourError::Output& at;
  kernel::signal::Point unknown_mm{};  ///< that tools are off by beyond their models
  const std::vector<double>& bends_mm;
};

/// Path lengths at which the direction breaks: an error has its peak there.
[[nodiscard]] std::vector<double> bends_of(kernel::signal::PathView path);

/// Every axis in all its kinds, once; the tools are their combinations.
class OtherAxes {
 public:
  OtherAxes(const OtherModels& models, double period_s, const std::array<double, 3>& backlash_mm);
  void step(const kernel::signal::Point& command_mm, const kernel::signal::Point& mean_mm_s,
            const kernel::signal::Point& change_mm_s) noexcept;
  /// How far each tool is beside the path: of its tangent √(|o|² − (o·t)²), where that is good.
  std::span<const OtherError> errors(const ModelFoot& foot) noexcept;

 private:
  struct Kind {
    ModelAxis axis;
    double before_mm = 0.0;  ///< the tool, one sample before
    double square_mm2 = 0.0;
    double along_mm = 0.0;
  };
  static OtherError exact(const ModelFoot& foot, const std::array<const Kind*, 3>& tool,
                          double reach_mm) noexcept;

  std::array<std::vector<Kind>, 3> kinds_;
  std::vector<OtherError> errors_;
};

}  // namespace steadyrest::contour::offline
