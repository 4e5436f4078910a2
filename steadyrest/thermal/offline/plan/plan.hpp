// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/plan/curve.hpp>

namespace steadyrest::thermal::offline {

/// How the corrections are chosen.
struct PlanRequest {
  double tolerance_mm = 0.010;  ///< Δ where a transition has none of its own
  double share = 1.0;           ///< k; Δ_k = k·Δ
  double max_offset_mm = 0.1;   ///< limit of the sum of corrections
  double min_interval_s = 1.0;  ///< between two non-zero corrections
  /// Instants are rounded to whole multiples of it from the beginning; 0 = not. The residual may
  /// then exceed the band: see AxisCorrections::over_band_mm.
  double resolution_s = 0.0;
  /// Corrections of 2·Δ_k, so that the residual swings from +Δ_k to −Δ_k: half as many places.
  bool whole_band = false;
};

/// A row of the system R: {n; {t_j}; {δ_j}}. δ_j is corrected at the START of interval j.
struct PlannedTransition {
  std::string name;
  double tolerance_mm = 0.0;
  std::vector<double> interval_s;
  std::vector<double> delta_mm;
};

struct AxisCorrections {
  std::string name;
  std::vector<PlannedTransition> transition;
  double largest_mm = 0.0;           ///< |displacement| without corrections
  double largest_residual_mm = 0.0;  ///< |residual displacement|
  /// Largest excess of the residual over its transition's band Δ_k, and the excess allowed there:
  /// the steepest slope of the transition × half the resolution (at least 1 ms, within which
  /// instants count as one). Both are 0 where the band itself is kept.
  double over_band_mm = 0.0;
  double allowed_over_mm = 0.0;
  double largest_offset_mm = 0.0;  ///< |sum of corrections|
  std::size_t corrections = 0;
};

/// The compensation block: where the displacement less the corrections so far reaches ±Δ_k it is
/// corrected by Δ_k (heating: +, cooling: −), and the residual carries over from transition to
/// transition. At the start of a stricter transition as many Δ_k are taken as bring it inside.
/// Instants are roots of the closed form. Source: Marusich 2012, blocks 3 to 5, loops A to C.
///
/// The transition's first δ corrects whatever reaches the border at its start or is rounded onto
/// it.
///
/// Refused: tolerances that are not positive, corrections beyond `max_offset_mm`, corrections
/// closer together than `min_interval_s`, and a plan that would leave more than its band plus the
/// allowance for rounding its instants (`allowed_over_mm`).
[[nodiscard]] kernel::outcome::Result<AxisCorrections> plan_corrections(const std::string& name,
                                                                        const Curve& curve,
                                                                        const Cyclogram& cyclogram,
                                                                        const PlanRequest& request);

}  // namespace steadyrest::thermal::offline
