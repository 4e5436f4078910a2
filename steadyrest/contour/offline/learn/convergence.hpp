// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/contour/offline/predict/model_run.hpp>

namespace steadyrest::contour::offline {

/// How far an axis may be from its model.
struct Uncertainty {
  double gain_share = 0.05;     ///< of the servo gain, both ways
  double velocity_lag_s = 0.0;  ///< more than the model's; 0: 0.2/k
  double feed_forward = 0.1;    ///< more than the model's
};

/// The width of the Gaussian whose low-pass has −3 dB at this frequency, s.
[[nodiscard]] double width_s(double cut_off_hz) noexcept;

/// The largest factor by which learning from one part multiplies an error that the model does not
/// know, over all frequencies, axes and machines within the uncertainty; below 1 it converges.
///
/// Law. With the axis G = (k + a·s)/(τs² + s + k), its model Ĝ, the displacement's law u = K·r,
/// K = Q·L, Q = exp(−ω²σ²/2), L = 1 + ĝ·s, ĝ = (1 − â)/k̂, and r = w + (Ĝ − G)·u the error beyond
/// the model, the next part has u⁺ = K·w + K·(Ĝ − G)·u. So the factor is
///   max |K(jω)·(Ĝ(jω) − G(jω))|,   ω from k̂/100 to where Q < 10⁻³.
/// Taken at the corners of the uncertainty and half-way. Where L = 1/Ĝ (no feed-forward, no lag) it
/// is |Q·(1 − G/Ĝ)|. A gain off by the share u alone gives less than u at any cut-off; a lag τ
/// gives less than 1 for kτ ≤ 0.5; a feed-forward gives a·ω/k, which only the cut-off bounds.
[[nodiscard]] double convergence(const ServoModels& model, const Uncertainty& uncertainty,
                                 double cut_off_hz) noexcept;

}  // namespace steadyrest::contour::offline
