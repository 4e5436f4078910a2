// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::online {

/// What controls do today: differences of the count over m ticks of the nominal period T.
///
/// Law, c the count, q its size, k the tick:
///   v = q·(c_k − c_{k−m})/(m·T)                  a = q·(c_k − 2·c_{k−m} + c_{k−2m})/(m·T)²
///
/// Accuracy. At constant speed with f = fraction of v·m·T/q the error of v has the variance
/// f·(1 − f)·(q/(m·T))², on average over f a sixth of (q/(m·T))², hence RMS(v) = q/(√6·m·T);
/// RMS(a) = q/(√2·(m·T)²) (class of result: Kavanagh and Murphy, IEEE TIM 47(6) 1998). Lag m·T/2 of
/// v and m·T of a. The period is the nominal one, so tick jitter shows as v·(relative jitter). No
/// bounds. Position: the middle of the cell, ± q/2.
class BackwardDifference final : public Estimator {
 public:
  static constexpr std::size_t kMaxTicks = 64;
  struct Config {
    double count_mm = 0.001;  ///< q > 0
    double cycle_s = 0.001;   ///< T > 0, nominal
    std::size_t ticks = 1;    ///< m; 1…64
  };

  static kernel::outcome::Result<BackwardDifference> make(const Config& config);

  void edge(const Edge& /*edge*/) noexcept override {}
  Estimate tick(const Tick& tick) noexcept override;

 private:
  explicit BackwardDifference(const Config& config) noexcept : config_(config) {}
  [[nodiscard]] std::int64_t count_before(std::size_t ticks) const noexcept;

  Config config_;
  std::array<std::int64_t, 2 * kMaxTicks + 1> counts_{};  ///< a ring
  std::size_t newest_ = 0;
  bool started_ = false;
};

}  // namespace steadyrest::motion::online
