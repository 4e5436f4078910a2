// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <numbers>

#include <steadyrest/nc/interpret/state/frame.hpp>

namespace steadyrest::nc::interpret {
namespace {

struct Turn {
  double c;
  double s;
};

// Quarter turns are exact: a bolt pattern turned by 90° stays on its grid.
Turn turn_of(double angle_deg) noexcept {
  const double quarters = angle_deg / 90.0;
  if (quarters == std::floor(quarters)) {
    const auto n = static_cast<int>(std::fmod(quarters, 4.0) + 4.0) % 4;
    return n == 0   ? Turn{.c = 1.0, .s = 0.0}
           : n == 1 ? Turn{.c = 0.0, .s = 1.0}
           : n == 2 ? Turn{.c = -1.0, .s = 0.0}
                    : Turn{.c = 0.0, .s = -1.0};
  }
  const double angle = angle_deg * (std::numbers::pi / 180.0);
  return {.c = std::cos(angle), .s = std::sin(angle)};
}

void turn_about(double centre_1, double centre_2, const Turn& by, double& first,
                double& second) noexcept {
  const double a = first - centre_1;
  const double b = second - centre_2;
  first = centre_1 + by.c * a - by.s * b;
  second = centre_2 + by.s * a + by.c * b;
}

}  // namespace

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

// q = centre + scale·(m − centre) with m = 2·mirror − word where the axis is mirrored.
void TextFrame::compose() noexcept {
  for (std::size_t i = 0; i < factor.size(); ++i) {
    const bool mirror = ((mirrored >> i) & 1U) != 0;
    const double from_mirror = mirror ? 2.0 * mirror_mm[i] : 0.0;
    factor[i] = scale[i] * (mirror ? -1.0 : 1.0);
    shift_mm[i] = scale_centre_mm[i] * (1.0 - scale[i]) + scale[i] * from_mirror;
  }
  on = scaled || rotated || mirrored != 0;
}

Axes TextFrame::to_work(const Axes& words) const noexcept {
  Axes out = words;
  for (std::size_t i = 0; i < factor.size(); ++i) {
    out[i] = factor[i] * words[i] + shift_mm[i];
  }
  if (rotated) {
    turn_about(centre_mm[0], centre_mm[1], turn_of(angle_deg), out[first], out[second]);
  }
  return out;
}

Axes TextFrame::to_words(const Axes& work) const noexcept {
  Axes out = work;
  if (rotated) {
    turn_about(centre_mm[0], centre_mm[1], turn_of(-angle_deg), out[first], out[second]);
  }
  for (std::size_t i = 0; i < factor.size(); ++i) {
    out[i] = (out[i] - shift_mm[i]) / factor[i];
  }
  return out;
}

std::array<double, 3> TextFrame::distance(const std::array<double, 3>& words) const noexcept {
  std::array<double, 3> out = words;
  for (std::size_t i = 0; i < factor.size(); ++i) {
    out[i] *= factor[i];
  }
  if (rotated) {
    turn_about(0.0, 0.0, turn_of(angle_deg), out[first], out[second]);
  }
  return out;
}

}  // namespace steadyrest::nc::interpret
