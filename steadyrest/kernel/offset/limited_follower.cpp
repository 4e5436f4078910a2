// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/offset/limited_follower.hpp>

namespace steadyrest::kernel::offset {
namespace {

constexpr double kOvershoot = 0.05;
constexpr double kForgets_s = 0.5;

}  // namespace

void LimitedFollower::follow(double next, double acceleration, double step_s) noexcept {
  const double step = acceleration * step_s;
  const double away = next - at;
  const double asked_speed = (next - asked) / step_s;
  // The speed that closes the gap in this step, but never more than it can brake from.
  const double closing =
      std::copysign(std::min(std::abs(away - asked_speed * step_s) / step_s,
                             std::sqrt(2.0 * acceleration * std::abs(away) + step * step) - step),
                    away);
  // The other may stop at once: the speed stays within what overshoots by a share of its size.
  size = std::max(std::abs(next), size * (1.0 - std::min(1.0, step_s / kForgets_s)));
  const double brakable = std::sqrt(2.0 * acceleration * (std::abs(away) + kOvershoot * size));
  const double wish = std::clamp(asked_speed + closing, -brakable, brakable);
  asked = next;
  speed += std::clamp(wish - speed, -step, step);
  at += speed * step_s;
}

}  // namespace steadyrest::kernel::offset
