// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/adapters/linuxcnc/offset_course.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

constexpr double kUsedShare = 0.9;
constexpr double kSlack = 1.0 + 1e-9;      ///< for rounding
constexpr std::uint64_t kLongestGap = 20;  ///< cycles

}  // namespace

OffsetCourse::OffsetCourse(const Config& config) noexcept
    : acceleration_(config.acceleration), slew_(config.slew), back_(config.back) {
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    const double now = config.in_force[a];
    axis_[a] = {.sum = {.asked_mm = now, .at_mm = now}, .given = now};
  }
}

void OffsetCourse::apply(Pins& pins, bool enabled, std::uint64_t tick, double period_s) noexcept {
  const std::uint64_t cycles = begun_ && tick > tick_ ? std::min(tick - tick_, kLongestGap) : 1;
  const double dt_s = static_cast<double>(cycles) * period_s;
  tick_ = tick;
  begun_ = true;
  if (!enabled) {
    was_off_ = true;
    axis_ = {};
    pins.offset = {};
    pins.path_offset = {};
    return;
  }
  bool back = true;
  const double step = (was_off_ ? back_ : slew_) * dt_s;
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    const double away = pins.offset[a] - axis_[a].given;
    axis_[a].given = std::abs(away) <= step * kSlack ? pins.offset[a]
                                                     : axis_[a].given + std::copysign(step, away);
    back = back && axis_[a].given == pins.offset[a];
    pins.offset[a] = axis_[a].given;
    if (acceleration_[a] > 0.0) {
      const double asked = pins.offset[a] + pins.path_offset[a];
      pins.path_offset[a] = target(a, asked, dt_s) - pins.offset[a];
    }
  }
  was_off_ = was_off_ && !back;
}

double OffsetCourse::target(std::size_t axis, double asked, double dt_s) noexcept {
  kernel::offset::LimitedFollower& sum = axis_[axis].sum;
  sum.follow(asked, kUsedShare * acceleration_[axis], dt_s);
  return sum.at_mm + 0.5 * sum.speed_mm_s * std::abs(sum.speed_mm_s) / acceleration_[axis];
}

}  // namespace steadyrest::adapters::linuxcnc
