// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/adapters/linuxcnc/offset_course.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

constexpr double kReturn_s = 1.0;  ///< of the control's units

}  // namespace

void OffsetCourse::apply(Pins& pins, bool enabled, std::uint64_t tick, double period_s) noexcept {
  const double dt_s = static_cast<double>(std::max<std::uint64_t>(tick - tick_, 1)) * period_s;
  const bool follows = begun_ && tick > tick_ && enabled;
  tick_ = tick;
  begun_ = true;
  if (!enabled) {
    was_off_ = true;
    given_ = {};
    asked_ = {};
    pins.offset = {};
    pins.path_offset = {};
    return;
  }
  bool back = true;
  for (std::size_t a = 0; a < acceleration_.size(); ++a) {
    if (was_off_) {
      const double step = kReturn_s * dt_s;
      given_[a] += std::clamp(pins.offset[a] - given_[a], -step, step);
      back = back && given_[a] == pins.offset[a];
      pins.offset[a] = given_[a];
    }
    const double asked = pins.offset[a] + pins.path_offset[a];
    const double speed = follows ? (asked - asked_[a]) / dt_s : 0.0;
    asked_[a] = asked;
    if (acceleration_[a] > 0.0) {
      pins.path_offset[a] += 0.5 * speed * std::abs(speed) / acceleration_[a];
    }
  }
  was_off_ = was_off_ && !back;
}

}  // namespace steadyrest::adapters::linuxcnc
