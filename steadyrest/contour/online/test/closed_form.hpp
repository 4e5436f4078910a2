// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <steadyrest/contour/online/test/closed_loop.hpp>

/// The circle's closed form, for the tests of the feed governor.
namespace steadyrest::contour::online::test {

/// ε of the closed form: |G|² = (k² + a²ω²)/(k² + ω²), ω = v/R.
inline double closed_form_mm(double radius, double speed, double gain, double feed_forward) {
  const double w = speed / radius;
  return radius * (1.0 - std::sqrt((gain * gain + feed_forward * feed_forward * w * w) /
                                   (gain * gain + w * w)));
}

/// The largest step of the override that keeps the limit in steady state.
inline double largest_step(const Machine& machine, double radius, double feed_mm_s,
                           double limit_mm) {
  double best = machine.contour.min_ratio;
  for (const double ratio : machine.feed_override.ratio) {
    if (ratio >= machine.contour.min_ratio && ratio <= machine.contour.max_ratio &&
        closed_form_mm(radius, ratio * feed_mm_s, machine.axes[0].servo_gain_1_s,
                       machine.axes[0].feed_forward) <= limit_mm) {
      best = std::max(best, ratio);
    }
  }
  return best;
}

}  // namespace steadyrest::contour::online::test
