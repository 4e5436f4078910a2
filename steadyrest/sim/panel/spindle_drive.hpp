// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::sim {

/// The spindle's drive: follows its commanded speed as fast as ramp, torque and power allow.
///
/// Law (n speed in rev/s, J inertia in kg·m²):
///   |ṅ| ≤ min(a_max, M_max/(2π·J), P/(4π²·J·|n|))
/// The last term is the power limit P = M·2πn; it gives d(n²)/dt = ±P/(2π²·J), so both regimes are
/// integrated exactly, with the change-over at n_b = P/(4π²·J·a), a the smaller of the first two.
/// Braking has the same limits; a reversal goes through zero. Target: command · override, with its
/// magnitude held in [min, max] unless it is 0. At speed: |n − target| ≤ tolerance·max(|target|, 1
/// rev/s). Cutting torque is not simulated.
class SpindleDrive {
 public:
  struct Config {
    kernel::machine::Spindle spindle;
    double at_speed_tolerance_ratio = 0.03;
  };
  struct Input {
    double command_rev_s = 0.0;  ///< signed, at override 100 %
    double override_ratio = 1.0;
    double period_s = 0.001;
  };
  struct Output {
    double target_rev_s = 0.0;
    double actual_rev_s = 0.0;
    bool at_speed = true;
  };

  static kernel::outcome::Result<SpindleDrive> make(const Config& config);

  Output update(const Input& input) noexcept;

 private:
  explicit SpindleDrive(const Config& config) noexcept;
  [[nodiscard]] double target(const Input& input) const noexcept;

  double min_rev_s_;
  double max_rev_s_;
  double ramp_rev_s2_;    ///< a
  double base_rev_s_;     ///< n_b
  double power_rev2_s3_;  ///< P/(2π²·J)
  double tolerance_;
  double actual_rev_s_ = 0.0;
};

}  // namespace steadyrest::sim
