// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/outcome/result.hpp>

/// Contour error of a circle in steady state, in closed form.
///
/// Axes with equal servo gain k, velocity feed-forward weight a and a first-order lag τ of the
/// velocity loop follow a circle of radius R at path speed v; ω = v/R. Each axis has the transfer
/// function (from commanded to actual position)
///
///     G(s) = (k + a·s) / (τ·s² + s + k)
///
///     |G(jω)|² = (k² + a²ω²) / ((k − τω²)² + ω²)
///     contour error   ε  = R·(1 − |G|)      > 0: the circle is too small; < 0: too large
///     tracking error  Ed = R·|1 − G|        (norm of the following errors)
///
/// With a = 0, τ = 0 and q = v/(R·k): ε = R(1 − 1/√(1+q²)), Ed = R·q/√(1+q²), hence the identity
/// ε = R − √(R² − Ed²). For small q: ε ≈ (1 − a² − 2kτ)·v²/(2Rk²).
///
/// Ends where the axes saturate, where the gains differ (the circle becomes an ellipse) and during
/// the run-in of some 3/k. Source: Koren, Cross-coupled biaxial computer control, ASME JDSMC 102
/// (1980) 265; the second-order form follows from the transfer function above.
namespace steadyrest::contour::offline {

struct Servo {
  double gain_1_s = 50.0;       ///< k, > 0
  double feed_forward = 0.0;    ///< a, 0 … 1.5
  double velocity_lag_s = 0.0;  ///< τ, ≥ 0
};

struct CircleErrors {
  double contour_error_mm = 0.0;   ///< ε with its sign
  double tracking_error_mm = 0.0;  ///< Ed
};

/// The largest speed that keeps a limit, and the errors there. speed_mm_s is infinite when no speed
/// exceeds the limit (full feed-forward without lag).
struct CircleLimit {
  double speed_mm_s = 0.0;
  CircleErrors errors;  ///< at that speed; when it is infinite, their limits
};

/// Errors at one speed. Refused unless R, k > 0, v, τ ≥ 0, 0 ≤ a ≤ 1.5 and all are finite.
[[nodiscard]] kernel::outcome::Result<CircleErrors> circle_errors(const Servo& servo,
                                                                  double radius_mm,
                                                                  double speed_mm_s);

/// The largest v such that |ε| ≤ max_error_mm there and at every lower speed. With a = 0 and τ = 0:
/// v = k·R·√((R/(R − ε))² − 1). Refused as above, and unless 0 < max_error_mm < R·(1 − 10⁻⁶).
[[nodiscard]] kernel::outcome::Result<CircleLimit> circle_limit(const Servo& servo,
                                                                double radius_mm,
                                                                double max_error_mm);

}  // namespace steadyrest::contour::offline
