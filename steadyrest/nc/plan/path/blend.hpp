// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>

/// How LinuxCNC (2.9) goes round a corner in continuous mode: by an arc, by letting the next
/// segment begin while the last one brakes, or sharply at the speed that the corner permits.
///
/// Symbols: φ = turning angle, ℓ = a side's length before its corners were rounded, L = what is
/// left of it, R = an arc's radius, α = an arc's sweep, P = the program's tolerance (0 = none),
/// v = the most that a side's feed and limits permit, a = acceleration in the corner's plane,
/// a_n = κ_n·a.
///   tolerance   δ = min(P, ℓ/4) over both sides
///   room        line: min(L, ℓ/2);  arc: ψ·R with ψ = ⅔α before the corner, ⅓α after it, at most
///               π/2. An arc that bends as the corner does is taken by its chord: ψ ≤ (π − φ)/2,
///               room R·sin(ψ/4), and the corner counts as φ + ψ/2
///   radius      d = min(room, room', δ·sin(φ/2)/(1 − cos(φ/2))), R_g = d/tan(φ/2), goal g = max(v,
///   v'),
///               u = min(g, √(a_n·R_g)), R = max(u²/a_n, min(2·u·min(u, √(a·d))/(a·φ), R_g))
///   overlap     both sides ramp at once; speeds w = min(v, √(A·L), A·t, 2·√(A·P/cos θ)), with A
///   the
///               ramps, t = min(L/w, L'/w', max(w/A, w'/A')), 2θ the angle between the sides'
///               directions (for an arc: towards its centre); sin θ·(w + w')/2 of it is kept
///   choice      the fastest of arc, sharp corner and half of the overlap
/// Source: measured on 2.9.0~pre1 (README); the names are those of its manual, "Trajectory
/// Control".
namespace steadyrest::nc::plan {

/// One side of a corner.
struct BlendSide {
  bool arc = false;
  bool convex = false;  ///< an arc that bends as the corner does
  double radius_mm = 0.0;
  double sweep_rad = 0.0;
  double length_mm = 0.0;   ///< L
  double nominal_mm = 0.0;  ///< ℓ
  double program_tolerance_mm = 0.0;
  double speed_mm_s = 0.0;       ///< v
  double ramp_mm_s2 = 0.0;       ///< along the side, before shares
  kernel::signal::Point bend{};  ///< unit vector: a line's direction, an arc's to its centre

  /// A: half of an arc's acceleration turns it.
  [[nodiscard]] double overlap_mm_s2(double share) const noexcept {
    return share * ramp_mm_s2 * (arc ? 0.5 : 1.0);
  }
};

/// The arc that rounds the corner.
struct BlendArc {
  double radius_mm = 0.0;
  double tolerance_mm = 0.0;
  double room_before_mm = 0.0;
  double room_after_mm = 0.0;
  double speed_mm_s = 0.0;
};
[[nodiscard]] BlendArc blend_arc(const BlendSide& before, const BlendSide& after, double turn_rad,
                                 const PlaneLimits& plane, double centripetal_share) noexcept;

/// Both sides' motions overlapping.
struct Overlap {
  double before_mm_s = 0.0;  ///< where the next side begins
  double after_mm_s = 0.0;   ///< where the last one ends
  double kept_mm_s = 0.0;    ///< along the bisector
};
/// `ramp_share`: of both ramps; `length_share`: of both lengths.
[[nodiscard]] Overlap overlap(const BlendSide& before, const BlendSide& after, double ramp_share,
                              double length_share) noexcept;

}  // namespace steadyrest::nc::plan
