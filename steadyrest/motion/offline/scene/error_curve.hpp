// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

/// Errors of estimates against the truth, at their own instant and earlier ones.
namespace steadyrest::motion::offline {

/// Shifts τ of the error curves, s: 0, 0.25 … 20 ms.
[[nodiscard]] std::vector<double> curve_lags_s();

/// Of one quantity, velocity (mm/s) or acceleration (mm/s²).
struct ErrorFigures {
  double rms = 0.0;  ///< zero lag
  double max = 0.0;
  double own_lag_s = 0.0;  ///< τ* with the least RMS
  double rms_at_own_lag = 0.0;
  double coverage = 0.0;            ///< share of the ticks with |error| ≤ bound; NaN without bounds
  double bound_rms_at_speed = 0.0;  ///< at |v| > 1 mm/s; infinite without bounds
  double rms_at_speed = 0.0;        ///< NaN where it is never that fast
  std::vector<double> rms_at_lag;   ///< for each of `curve_lags_s`
};

/// Sums over several records: e(τ) = RMS[estimate(t) − truth(t − τ)], the truth linear between the
/// ticks.
class ErrorCurve {
 public:
  enum class Quantity : std::uint8_t { velocity, acceleration };
  static constexpr double kAtSpeed_mm_s = 1.0;

  explicit ErrorCurve(Quantity quantity);
  void add(const std::vector<online::Estimate>& estimates, const Record& record,
           const std::vector<std::uint8_t>& scored);
  [[nodiscard]] ErrorFigures figures() const;
  [[nodiscard]] std::size_t ticks() const { return ticks_; }

 private:
  struct Value {
    double estimate;
    double bound;
  };
  [[nodiscard]] Value value(const online::Estimate& estimate) const;
  [[nodiscard]] double truth(const MotionState& state) const;
  [[nodiscard]] double truth_at(const Record& record, std::size_t tick, double t_s) const;
  void add_at_zero_lag(const online::Estimate& estimate, const MotionState& state);

  Quantity quantity_;
  std::vector<double> lags_s_;
  std::vector<double> sum2_;
  std::vector<std::size_t> count_;
  std::size_t ticks_ = 0;
  std::size_t covered_ = 0;
  std::size_t bounded_ = 0;
  std::size_t at_speed_ = 0;
  double max_ = 0.0;
  double speed2_ = 0.0;
  double bound2_ = 0.0;
};

}  // namespace steadyrest::motion::offline
