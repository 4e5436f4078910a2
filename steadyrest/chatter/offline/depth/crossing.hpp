// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

/// Where a function of the depth crosses 0.
namespace steadyrest::chatter::offline {

struct DepthValue {
  double depth_mm;
  double value;
};

/// Between a depth with a value below 0 and a greater one with a value of 0 or above, to 1e-10 of
/// the depth. Illinois: regula falsi that halves the ordinate of an end that stays, so that both
/// ends close in; ln ρ is smooth except where another multiplier becomes dominant.
template <typename Function>
[[nodiscard]] double crossing(const Function& value, DepthValue below, DepthValue above) {
  constexpr double kBracket = 1e-10;   // of the depth
  constexpr double kOnBorder = 1e-12;  // of the value
  constexpr int kMostSteps = 60;
  constexpr int kBisect = 12;  // one step in this many bisects the bracket
  int stayed = 0;              // 1: the upper end, −1: the lower one
  for (int i = 0; i < kMostSteps && above.depth_mm - below.depth_mm > kBracket * above.depth_mm;
       ++i) {
    double middle =
        (below.depth_mm * above.value - above.depth_mm * below.value) / (above.value - below.value);
    if (!(middle > below.depth_mm && middle < above.depth_mm) || i % kBisect == kBisect - 1) {
      middle = 0.5 * (below.depth_mm + above.depth_mm);
    }
    const double f = value(middle);
    if (std::abs(f) < kOnBorder) {
      return middle;
    }
    if (f < 0.0) {
      above.value *= stayed > 0 ? 0.5 : 1.0;
      below = {middle, f};
      stayed = 1;
    } else {
      below.value *= stayed < 0 ? 0.5 : 1.0;
      above = {middle, f};
      stayed = -1;
    }
  }
  return 0.5 * (below.depth_mm + above.depth_mm);
}

}  // namespace steadyrest::chatter::offline
