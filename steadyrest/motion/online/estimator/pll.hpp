// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::online {

/// Second-order tracking loop on sampled counts, as in ODrive's firmware 0.5.
///
/// Law, each tick of the nominal period T, p in counts, c the count:
///   p ← p + T·v,  d = c − ⌊p⌋,  p ← p + T·kp·d,  v ← v + T·ki·d,  kp = 2·b,  ki = kp²/4,
/// v ← 0 where |v| < T·ki/2. Critically damped with the bandwidth b (rad/s).
///
/// Accuracy. Under a constant acceleration a the velocity lags by kp/ki = 2/b, an error of −2·a/b.
/// Needs T·kp < 1. The acceleration q·ki·d is what the loop adds to v in this tick: ours, ODrive
/// has none; its unit step is q·b². No bounds. It sees neither stamps nor jitter. Source: ODrive
/// firmware, MotorControl/encoder.cpp, `update` and `update_pll_gains`.
class Pll final : public Estimator {
 public:
  struct Config {
    double count_mm = 0.001;         ///< q > 0
    double cycle_s = 0.001;          ///< T > 0, nominal
    double bandwidth_rad_s = 300.0;  ///< b > 0; 2·b·T < 1
  };

  static kernel::outcome::Result<Pll> make(const Config& config);

  void edge(const Edge& /*edge*/) noexcept override {}
  Estimate tick(const Tick& tick) noexcept override;

 private:
  explicit Pll(const Config& config) noexcept;

  Config config_;
  double kp_1_s_ = 0.0;
  double ki_1_s2_ = 0.0;
  std::int64_t origin_ = 0;  ///< whole counts, so that p keeps its digits
  double position_counts_ = 0.0;
  double velocity_counts_s_ = 0.0;
  bool started_ = false;
};

}  // namespace steadyrest::motion::online
