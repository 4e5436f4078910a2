// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::online {

/// Savitzky–Golay at the end of its window: the least-squares polynomial of degree p through the
/// last n sampled counts, with its derivatives at the newest one.
///
/// Law. x̂(τ) = Σ_i b_i τ^i minimises Σ_j (x̂(τ_j) − x_j)², x_j = q·(c_j + ½), τ_j = −j·T: position
/// b_0, velocity b_1, acceleration 2·b_2 = fixed weights times the counts. `make` computes the
/// weights once by Eigen's Householder QR. (Boost.Math's discrete_lanczos_derivative gives the same
/// velocity weights, but needs an odd n and p > 2 for the acceleration, and gives no position; the
/// tests compare with it where both exist.)
///
/// Accuracy, σ = q/√12, W = n·T: p = 2 var v = 192·σ²/(n·W²), var a = 720·σ²/(n·W⁴); p = 1 var v =
/// 12·σ²/(n·W²). Under a jerk J the end of p = 2 is wrong by J·W²/10 and J·W/2, p = 1 by a·W/2.
/// Counts are not white noise at constant speed, so the measured figure may be smaller or larger.
/// Jitter of the tick is not seen. No bounds. Source: Savitzky and Golay 1964; Gorry, Analytical
/// Chemistry 62 (1990) 570 (end points).
class SavitzkyGolay final : public Estimator {
 public:
  static constexpr std::size_t kMaxSamples = 128;
  static constexpr std::size_t kMaxDegree = 4;
  struct Config {
    double count_mm = 0.001;   ///< q > 0
    double cycle_s = 0.001;    ///< T > 0, nominal
    std::size_t samples = 16;  ///< n; degree + 1…128
    std::size_t degree = 2;    ///< p; 1…4; the acceleration of p = 1 is 0
  };
  using Weights = std::array<double, kMaxSamples>;  ///< [j]: of the sample j ticks ago

  static kernel::outcome::Result<SavitzkyGolay> make(const Config& config);

  void edge(const Edge& /*edge*/) noexcept override {}
  Estimate tick(const Tick& tick) noexcept override;

  [[nodiscard]] const Weights& velocity_weights_1_s() const noexcept { return velocity_; }
  [[nodiscard]] const Weights& acceleration_weights_1_s2() const noexcept { return acceleration_; }

 private:
  explicit SavitzkyGolay(const Config& config);

  Config config_;
  Weights position_{};
  Weights velocity_{};
  Weights acceleration_{};
  std::array<std::int64_t, kMaxSamples> counts_{};  ///< a ring
  std::size_t newest_ = 0;
  bool started_ = false;
};

}  // namespace steadyrest::motion::online
