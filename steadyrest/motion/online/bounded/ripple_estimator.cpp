// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <steadyrest/motion/online/bounded/ripple_estimator.hpp>

namespace steadyrest::motion::online {

kernel::outcome::Result<RippleEstimator> RippleEstimator::make(const Config& config) {
  auto smooth = MotionEstimator::make(config);
  if (!smooth) {
    return std::unexpected(smooth.error());
  }
  return RippleEstimator(std::move(*smooth), config.count_mm);
}

void RippleEstimator::edge(const Edge& edge) noexcept {
  if (!std::isfinite(edge.t_s)) {
    smooth_.edge(edge);  // it counts what is not used
    return;
  }
  ripple_.edge(edge.t_s, edge.line, edge.direction, edge.lost != 0);
  Edge moved = edge;
  moved.position_mm -= count_mm_ * ripple_.at_line(edge.line);
  smooth_.edge(moved);
}

Estimate RippleEstimator::tick(const Tick& tick) noexcept {
  Tick moved = tick;
  moved.low_mm -= count_mm_ * ripple_.at_line(tick.count);
  moved.high_mm -= count_mm_ * ripple_.at_line(tick.count + 1);
  Estimate out = smooth_.tick(moved);
  const double line_mm = static_cast<double>(tick.count) * count_mm_;
  const double origin_mm = tick.low_mm - line_mm;
  const double y = (out.position_mm - origin_mm) / count_mm_;
  const Ripple::Value near = ripple_.at(y);
  const Ripple::Value here = ripple_.at(y + near.counts);
  out.position_mm += count_mm_ * here.counts;
  out.velocity_mm_s /= 1.0 - here.slope;
  out.position_bound_mm += count_mm_ * std::abs(here.counts);
  out.velocity_bound_mm_s = kNoBound;
  out.acceleration_bound_mm_s2 = kNoBound;
  ripple_.learn();
  return out;
}

}  // namespace steadyrest::motion::online
