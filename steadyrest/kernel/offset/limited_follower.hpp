// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace steadyrest::kernel::offset {

/// A place that follows another with the acceleration `a` at most.
///
/// It takes over the other's speed and closes the gap with what it can brake from. The other may
/// stop at once: the place then overshoots by a twentieth of S at most, S being the largest place
/// asked for in the last half second. Where the other needs no more than `a` and no speed above
/// √(0.1·a·S), the place is the other's, or that of one step before.
struct LimitedFollower {
  double asked_mm = 0.0;  ///< where the other was last
  double at_mm = 0.0;
  double speed_mm_s = 0.0;
  double size_mm = 0.0;  ///< of what was asked for lately

  /// The other is at `next_mm` now, `step_s` > 0 after the last call; `acceleration_mm_s2` > 0.
  void follow(double next_mm, double acceleration_mm_s2, double step_s) noexcept;
};

}  // namespace steadyrest::kernel::offset
