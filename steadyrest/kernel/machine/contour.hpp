// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace steadyrest::kernel::machine {

enum class ContourStrategy : std::uint8_t { contour_priority, feed_priority, combined };

/// What the contour room may do on this machine.
struct Contour {
  bool enabled = true;
  ContourStrategy strategy = ContourStrategy::feed_priority;
  double limit_mm = 0.010;  ///< ε_max
  double target_mm = 0.0;   ///< contour priority: errors below this count as equal
  double min_ratio =
      0.10;                ///< the layer never asks for less than this share of the programmed feed
  double max_ratio = 1.0;  ///< nor for more than this
  double weight_contour = 0.25;  ///< w1 of the combined objective
  double weight_feed = 0.75;     ///< w2
  double margin =
      0.05;  ///< share of the limit kept in reserve against what the model does not know

  friend bool operator==(const Contour&, const Contour&) = default;
};

}  // namespace steadyrest::kernel::machine
