// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace steadyrest::contour::offline {

struct ServoLog;

/// Samples [first, last] of a log without a gap.
struct ServoRun {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Median step of the time; 0 for fewer than two samples.
[[nodiscard]] double servo_period_s(const std::vector<double>& time_s);

/// The log without what breaks it: steps of another length, and commands that jump faster than
/// `most_s` (per second).
[[nodiscard]] std::vector<ServoRun> unbroken(const ServoLog& log, double period_s, double most_s);

/// The parts of `runs` in motion, and 0.1 s after it, at least 20 samples long.
[[nodiscard]] std::vector<ServoRun> in_motion(const ServoLog& log, std::span<const ServoRun> runs,
                                              double period_s, int shift);

/// One-cycle law: e⁺ = p·e + q·d + r.
struct ServoStep {
  double p = 0.0;
  double q = 0.0;
  double r = 0.0;
};

struct StepFit {
  ServoStep step;
  double variance[3][3] = {};  ///< of p, q, r
  std::size_t samples = 0;
  double left = 0.0;  ///< sum of the squares that a free simulation of these stretches leaves
};

/// Fits the law to these stretches (servo_fit.hpp); empty where they do not determine it.
[[nodiscard]] std::optional<StepFit> fit_step(const ServoLog& log, std::span<const ServoRun> runs,
                                              int shift);

}  // namespace steadyrest::contour::offline
