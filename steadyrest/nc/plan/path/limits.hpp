// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/machine/control.hpp>
#include <steadyrest/kernel/signal/path.hpp>

/// What the machine's axes permit along a path.
///
/// Symbols: t = direction (axis values per mm of path), V_i, A_i, J_i = limits of axis i.
///   line      v ≤ min V_i/|t_i|,  a ≤ min A_i/|t_i|
///   arc       g_i = √(1 − n_i²) is the largest share of axis i in the plane with normal n;
///             a_plane = min A_i/g_i;  v ≤ √(κ_n·a_plane·R_eff), R_eff = R/cos²(helix angle) of the
///             tightest radius;  the tangential part gets the rest: a_t = √(a_plane² −
///             (v²/R_eff)²)
///   kink      the share of an axis's acceleration that a corner takes when it is passed at v in
///   one
///             interpolator period T and the next segment's ramp a begins in the same period:
///             k = max |Δt_i|·(v/T + a)/A_i
///   junction  jump: v·|Δt_i| ≤ A_i·T in one period;  deviation: v² ≤ a·δ·sin β/(1 − sin β), β =
///   half the angle between the legs, the
///             speed at which an arc that stays within δ of the corner would be possible; facets:
///             v² ≤ min A_i/|Δt_i|·ℓ, ℓ = mean length of the two segments, the centripetal limit of
///             the curve that the corners approximate. v_junction = min(facets, max(jump,
///             deviation)).
/// With δ = 0 no axis ever jumps by more than one period of its acceleration. Sources: the junction
/// deviation of the Grbl firmware (Jeon 2011) for the deviation law; κ_n = √3/2 is the share that
/// LinuxCNC gives to the centripetal part (documented in its trajectory planner); its
/// ARC_BLEND_KINK_RATIO for the kink.
namespace steadyrest::nc::plan {

struct SpeedLimits {
  double speed_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
};

/// What the axes permit together in a plane: A_i, V_i, J_i divided by g_i.
struct PlaneLimits {
  double acceleration_mm_s2 = 0.0;  ///< a_plane
  double speed_mm_s = 0.0;
  double jerk_mm_s3 = 0.0;
};

/// Next to an arc a kink counts double: half of an arc's acceleration turns it.
inline constexpr double kKinkOfArcs = 2.0;

/// The limits of a machine in the order of its axes; axes it does not have are unlimited.
class PathLimits {
 public:
  PathLimits(std::span<const kernel::machine::Axis> axes, const kernel::machine::Control& control);

  [[nodiscard]] SpeedLimits line(const kernel::signal::AxisValues& direction) const noexcept;
  /// `segment` must be an arc with its length set.
  [[nodiscard]] SpeedLimits arc(const kernel::signal::PathSegment& segment) const noexcept;
  /// In the plane with unit normal `normal`.
  [[nodiscard]] PlaneLimits plane(const kernel::signal::Point& normal) const noexcept;
  /// What arc() gives for a plane circle, such as a corner's.
  [[nodiscard]] SpeedLimits circle(double radius_mm, const PlaneLimits& plane) const noexcept;
  /// Speed at which the directions `before` → `after` may follow one another on the exact path.
  [[nodiscard]] double junction_mm_s(const kernel::signal::AxisValues& before,
                                     const kernel::signal::AxisValues& after,
                                     double length_before_mm,
                                     double length_after_mm) const noexcept;
  /// k at the feed `speed_mm_s`; `ramp_mm_s2` is that of the segment after.
  [[nodiscard]] double kink(const kernel::signal::AxisValues& before,
                            const kernel::signal::AxisValues& after, double speed_mm_s,
                            double ramp_mm_s2) const noexcept;
  /// The control judges corners by their kink (junction_share below 1), as LinuxCNC does.
  [[nodiscard]] bool has_kinks() const noexcept { return junction_share_ < 1.0; }
  [[nodiscard]] double junction_share() const noexcept { return junction_share_; }
  /// Averaging time of the jerk filter: max A_i/J_i, 0 without a jerk limit.
  [[nodiscard]] double jerk_time_s() const noexcept { return jerk_time_s_; }
  [[nodiscard]] double centripetal_share() const noexcept { return centripetal_share_; }

 private:
  std::size_t axes_ = 3;  ///< at least X, Y, Z; the others do not move
  kernel::signal::AxisValues speed_{};
  kernel::signal::AxisValues acceleration_{};
  kernel::signal::AxisValues jerk_{};
  double path_acceleration_mm_s2_;
  double period_s_;
  double deviation_mm_;
  double centripetal_share_;
  double junction_share_;
  double jerk_time_s_ = 0.0;
};

}  // namespace steadyrest::nc::plan
