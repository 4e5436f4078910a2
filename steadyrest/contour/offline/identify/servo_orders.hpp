// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/contour/offline/identify/servo_likelihood.hpp>

namespace steadyrest::contour::offline {

/// Delays that a control is likely to have: none, half a cycle (held), a cycle; the last is free.
inline constexpr std::size_t kDelays = 4;

struct ServoCandidate {
  std::size_t delay = 0;  ///< which of them
  ServoFitted fitted;
};

/// The laws that the record may support: with and without feed-forward, lag, second order,
/// structural mode, with each delay. The likely ones have their variances.
[[nodiscard]] std::vector<ServoCandidate> candidates_of(const ServoProblem& whole);

/// The numbers of a fit with what the choice between the laws leaves open in their deviations.
struct ServoNumbers {
  ServoFitted best;
  double sd[kFree] = {};
  /// What the record allows of τ, two standard deviations each way.
  double least_lag_s = 0.0;
  double most_lag_s = 0.0;
};

/// The best of the candidates, each weighted by its likelihood; `against[d]` is what the other axes
/// add to the badness of delay d.
[[nodiscard]] ServoNumbers best_of(const std::vector<ServoCandidate>& candidates,
                                   const std::vector<double>& against);

}  // namespace steadyrest::contour::offline
