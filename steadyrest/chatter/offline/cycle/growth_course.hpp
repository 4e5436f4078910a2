// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>

/// How much a vibration may grow on its way through a period, pass by pass.
///
/// ‖Φ(t₂, t₁)‖_∞ over pass boundaries t₁ ≤ t₂: the largest later displacement over the largest
/// within one pass before t₁, of all vibrations the worst (free vibration counts as q and q̇/ω). It
/// is followed for two principal periods (20 passes at least) or until it has died to 1e-4 of its
/// peak and of its beginning.
namespace steadyrest::chatter::offline {

/// From one beginning on.
struct GrowthCourse {
  std::size_t start_pass = 0;      ///< within the principal period
  std::vector<double> log_growth;  ///< ln ‖Φ‖ after 0, 1, 2 … passes; the first is 0

  [[nodiscard]] double log_peak() const noexcept;
  /// The factor itself, e^700 at most.
  [[nodiscard]] double peak() const noexcept;
};

/// How many passes a course is followed at most: two principal periods, 20 passes at least.
[[nodiscard]] std::size_t growth_window(const DelayCycle& cycle) noexcept;

/// At the cycle's present depth; from each pass, from 16 even ones where there are more.
[[nodiscard]] std::vector<GrowthCourse> growth_courses(DelayCycle& cycle);

/// The one with the greatest peak; the first of equals. `courses` not empty.
[[nodiscard]] const GrowthCourse& worst(const std::vector<GrowthCourse>& courses);

}  // namespace steadyrest::chatter::offline
