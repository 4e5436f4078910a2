// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/plan/time/setpoint.hpp>

namespace steadyrest::nc::plan {

inline constexpr double kEndTolerance_mm = 1e-10;  ///< anything nearer is at a segment's end

/// Speed that a segment asks for under the overrides, capped at its limit.
[[nodiscard]] double target_mm_s(const SegmentPlan& p, const Overrides& overrides) noexcept;

/// The acceleration-limited point that runs ahead of the setpoint.
struct Lead {
  std::size_t segment = 0;
  double distance_mm = 0.0;  ///< along the segment
  double speed_mm_s = 0.0;
};

/// What binds the lead over the next `blocks` segments, and the speed that they permit now. See
/// interpolator.hpp for the law. The constructor allocates all memory.
class LookAhead {
 public:
  struct Bound {
    double speed_mm_s = 0.0;
    double braking_mm_s2 = 0.0;  ///< the strongest of the segments that the cycle touches
  };

  LookAhead(std::size_t blocks, double period_s, double jerk_time_s);

  /// Plans from segment `from` on, backwards over the window.
  void plan_all(const PathWindow& path, std::size_t from, const Overrides& overrides) noexcept;
  /// The window slides: replans only what the new end changes.
  void plan_more(const PathWindow& path, std::size_t from, const Overrides& overrides) noexcept;
  /// The spindle has left the speed that feeds per revolution were planned with.
  [[nodiscard]] bool outdated(double spindle_rev_s) const noexcept;
  /// Largest speed after this cycle, at most `want`, that keeps all limits ahead when the speed is
  /// held for `plateau_s` before it falls.
  [[nodiscard]] Bound bound(const PathWindow& path, const Lead& lead, double want_mm_s,
                            double plateau_s) const noexcept;

  [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }

 private:
  /// What binds the lead before the end of a segment, x = distance to that end:
  /// v² ≤ square + 2a·max(0, x − hold) and, over cap_reach and braking before it, v² ≤ cap_square.
  struct Limit {
    double square = 0.0;
    double hold_mm = 0.0;
    double cap_square = std::numeric_limits<double>::infinity();
    double cap_reach_mm = 0.0;
  };

  bool plan_junction(const PathWindow& path, std::size_t i, const Overrides& overrides) noexcept;

  std::size_t blocks_;
  double period_s_;
  double jerk_time_s_;
  std::vector<Limit> limits_;  ///< at the end of segment i
  std::size_t mask_;
  std::size_t end_ = 0;
  bool follows_spindle_ = false;
  double planned_spindle_rev_s_ = 0.0;
};

}  // namespace steadyrest::nc::plan
