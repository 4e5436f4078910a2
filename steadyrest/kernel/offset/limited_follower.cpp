// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/offset/limited_follower.hpp>

namespace steadyrest::kernel::offset {
namespace {

constexpr double kOvershoot = 0.05;
constexpr double kForgets_s = 0.5;

}  // namespace

void LimitedFollower::follow(double next_mm, double acceleration_mm_s2, double step_s) noexcept {
  const double step_mm_s = acceleration_mm_s2 * step_s;
  const double away_mm = next_mm - at_mm;
  const double asked_mm_s = (next_mm - asked_mm) / step_s;
  // The speed that closes the gap in this step, but never more than it can brake from.
  const double braking_mm_s =
      std::sqrt(2.0 * acceleration_mm_s2 * std::abs(away_mm) + step_mm_s * step_mm_s) - step_mm_s;
  const double closing_mm_s = std::copysign(
      std::min(std::abs(away_mm - asked_mm_s * step_s) / step_s, braking_mm_s), away_mm);
  // The other may stop at once: the speed stays within what overshoots by a share of its size.
  size_mm = std::max(std::abs(next_mm), size_mm * (1.0 - std::min(1.0, step_s / kForgets_s)));
  const double most_mm_s =
      std::sqrt(2.0 * acceleration_mm_s2 * (std::abs(away_mm) + kOvershoot * size_mm));
  const double wish_mm_s = std::clamp(asked_mm_s + closing_mm_s, -most_mm_s, most_mm_s);
  asked_mm = next_mm;
  speed_mm_s += std::clamp(wish_mm_s - speed_mm_s, -step_mm_s, step_mm_s);
  at_mm += speed_mm_s * step_s;
}

}  // namespace steadyrest::kernel::offset
