// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>
#include <steadyrest/motion/online/line/ripple.hpp>

namespace steadyrest::motion::online {

/// MotionEstimator in the coordinate y = x − e(x), which removes the ripple that repeats with
/// position; the ripple is then restored: v = v_y/(1 − e′).
///
/// The acceleration excludes the ripple: e″·v² is large, short, and entirely wrong where the
/// position is slightly wrong. No bounds on v and a: learnt data is no guarantee. Takes the
/// configuration of MotionEstimator. Without ripple the estimates are the same.
class RippleEstimator final : public Estimator {
 public:
  using Config = MotionEstimator::Config;
  static kernel::outcome::Result<RippleEstimator> make(const Config& config);

  void edge(const Edge& edge) noexcept override;
  Estimate tick(const Tick& tick) noexcept override;

  [[nodiscard]] const Ripple& ripple() const noexcept { return ripple_; }

 private:
  RippleEstimator(MotionEstimator smooth, double count_mm) noexcept
      : smooth_(std::move(smooth)), count_mm_(count_mm) {}

  MotionEstimator smooth_;
  Ripple ripple_;
  double count_mm_;
};

}  // namespace steadyrest::motion::online
