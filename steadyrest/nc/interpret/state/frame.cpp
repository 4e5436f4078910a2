// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <numbers>

#include <steadyrest/nc/interpret/state/frame.hpp>

namespace steadyrest::nc::interpret {

// Counter-clockwise about +Z, as G10 L2 R and ROT Z turn; only X and Y change.
Axes turned(const Axes& axes, double angle_deg) noexcept {
  if (angle_deg == 0.0) {
    return axes;
  }
  const double angle = angle_deg * (std::numbers::pi / 180.0);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Axes out = axes;
  out[0] = c * axes[0] - s * axes[1];
  out[1] = s * axes[0] + c * axes[1];
  return out;
}

// machine = R·work + offset (move.hpp).
Axes machine_of(const Move& move, const Axes& work) noexcept {
  Axes out = turned(work, move.rotation_deg);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] += move.offset[i];
  }
  return out;
}

}  // namespace steadyrest::nc::interpret
