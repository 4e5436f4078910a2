// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <steadyrest/contour/online/servo_model.hpp>

namespace steadyrest::contour::online {

/// Exact step of one axis over h: e = c − x and w = ẋ from the commanded mean velocity and its
/// change.
///   ė = ċ − w;  τ·ẇ + w = k·e + a·ċ;  ċ(t) = mean + change·(t/h − ½)
struct AxisStep {
  double ee = 1.0, ew = 0.0, we = 0.0, ww = 0.0;
  double e_mean = 0.0, w_mean = 0.0, e_change = 0.0, w_change = 0.0;

  [[nodiscard]] static AxisStep of(const AxisModel& model, double h_s) noexcept;
};

/// Following error and velocity of the first three axes.
struct ServoState {
  std::array<double, 3> error_mm{};
  std::array<double, 3> velocity_mm_s{};
};

}  // namespace steadyrest::contour::online
