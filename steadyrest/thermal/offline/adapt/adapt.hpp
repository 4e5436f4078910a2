// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/thermal/offline/plan/cyclogram.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

/// Loop D of Marusich's algorithm: measured parts change the level k and the model's gains.
namespace steadyrest::thermal::offline {

// --- the level ---------------------------------------------------------------------------------

struct PartError {
  double deviation_mm = 0.0;
  double tolerance_mm = 0.0;  ///< Δ
};

struct LevelRule {
  double measuring_sd_mm = 0.0005;  ///< of a deviation; twice that does not count against a part
  double few = 0.05;                ///< share of the parts that may exceed theirs
  double well_inside = 0.5;         ///< share of k·Δ; all parts below it: one level back
  std::size_t least = 5;            ///< fewest parts for a step back
};

struct LevelChoice {
  std::uint32_t level = 0;
  double share = 1.0;  ///< k of it
  std::size_t outside = 0;
  double largest_ratio = 0.0;  ///< |deviation| over k·Δ of the previous level
  bool exhausted = false;      ///< the parts exceed their share and there is no stricter level
};

/// One step of the loop: if more than a few parts exceed k·Δ, the next stricter level; if all are
/// well inside, one back; else the same. `share` falls from level to level.
[[nodiscard]] LevelChoice next_level(std::span<const double> share, std::uint32_t level,
                                     std::span<const PartError> parts, const LevelRule& rule);

// --- the gains ---------------------------------------------------------------------------------

/// The model's prediction for an instant of the work, since its start.
struct Prediction {
  double displacement_mm = 0.0;
  std::vector<double> mode_mm;  ///< the modes' parts of it
};

/// For each instant, in any order. `model` and `ambient_c` as for curve_of().
[[nodiscard]] std::vector<Prediction> predict(const online::ThermalModel& model,
                                              const Cyclogram& cyclogram,
                                              const std::vector<double>& ambient_c,
                                              std::span<const double> time_s);

/// A measured deviation, with the plan's expectation.
struct Observation {
  double deviation_mm = 0.0;
  double expected_mm = 0.0;     ///< forecast displacement less the corrections in force
  std::vector<double> mode_mm;  ///< the modes' parts of the forecast
};

struct GainRule {
  double gain_sd_ratio = 0.2;       ///< prior uncertainty of a mode's gain
  double bias_sd_mm = 0.002;        ///< the same for what is constant over all parts
  double measuring_sd_mm = 0.0005;  ///< of a deviation
  double gate_sd = 3.0;
  double min_gain = 0.5;  ///< limits of the gains
  double max_gain = 2.0;
};

struct Gains {
  std::vector<double> gain;          ///< a factor for each mode's levels
  std::vector<double> gain_sd;       ///< of it
  double bias_mm = 0.0;              ///< of all parts: workpiece zero and tool, not the passport
  std::vector<std::size_t> outlier;  ///< indices of observations beyond the gate, not taken
  double rms_before_mm = 0.0;        ///< deviation less expected, outliers aside
  double rms_after_mm = 0.0;         ///< the same with the new gains and bias
  bool clamped = false;
  bool few = false;  ///< fewer than 4: too few to tell what is wrong; gains should stay
  bool fits = true;  ///< false: the model no longer fits this machine
};

/// Recursive least squares: deviation − expected = Σ (g_i − 1)·x_i + b + noise, prior g = 1 and b =
/// 0. An observation beyond the gate is not taken; one that is beyond it once all are known (it
/// came early, when little was known) is removed and everything is redone.
/// (it came early, when little was known) is taken out and all is done again.
///
/// The model no longer fits when Σe² of the normalised innovations, each limited to ±gate, exceeds
/// the 99.9 % point of χ²_N, or |Σe|/√N that of the normal law (from 4 on), when more than a
/// quarter are outliers (of fewer than 4: one), or when a gain is at its limit.
[[nodiscard]] Gains learn_gains(std::span<const Observation> observations, const GainRule& rule);

/// The passport with these gains in its levels and in their covariance.
void apply_gains(kernel::machine::ThermalAxis& axis, std::span<const double> gain);

}  // namespace steadyrest::thermal::offline
