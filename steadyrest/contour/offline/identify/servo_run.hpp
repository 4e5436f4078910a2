// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <steadyrest/contour/offline/identify/servo_steps.hpp>

namespace steadyrest::contour::offline {

/// How far the axis is from the fitted law.
struct ServoMisfit {
  double rms = 0.0;  ///< actual less simulated position, all samples
  double largest = 0.0;
  /// RMS where the command accelerates hard (over half of the most) and for 3/k after it, and
  /// elsewhere.
  double hard_rms = 0.0;
  double calm_rms = 0.0;
  double lost_motion = 0.0;  ///< mean over the reversals
  double lost_motion_sd = 0.0;
  std::size_t reversals = 0;
};

/// Simulates the law freely: each unbroken stretch begins at its first actual position.
[[nodiscard]] ServoMisfit misfit(const ServoLog& log, std::span<const ServoRun> runs, int shift,
                                 const ServoStep& step);

}  // namespace steadyrest::contour::offline
