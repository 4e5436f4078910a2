// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/kernel/signal/frame.hpp>

/// Contour-error estimates from the following errors alone, without a path.
///
/// e = command − actual, t the unit direction of travel, R the radius of the commanded arc:
///
///   nominal (norm of the tracking error)  Ed = √(e_x² + e_y² + e_z²): what the paper controls;
///       grows with the contour error but overstates it by 2R/Ed on arcs, without bound on lines
///   arc identity  ε = R − √(R² − Ed²) ≈ Ed²/(2R): for arcs with equal gains and no feed-forward in
///       steady state: exact, needs no gain
///   tangential  n = e − (e·t)·t: for lines and gentle curves; on an arc with lag it is Ed²/R,
///       about twice too large
///   corrected tangential  ε⃗ = −n − (e·t)²/2·κ⃗: for any curve while (e·t) ≪ R; κ⃗ is the
///       curvature vector at the commanded point
///
/// Sign of the arc identity: + towards the centre, the direction of lag; a negative radius gives
/// the mirrored sign. It cannot see an oversize (feed-forward, velocity-loop lag); the corrected
/// tangential estimate can. Limits: |e·t| < R/2, steady curvature over the lag.
///
/// Source: Jin, Zhang, Ding (Ed); Koren and Lo, CIRP Annals 40/1 (1991); Yeh and Hsu (tangential).
namespace steadyrest::contour::online {

/// Norm of the following errors of the first three axes that the frame holds.
[[nodiscard]] double nominal_error_mm(const kernel::signal::Frame& frame) noexcept;

/// R − √(R² − Ed²) with the sign of R; beyond Ed = |R| the identity has no solution and |R| is
/// returned.
[[nodiscard]] double arc_identity_mm(double nominal_error_mm, double radius_mm) noexcept;

/// n = e − (e·t)·t; t must be a unit vector.
[[nodiscard]] kernel::signal::Point tangential_error_mm(
    const kernel::signal::Point& error_mm, const kernel::signal::Point& tangent) noexcept;

/// The offset from the path to the actual point: −n − (e·t)²/2·κ⃗ with κ⃗ from the commanded point
/// towards the centre of curvature. Its product with κ⃗ is positive inside (undersize).
[[nodiscard]] kernel::signal::Point corrected_offset_mm(
    const kernel::signal::Point& error_mm, const kernel::signal::Point& tangent,
    const kernel::signal::Point& curvature_1_mm) noexcept;

/// Direction and curvature of the command, from its most recent points only.
///
/// Three points half of `span_mm` apart fix a circle; the turn of the chords over their mean
/// length is its curvature. Good to (span/R)²/24; at corners it shows the mean over the span.
class CommandedCurve {
 public:
  static constexpr std::size_t kPoints = 256;

  struct Output {
    bool valid = false;
    kernel::signal::Point tangent{};
    kernel::signal::Point curvature_1_mm{};
  };
  struct State {
    std::size_t count = 0;
    std::size_t next = 0;
    std::array<kernel::signal::Point, kPoints> point_mm{};
  };

  explicit CommandedCurve(double span_mm = 1.0) noexcept : span_mm_(span_mm) {}
  Output update(const kernel::signal::Point& command_mm) noexcept;
  void reset() noexcept { state_ = {}; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }

 private:
  double span_mm_;
  State state_;
};

}  // namespace steadyrest::contour::online
