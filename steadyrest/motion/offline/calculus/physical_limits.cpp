// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/offline/calculus/physical_limits.hpp>

namespace steadyrest::motion::offline {

// Landau's inequality on the half line (Matorin for the third derivative): a function known to ± ε
// with |x‴| ≤ J has |ẋ| to (243/8)^⅓·ε^⅔·J^⅓ = 3.12·… and |ẍ| to 24^⅓·ε^⅓·J^⅔ = 2.88·…; no
// estimator can guarantee less.
MotionError landau_bound(double position_error_mm, double jerk_mm_s3) {
  const double e = std::cbrt(position_error_mm);
  const double j = std::cbrt(jerk_mm_s3);
  return {std::cbrt(243.0 / 8.0) * e * e * j, std::cbrt(24.0) * e * j * j};
}

// Edges a spacing apart say nothing about the motion between them: the floor is that of dense edges
// or what the jerk can do unseen within a spacing, whichever is larger.
MotionError guaranteed_floor(const EdgeQuality& quality) {
  const double v = quality.speed_mm_s;
  const double spacing_s = quality.count_mm / v;
  const double j = quality.jerk_mm_s3;
  const MotionError landau = landau_bound(0.5 * v * quality.clock_s + quality.line_error_mm, j);
  return {std::max(landau.velocity_mm_s, std::min(j * spacing_s * spacing_s / 8.0, v)),
          std::max(landau.acceleration_mm_s2, std::min(0.5 * j * spacing_s, 4.0 * v / spacing_s))};
}

// A parabola fitted over the window W: variance 192·s/W³ and 720·s/W⁵ (s the variance per edge
// times the spacing), bias J·W²/10 and J·W/2. Setting the derivative of variance + bias² to zero
// gives W⁷ = 14400·s/J² and 7200·s/J². Never less than two spacings.
MotionError stochastic_optimum(const EdgeQuality& quality) {
  const double v = quality.speed_mm_s;
  const double j = quality.jerk_mm_s3;
  const double clock_mm = v * quality.clock_s;
  const double variance =
      clock_mm * clock_mm / 12.0 + quality.line_error_mm * quality.line_error_mm;
  const double s = variance * quality.count_mm / v;
  const double least_s = 2.0 * quality.count_mm / v;
  const double wv = std::max(std::pow(14400.0 * s / (j * j), 1.0 / 7.0), least_s);
  const double wa = std::max(std::pow(7200.0 * s / (j * j), 1.0 / 7.0), least_s);
  return {std::hypot(std::sqrt(192.0 * s / (wv * wv * wv)), j * wv * wv / 10.0),
          std::hypot(std::sqrt(720.0 * s / std::pow(wa, 5.0)), 0.5 * j * wa)};
}

}  // namespace steadyrest::motion::offline
