// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/online/revolution_spread.hpp>

// Anything that repeats with the spindle has the same value at the same angle one turn later.
// Values are taken at fixed angles, interpolated between samples, so that like is compared with
// like at modulated speed.
namespace steadyrest::chatter::online {

const RevolutionSpread::Output& RevolutionSpread::update(double value, double angle_rev) noexcept {
  const double step = angle_rev - angle_rev_;
  if (!started_ || !(step >= 0.0 && step <= 1.0 / kLeastSamples)) {
    reset();
    started_ = true;
  } else {
    const double grid = static_cast<double>(kPoints) * angle_rev;
    const double point = std::floor(grid);
    if (point > static_cast<double>(kPoints) * angle_rev_) {
      const double back = (grid - point) / (static_cast<double>(kPoints) * step);
      const double x = value + back * (value_ - value);
      const double turns = std::floor(point / static_cast<double>(kPoints));
      const auto i = std::min(
          static_cast<std::size_t>(point - turns * static_cast<double>(kPoints)), kPoints - 1);
      // Half: the difference of two independent values of energy E has the energy 2E.
      sum_change_ += 0.5 * (x - last_[i]) * (x - last_[i]);
      sum_ += x * x;
      last_[i] = x;
      seen_ = std::min(seen_ + 1, 2 * kPoints);
      if (++points_ == kPoints) {
        const auto n = static_cast<double>(kPoints);
        out_ = {
            .known = seen_ == 2 * kPoints, .changed_energy = sum_change_ / n, .energy = sum_ / n};
        points_ = 0;
        sum_change_ = sum_ = 0.0;
      }
    }
  }
  value_ = value;
  angle_rev_ = angle_rev;
  return out_;
}

}  // namespace steadyrest::chatter::online
