// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::sim {

/// The machine's side of the axis offsets that the layer asks for.
///
/// Law: the offset moves towards the layer's by at most `step_mm` a period and stays within
/// ±`limit_mm`. When the layer's heartbeat is lost it freezes while the tool is in the cut and
/// ramps to 0 elsewhere; with `fade_mm` it ramps to 0 by that much a period wherever the tool is.
class AxisOffset {
 public:
  AxisOffset(double limit_mm, double step_mm, double fade_mm = 0.0) noexcept
      : limit_mm_(limit_mm), step_mm_(step_mm), fade_mm_(fade_mm) {}

  const kernel::signal::AxisValues& update(const kernel::signal::AxisValues& layer_mm, bool alive,
                                           bool in_cut) noexcept {
    if (!alive && in_cut && fade_mm_ == 0.0) {
      return value_mm_;
    }
    const double step_mm = !alive && fade_mm_ > 0.0 ? std::min(fade_mm_, step_mm_) : step_mm_;
    for (std::size_t i = 0; i < value_mm_.size(); ++i) {
      const double goal = alive && std::isfinite(layer_mm[i])
                              ? std::clamp(layer_mm[i], -limit_mm_, limit_mm_)
                              : 0.0;
      value_mm_[i] += std::clamp(goal - value_mm_[i], -step_mm, step_mm);
    }
    return value_mm_;
  }

 private:
  double limit_mm_;
  double step_mm_;
  double fade_mm_;
  kernel::signal::AxisValues value_mm_{};
};

}  // namespace steadyrest::sim
