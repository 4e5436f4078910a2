// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>

/// The zero-order solution in the frequency domain: a sketch of the lobes in closed form.
///
/// The directional matrix of the cut is averaged over a turn, (N/2π)·α. On the border, with G(iω)
/// the modes' response, det(I + Λ·α·G) = 0, i.e. Λ²·det α·det G + Λ·tr(αG) + 1 = 0, and
///   a = −(2π·Λ_R/N·Kt)·(1 + κ²), κ = Λ_I/Λ_R, ωT = π − 2·atan κ + 2πk, speed = 1/(N·T).
/// With several teeth always engaged it is accurate to a few percent; at small immersion it misses
/// the flip lobes altogether. Straight teeth, even pitch, no process damping. Source: Altintas and
/// Budak, CIRP Annals 44 (1995) 357.
namespace steadyrest::chatter::offline {

/// One chatter frequency on the border.
struct ZeroOrderPoint {
  double chatter_hz = 0.0;
  double depth_mm = 0.0;
  std::vector<double> speed_rev_s;  ///< of the lobes k = 0, 1, …
};

/// α_xx, α_xy, α_yx, α_yy over Kt.
[[nodiscard]] std::array<double, 4> zero_order_alpha(const Process& process) noexcept;

/// Points with a > 0 at `points` evenly spaced frequencies, at most two for each.
[[nodiscard]] std::vector<ZeroOrderPoint> zero_order_lobes(const Process& process, double from_hz,
                                                           double to_hz, std::size_t points,
                                                           std::size_t lobes);

/// The lowest border at one speed over frequencies up to 4 times the highest mode's; empty: none.
[[nodiscard]] std::optional<double> zero_order_limit_mm(const Process& process, double speed_rev_s);

}  // namespace steadyrest::chatter::offline
