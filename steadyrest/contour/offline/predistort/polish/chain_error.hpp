// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// How far the tool is from the path while the axes follow a command, as signed distances: smooth
/// functions of the command, unlike the contour error's magnitude.
class ChainError {
 public:
  struct Config {
    ServoModels models;
    std::array<double, 3> backlash_mm{};
    double period_s = 0.001;
    kernel::signal::Point normal{0.0, 0.0, 1.0};  ///< of the plane that `side_mm` lies in
    /// What the tool is off by beyond the models, by path length; none: nothing.
    std::function<kernel::signal::Point(double foot_mm)> unknown;
  };
  /// One sample: to the left of the path in the plane, and along its normal.
  struct Off {
    double side_mm = 0.0;
    double height_mm = 0.0;
    double fast_ratio = 0.0;  ///< by how much the tool is faster than the path's own feed
  };

  ChainError(const Config& config, kernel::signal::PathView path);

  /// The axes at some instant, and the path length near which the tool is.
  struct State {
    AxesState axes;
    double foot_mm = 0.0;
  };
  /// `after_s` later than at the state: the command keeps its velocity until then.
  void begin(const State& from, double after_s);
  /// A sample for each command after the first, the state with it.
  void run(std::span<const kernel::signal::Point> command, std::vector<Off>& out,
           std::vector<State>* states = nullptr);

 private:
  void find_foot(double back_mm, double ahead_mm) noexcept;
  [[nodiscard]] Off off() const noexcept;

  Config config_;
  kernel::signal::PathView path_;
  std::array<online::AxisStep, 3> step_{};
  AxesState axes_;
  std::size_t segment_ = 0;
  double u_ = 0.0;
  kernel::signal::Point foot_{};
};

}  // namespace steadyrest::contour::offline
