// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/live/pace.hpp>

namespace steadyrest::rig {

/// Each wait takes one period, work none: a loop runs as fast as the computer can.
class EvenPace final : public live::Pace {
 public:
  explicit EvenPace(double period_s) : period_s_(period_s) {}
  Wake wait() noexcept override {
    now_s_ += period_s_;
    return {};
  }
  [[nodiscard]] double now_s() const noexcept override { return now_s_; }

 private:
  double period_s_;
  double now_s_ = 0.0;
};

}  // namespace steadyrest::rig
