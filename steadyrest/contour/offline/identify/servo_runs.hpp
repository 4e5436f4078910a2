// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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
                                              double period_s);

}  // namespace steadyrest::contour::offline
