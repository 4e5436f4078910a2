// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/estimator/m_over_t.hpp>
#include <steadyrest/motion/online/estimator/refusal.hpp>

namespace steadyrest::motion::online {
namespace {

std::int64_t count_after(const Edge& edge) noexcept {
  return edge.direction > 0 ? edge.line : edge.line - 1;
}

}  // namespace

kernel::outcome::Result<MOverT> MOverT::make(const Config& config) {
  if (!(config.count_mm > 0.0) || !(config.timeout_s > 0.0)) {
    return std::unexpected(refuse_config("count and timeout of M/T must be positive"));
  }
  if (config.edges_to_start < 1 || config.edges_to_start > 1000) {
    return std::unexpected(refuse_config("edges to start of M/T are not within 1…1000"));
  }
  return MOverT(config);
}

void MOverT::edge(const Edge& edge) noexcept {
  latest_ = edge;
  fresh_ = true;
}

// v = counts between the last edges of two ticks over the time between them (Ohmae 1982).
void MOverT::take_edge() noexcept {
  const double span_s = latest_.t_s - reference_.t_s;
  // Velocity needs a reference edge first; otherwise the time since standstill enters Δt.
  if (seen_ < config_.edges_to_start) {
    ++seen_;
  } else if (config_.zero_on_reversal && latest_.line == reference_.line) {
    velocity_mm_s_ = 0.0;
  } else if (span_s > 0.0) {
    const std::int64_t counts = count_after(latest_) - count_after(reference_);
    velocity_mm_s_ = config_.count_mm * static_cast<double>(counts) / span_s;
  }
  reference_ = latest_;
  fresh_ = false;
}

void MOverT::wait(double age_s) noexcept {
  if (seen_ == 0 || age_s >= config_.timeout_s) {
    seen_ = 0;
    velocity_mm_s_ = 0.0;
  } else if (age_s > 0.0) {
    // Without a new edge the axis has moved less than one count since the last one.
    const double most = config_.count_mm / age_s;
    velocity_mm_s_ = std::clamp(velocity_mm_s_, -most, most);
  }
}

Estimate MOverT::tick(const Tick& tick) noexcept {
  if (fresh_) {
    take_edge();
  } else {
    wait(tick.t_s - reference_.t_s);
  }
  Estimate out;
  out.t_s = tick.t_s;
  out.velocity_mm_s = velocity_mm_s_;
  const double middle_mm = 0.5 * (tick.low_mm + tick.high_mm);
  const double ahead_mm =
      reference_.position_mm + velocity_mm_s_ * std::max(0.0, tick.t_s - reference_.t_s);
  out.position_mm = seen_ == 0 ? middle_mm : std::clamp(ahead_mm, tick.low_mm, tick.high_mm);
  // The estimate is clamped to the cell, so it is off by the whole cell at most.
  out.position_bound_mm = tick.high_mm - tick.low_mm;
  const double period_s = tick.t_s - last_tick_s_;
  if (ticked_ && period_s > 0.0) {
    out.acceleration_mm_s2 = (velocity_mm_s_ - last_velocity_mm_s_) / period_s;
  }
  last_velocity_mm_s_ = velocity_mm_s_;
  last_tick_s_ = tick.t_s;
  ticked_ = true;
  return out;
}

}  // namespace steadyrest::motion::online
