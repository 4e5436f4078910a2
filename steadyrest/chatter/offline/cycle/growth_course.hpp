// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>

/// How much a vibration may grow on its way through a period, pass by pass.
///
/// ‖Φ(t₂, t₁)‖_∞ over pass boundaries t₁ ≤ t₂: the largest later displacement over the largest
/// within one pass before t₁, for the worst of all vibrations (free vibration counts as q and
/// q̇/ω). It is followed for two principal periods (at least 20 passes) or until it has died to
/// 1e-4 of its peak and below its start.
namespace steadyrest::chatter::offline {

/// From one starting pass.
struct GrowthCourse {
  std::size_t start_pass = 0;      ///< within the principal period
  std::vector<double> log_growth;  ///< ln ‖Φ‖ after 0, 1, 2 … passes; the first is 0

  [[nodiscard]] double log_peak() const noexcept;
  /// The factor itself, e^700 at most.
  [[nodiscard]] double peak() const noexcept;
};

/// The most passes that a course is followed: two principal periods, at least 20 passes.
[[nodiscard]] std::size_t growth_window(const DelayCycle& cycle) noexcept;

/// At the cycle's present depth; from each pass, or from 16 evenly spaced ones if there are more.
[[nodiscard]] std::vector<GrowthCourse> growth_courses(DelayCycle& cycle);

/// The one with the greatest peak; the first of equals. `courses` not empty.
[[nodiscard]] const GrowthCourse& worst(const std::vector<GrowthCourse>& courses);

}  // namespace steadyrest::chatter::offline
