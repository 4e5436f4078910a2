// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/motion/offline/scene/error_curve.hpp>

// The error against the truth now and up to 20 ms ago: a late estimator has its least error at its
// lag, so the curve separates lag from noise.
namespace steadyrest::motion::offline {
namespace {

using kernel::units::kNan;

double root_mean(double sum2, std::size_t count) {
  return count > 0 ? std::sqrt(sum2 / static_cast<double>(count)) : kNan;
}

}  // namespace

std::vector<double> curve_lags_s() {
  constexpr int kSteps = 80;
  constexpr double kStep_s = 0.25e-3;
  std::vector<double> out;
  for (int i = 0; i <= kSteps; ++i) {
    out.push_back(kStep_s * i);
  }
  return out;
}

ErrorCurve::ErrorCurve(Quantity quantity)
    : quantity_(quantity),
      lags_s_(curve_lags_s()),
      sum2_(lags_s_.size(), 0.0),
      count_(lags_s_.size(), 0) {}

ErrorCurve::Value ErrorCurve::value(const online::Estimate& estimate) const {
  return quantity_ == Quantity::velocity
             ? Value{estimate.velocity_mm_s, estimate.velocity_bound_mm_s}
             : Value{estimate.acceleration_mm_s2, estimate.acceleration_bound_mm_s2};
}

double ErrorCurve::truth(const MotionState& state) const {
  return quantity_ == Quantity::velocity ? state.velocity_mm_s : state.acceleration_mm_s2;
}

/// The truth at t ≤ the time of the tick; NaN before the record.
/// Linear between ticks: at 1 ms that is good to J·T²/8, far below any error scored.
double ErrorCurve::truth_at(const Record& record, std::size_t tick, double t_s) const {
  if (t_s == record.ticks[tick].t_s) {
    return truth(record.truth[tick]);
  }
  while (tick > 0 && record.ticks[tick - 1].t_s > t_s) {
    --tick;
  }
  if (tick == 0) {
    return kNan;
  }
  const double from_s = record.ticks[tick - 1].t_s;
  const double width_s = std::max(record.ticks[tick].t_s - from_s, 1e-12);
  return std::lerp(truth(record.truth[tick - 1]), truth(record.truth[tick]),
                   (t_s - from_s) / width_s);
}

void ErrorCurve::add_at_zero_lag(const online::Estimate& estimate, const MotionState& state) {
  const Value v = value(estimate);
  const double error = std::abs(v.estimate - truth(state));
  ++ticks_;
  max_ = std::max(max_, error);
  bounded_ += std::isfinite(v.bound) ? 1U : 0U;
  covered_ += error <= v.bound ? 1U : 0U;
  // At standstill bounds are trivially tight and would flatter the ratio.
  if (std::abs(state.velocity_mm_s) > kAtSpeed_mm_s) {
    ++at_speed_;
    speed2_ += error * error;
    bound2_ += v.bound * v.bound;
  }
}

void ErrorCurve::add(const std::vector<online::Estimate>& estimates, const Record& record,
                     const std::vector<std::uint8_t>& scored) {
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    if (scored[k] == 0) {
      continue;
    }
    add_at_zero_lag(estimates[k], record.truth[k]);
    const double estimate = value(estimates[k]).estimate;
    for (std::size_t i = 0; i < lags_s_.size(); ++i) {
      const double error = estimate - truth_at(record, k, record.ticks[k].t_s - lags_s_[i]);
      if (std::isfinite(error)) {
        sum2_[i] += error * error;
        ++count_[i];
      }
    }
  }
}

ErrorFigures ErrorCurve::figures() const {
  ErrorFigures out;
  for (std::size_t i = 0; i < lags_s_.size(); ++i) {
    out.rms_at_lag.push_back(root_mean(sum2_[i], count_[i]));
  }
  out.rms = out.rms_at_lag.front();
  out.max = count_.front() > 0 ? max_ : kNan;
  // The lag at which the estimate fits best: an estimator's own delay, measured rather than
  // assumed.
  std::size_t best = 0;
  for (std::size_t i = 1; i < lags_s_.size(); ++i) {
    best = out.rms_at_lag[i] < out.rms_at_lag[best] ? i : best;
  }
  out.own_lag_s = lags_s_[best];
  out.rms_at_own_lag = out.rms_at_lag[best];
  out.coverage = bounded_ > 0 ? static_cast<double>(covered_) / static_cast<double>(ticks_) : kNan;
  out.bound_rms_at_speed = root_mean(bound2_, at_speed_);
  out.rms_at_speed = root_mean(speed2_, at_speed_);
  return out;
}

}  // namespace steadyrest::motion::offline
