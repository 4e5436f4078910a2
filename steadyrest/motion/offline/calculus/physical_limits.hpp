// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How well velocity and acceleration can be known at all from edges, whatever the estimator.
namespace steadyrest::motion::offline {

struct MotionError {
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
};

/// One speed, one encoder, one axis.
struct EdgeQuality {
  double speed_mm_s = 0.0;     ///< v > 0
  double count_mm = 0.001;     ///< q > 0
  double clock_s = 0.0;        ///< dt ≥ 0, period of the time stamps
  double line_error_mm = 0.0;  ///< ≥ 0; largest (guarantee) or RMS (stochastic optimum)
  double jerk_mm_s3 = 0.0;     ///< J > 0
};

/// The smallest bounds that anyone can guarantee for |jerk| ≤ J without lag, positions known to ±ε:
///   v: (243/8)^⅓·ε^⅔·J^⅓ = 3.12·ε^⅔·J^⅓,   a: 24^⅓·ε^⅓·J^⅔ = 2.88·ε^⅓·J^⅔
/// (Landau 1913, Matorin 1955: Kolmogorov's inequality on the half line).
[[nodiscard]] MotionError landau_bound(double position_error_mm, double jerk_mm_s3);

/// The same with ε = v·dt/2 + line error, but not below the floor set by the edge spacing. The
/// perfect spline of period 2D, D = q/v, is 0 at every edge: added to the motion it changes no
/// edge, yet the velocity by J·D²/8 at the edges and the acceleration by J·D/2 between them. It
/// must not reverse the axis: at most v and 4·v/D.
[[nodiscard]] MotionError guaranteed_floor(const EdgeQuality& quality);

/// RMS of the best parabola through the edges of a window W at its end, if the jerk is J all the
/// time: with s = σ²·q/v, σ² = (v·dt)²/12 + line error²,
///   v: 192·s/W³ + (J·W²/10)², W⁷ = 14400·s/J²,   a: 720·s/W⁵ + (J·W/2)², W⁷ = 7200·s/J²,
/// at least three edges, W ≥ 2·q/v. Calmer motion can be known better.
[[nodiscard]] MotionError stochastic_optimum(const EdgeQuality& quality);

}  // namespace steadyrest::motion::offline
