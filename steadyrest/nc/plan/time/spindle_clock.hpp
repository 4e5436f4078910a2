// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/machine/machine.hpp>

namespace steadyrest::nc::plan {

/// The spindle between two commands: it ramps at its largest acceleration, to its largest speed at
/// most.
class SpindleClock {
 public:
  explicit SpindleClock(const kernel::machine::Spindle& spindle)
      : acceleration_rev_s2_(spindle.acceleration_rev_s2), most_rev_s_(spindle.max_rev_s) {}

  void command(double speed_rev_s) noexcept {
    wanted_rev_s_ = std::clamp(speed_rev_s, -most_rev_s_, most_rev_s_);
  }
  void advance(double seconds) noexcept {
    if (ramps()) {
      const double reach = acceleration_rev_s2_ * seconds;
      speed_rev_s_ += std::clamp(wanted_rev_s_ - speed_rev_s_, -reach, reach);
    }
  }
  [[nodiscard]] double speed_rev_s() const noexcept { return speed_rev_s_; }
  [[nodiscard]] bool ramps() const noexcept { return speed_rev_s_ != wanted_rev_s_; }

  /// Time until it is within 5 % of the commanded speed.
  [[nodiscard]] double seconds_to_speed() const noexcept {
    const double at = wanted_rev_s_;
    const double band = kAtSpeed_ratio * std::abs(at);
    if (wanted_rev_s_ == 0.0 || std::abs(speed_rev_s_ - at) <= band) {
      return 0.0;
    }
    const double border = at > speed_rev_s_ ? at - band : at + band;
    return std::abs(border - speed_rev_s_) / acceleration_rev_s2_;
  }

 private:
  static constexpr double kAtSpeed_ratio = 0.05;
  double acceleration_rev_s2_;
  double most_rev_s_;
  double speed_rev_s_ = 0.0;
  double wanted_rev_s_ = 0.0;
};

}  // namespace steadyrest::nc::plan
