// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace steadyrest::adapters::linuxcnc::testing {

/// LinuxCNC 2.9's planner of external offsets (simple_tp), written from its documented law.
class OffsetPlanner {
 public:
  OffsetPlanner(double speed, double acceleration, double period_s = 0.001)
      : speed_(speed), acceleration_(acceleration), period_s_(period_s) {}
  double update(double target) {
    const double dv = acceleration_ * period_s_;
    const double error = target - at_;
    double wish = 0.0;
    if (std::abs(error) > dv * period_s_ * 0.001) {
      wish = std::copysign(std::sqrt(2.0 * acceleration_ * std::abs(error) + dv * dv) - dv, error);
    }
    wish = std::clamp(wish, -speed_, speed_);
    now_ += std::clamp(wish - now_, -dv, dv);
    at_ += now_ * period_s_;
    return at_;
  }

 private:
  double speed_;
  double acceleration_;
  double period_s_;
  double now_ = 0.0;
  double at_ = 0.0;
};

}  // namespace steadyrest::adapters::linuxcnc::testing
