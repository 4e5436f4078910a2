// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// By how much the servos may differ from the machine file.
struct ServoUncertainty {
  double gain = 0.05;           ///< of each gain
  std::array<double, 3> lag{};  ///< of the velocity loops, up and down, in 1/k; never below 0

  /// Lags that the machine file does not give may be anything up to half of 1/k; those that it
  /// gives are sure. `lag`: of every axis instead.
  static constexpr double kUnknownLag = 0.5;
  [[nodiscard]] static ServoUncertainty of(std::span<const kernel::machine::Axis> axes, double gain,
                                           std::optional<double> lag);
};

/// The corners of the uncertainty: each gain and lag up or down, but for axes that the path never
/// moves. Empty where all is sure.
[[nodiscard]] OtherModels uncertain(const ServoModels& model, const ServoUncertainty& by,
                                    kernel::signal::PathView path);

/// Gains within the uncertainty that are as equal as they can be. Unequal gains bend straight
/// lines; a difference that may not be there must not be corrected, or a machine without it would
/// get it.
[[nodiscard]] ServoModels cautious(const ServoModels& model, double share);

}  // namespace steadyrest::contour::offline
