// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// A program as the control would run it undisturbed, on the servo model: when it is where, and
/// what the model expects the tool to be off by.
class PlannedMotion {
 public:
  void add(const ModelSample& sample);

  /// The time at which the command arrives at a place of the path that is run, and when it leaves.
  struct Stay {
    double from_s = 0.0;
    double to_s = 0.0;
  };
  [[nodiscard]] Stay stay(double position_mm) const noexcept;
  [[nodiscard]] double speed_mm_s(double position_mm) const noexcept;
  /// The vector from the tool to its foot, by original path length of the foot.
  [[nodiscard]] kernel::signal::Point off_mm(double foot_mm) const noexcept;
  [[nodiscard]] bool empty() const noexcept { return foot_mm_.empty(); }

 private:
  std::vector<double> position_mm_;  ///< not falling
  std::vector<double> time_s_;
  std::vector<double> speed_mm_s_;
  std::vector<double> foot_mm_;  ///< rising
  std::vector<kernel::signal::Point> off_mm_;
};

}  // namespace steadyrest::contour::offline
