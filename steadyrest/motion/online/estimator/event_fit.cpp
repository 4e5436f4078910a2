// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <steadyrest/motion/online/estimator/event_fit.hpp>
#include <steadyrest/motion/online/estimator/refusal.hpp>

namespace steadyrest::motion::online {
namespace {

// Pivots of the normal equations below this share of the largest one mean repeated stamps.
constexpr double kSingularShare = 1e-13;

}  // namespace

kernel::outcome::Result<EventFit> EventFit::make(const Config& config) {
  if (!(config.count_mm > 0.0) || !(config.timeout_s > 0.0) || !(config.window_s >= 0.0) ||
      !(config.line_error_counts >= 0.0)) {
    return std::unexpected(
        refuse_config("count, timeout, window or line error of the fit is negative or zero"));
  }
  if (config.degree < 1 || config.degree > 3) {
    return std::unexpected(refuse_config("degree of the fit is not within 1…3"));
  }
  if (config.edges < config.degree + 1 || config.edges > kMaxEdges || config.skip >= kMaxEdges ||
      config.edges * (config.skip + 1) > kMaxEdges) {
    return std::unexpected(
        refuse_config("edges of the fit are not within degree + 1…512, the skipped ones included"));
  }
  return EventFit(config);
}

void EventFit::edge(const Edge& edge) noexcept {
  if (known_ > 0 && !(edge.t_s >= back(0).t_s)) {
    known_ = 0;  // the clock was set back: the past is useless
  }
  newest_ = (newest_ + 1) % events_.size();
  events_[newest_] = {edge.t_s, edge.position_mm};
  known_ = std::min(known_ + 1, events_.size());
}

std::size_t EventFit::chosen(double now_s) const noexcept {
  const std::size_t stride = config_.skip + 1;
  const std::size_t most = std::min(config_.edges, (known_ + stride - 1) / stride);
  if (config_.window_s <= 0.0) {
    return most;
  }
  std::size_t count = std::min(most, config_.degree + 1);
  while (count < most && now_s - back(count * stride).t_s <= config_.window_s) {
    ++count;
  }
  return count;
}

/// False where the stamps do not support this degree.
template <int kTerms>
bool EventFit::fit(std::size_t count, double now_s, Estimate& out) const noexcept {
  const std::size_t stride = config_.skip + 1;
  const Event& last = back(0);
  const double oldest_s = back((count - 1) * stride).t_s;
  const double span_s = last.t_s - oldest_s;
  if (count < kTerms || !(span_s > 0.0)) {
    return false;
  }
  std::array<double, 2 * kTerms - 1> moments{};  // Σ u^i
  Eigen::Matrix<double, kTerms, 1> right = Eigen::Matrix<double, kTerms, 1>::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Event& event = back(i * stride);
    // Time scaled to 0 … 1 and position relative to the newest edge: powers of seconds would spoil
    // the normal equations.
    const double u = (event.t_s - oldest_s) / span_s;
    const double x = event.x_mm - last.x_mm;
    double power = 1.0;
    for (int m = 0; m < 2 * kTerms - 1; ++m) {
      moments[static_cast<std::size_t>(m)] += power;
      if (m < kTerms) {
        right(m) += power * x;
      }
      power *= u;
    }
  }
  Eigen::Matrix<double, kTerms, kTerms> normal;
  for (int i = 0; i < kTerms; ++i) {
    for (int j = 0; j < kTerms; ++j) {
      normal(i, j) = moments[static_cast<std::size_t>(i) + static_cast<std::size_t>(j)];
    }
  }
  const Eigen::LDLT<Eigen::Matrix<double, kTerms, kTerms>> factors(normal);
  const auto pivots = factors.vectorD();
  if (!(pivots.minCoeff() > kSingularShare * pivots.maxCoeff())) {
    return false;
  }
  const Eigen::Matrix<double, kTerms, 1> b = factors.solve(right);
  const double u = (now_s - oldest_s) / span_s;
  double x = 0.0;
  double v = 0.0;
  double a = 0.0;
  for (int i = kTerms - 1; i >= 0; --i) {  // Horner, with both derivatives
    a = a * u + 2.0 * v;
    v = v * u + x;
    x = x * u + b(i);
  }
  out.position_mm = last.x_mm + x;
  out.velocity_mm_s = v / span_s;
  out.acceleration_mm_s2 = a / (span_s * span_s);
  return true;
}

void EventFit::extrapolate(double now_s, Estimate& out) const noexcept {
  const std::size_t count = chosen(now_s);
  const bool done = (config_.degree >= 3 && fit<4>(count, now_s, out)) ||
                    (config_.degree >= 2 && fit<3>(count, now_s, out)) || fit<2>(count, now_s, out);
  if (!done) {
    out.position_mm = back(0).x_mm;
  }
}

void EventFit::clip(const Tick& tick, Estimate& out) const noexcept {
  out.position_mm = std::clamp(out.position_mm, tick.low_mm, tick.high_mm);
  // Whatever the fit says, the axis has not left its cell since the last edge, which caps the mean
  // velocity since then. This matters at starts, stops and reversals.
  const double age_s = tick.t_s - back(0).t_s;
  const double slack_mm = config_.line_error_counts * config_.count_mm;
  const double least = tick.low_mm - slack_mm - back(0).x_mm;
  const double most = tick.high_mm + slack_mm - back(0).x_mm;
  if (out.velocity_mm_s * age_s < least || out.velocity_mm_s * age_s > most) {
    out.velocity_mm_s = std::clamp(out.velocity_mm_s * age_s, least, most) / age_s;
    out.acceleration_mm_s2 = -out.velocity_mm_s / age_s;
  }
}

Estimate EventFit::tick(const Tick& tick) noexcept {
  Estimate out;
  out.t_s = tick.t_s;
  out.position_bound_mm = tick.high_mm - tick.low_mm;
  if (known_ > 0 && tick.t_s - back(0).t_s >= config_.timeout_s) {
    known_ = 0;
  }
  if (known_ == 0) {
    out.position_mm = 0.5 * (tick.low_mm + tick.high_mm);
    return out;
  }
  extrapolate(tick.t_s, out);
  if (tick.t_s > back(0).t_s) {
    clip(tick, out);
  }
  return out;
}

}  // namespace steadyrest::motion::online
