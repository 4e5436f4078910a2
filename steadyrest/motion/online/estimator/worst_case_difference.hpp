// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::online {

/// Difference over a window chosen by the acceleration limit, with a guaranteed bound.
///
/// Law. |ẍ| ≤ L, samples x_i at the ticks t_i with |error| ≤ N̄. The record itself shows the least
/// size of its errors: a motion within L cannot leave the chord by more than L·(t_j − t_l)(t_k −
/// t_j)/2, hence
///   N̂ = max over 1 ≤ j < l ≤ k̄ of ½·(|x_j − chord_{k,l}(t_j)| − ½·L·(t_k − t_j)(t_j − t_l)), ≥ 0
/// (j, l ticks back). Window w = the shortest with w ≥ 2·√(N̂/L), at most W = that of k̄ ticks;
///   v = (x_k − x_{k−w})/w,   k̄ = the count of ticks whose W makes 2·N̄/W + L·W least.
/// Bound: error of w ≤ error of W + 2·N̂/w + L·(W − w)/2 ≤ 2·N̄/W + L·W, for k̄ = 1 2·N̄/T + L·T/2:
/// never above the published 2·√(2·N̄·L) + L·T/2. It uses the ticks' own times, so it holds under
/// jitter, and from the second tick on (with the window available).
///
/// N̄ = q/2 + line error: sampled counts, no edges. Acceleration, ours: difference of v over W, held
/// within ± L; |error| ≤ |a| + L.
/// Source: Haimovich, Seeber, Aldana-López, Gómez-Gutiérrez, L-CSS 2021, arXiv 2106.05320.
class WorstCaseDifference final : public Estimator {
 public:
  static constexpr std::size_t kMaxTicks = 64;
  struct Config {
    double count_mm = 0.001;                 ///< q > 0
    double cycle_s = 0.001;                  ///< T > 0, nominal; only for the choice of k̄
    double max_acceleration_mm_s2 = 1000.0;  ///< L > 0
    double line_error_mm = 0.0;              ///< ≥ 0; largest error of a line
  };

  static kernel::outcome::Result<WorstCaseDifference> make(const Config& config);

  void edge(const Edge& /*edge*/) noexcept override {}
  Estimate tick(const Tick& tick) noexcept override;

  /// k̄; at most 64 (a longer best window is truncated, and the bound reflects it).
  [[nodiscard]] std::size_t longest_window_ticks() const noexcept { return longest_; }

 private:
  struct Sample {
    double t_s = 0.0;
    double x_mm = 0.0;
    double v_mm_s = 0.0;
  };
  explicit WorstCaseDifference(const Config& config) noexcept;
  [[nodiscard]] const Sample& back(std::size_t ticks) const noexcept {
    return samples_[(newest_ + samples_.size() - ticks) % samples_.size()];
  }
  [[nodiscard]] double shown_error_mm(std::size_t longest) const noexcept;

  Config config_;
  double noise_mm_ = 0.0;  ///< N̄
  std::size_t longest_ = 1;
  std::array<Sample, kMaxTicks + 1> samples_{};  ///< a ring
  std::size_t newest_ = 0;
  std::size_t known_ = 0;
};

}  // namespace steadyrest::motion::online
