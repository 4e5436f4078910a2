// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace steadyrest::adapters::lines {

/// The programmed spindle speed, where only its encoder shows it.
///
/// Law: the speed measured over 0.2 s, divided by the override in force, is the programmed one when
/// the override has not changed for a second and the speed has not changed by more than 2 % in the
/// last 0.2 s. In between the last one stays, so a modulated speed does not change it.
class SpindleWatch {
 public:
  /// `counts_rev` of the encoder, ≠ 0.
  explicit SpindleWatch(double counts_rev) noexcept : counts_rev_(counts_rev) {}

  void update(double time_s, double count, double ratio) noexcept;

  [[nodiscard]] double actual_rev_s() const noexcept { return actual_rev_s_; }
  /// 0: not known yet, or standstill.
  [[nodiscard]] double programmed_rev_s() const noexcept { return programmed_rev_s_; }

 private:
  double counts_rev_;
  bool started_ = false;
  double from_s_ = 0.0;  ///< of the measurement in progress
  double from_count_ = 0.0;
  double last_s_ = 0.0;
  double last_count_ = 0.0;
  double ratio_ = 1.0;
  double ratio_since_s_ = 0.0;
  double measured_rev_s_ = 0.0;  ///< over the last whole 0.2 s
  double actual_rev_s_ = 0.0;
  double programmed_rev_s_ = 0.0;
};

}  // namespace steadyrest::adapters::lines
