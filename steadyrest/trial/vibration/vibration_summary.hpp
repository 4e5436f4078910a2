// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <steadyrest/trial/vibration/cut_simulation.hpp>

/// The results of a simulated cut.
namespace steadyrest::trial::vibration {

struct Summary {
  double peak_um = 0.0;  ///< largest displacement from rest
  double force_peak_n = 0.0;
  double power_peak_w = 0.0;
  /// Constant speed, second half of the run: half the swing of what repeats with each tooth (with
  /// each turn where pitch or runout differ) and RMS of the rest, on the axis that moves more.
  std::optional<double> forced_um;
  std::optional<double> rest_rms_um;
  std::optional<double> frequency_hz;  ///< strongest line of the rest, where it is over 10 nm RMS
  /// The finished wall in the second half: mean place (> 0: too much is cut off) and highest minus
  /// lowest place left by the teeth.
  std::optional<double> wall_error_um;
  std::optional<double> wall_range_um;
};

class VibrationSummary {
 public:
  /// `repeat`: steps after which the forced vibration repeats; 0: never (modulated speed).
  VibrationSummary(double seconds, std::size_t repeat) : half_s_(0.5 * seconds), repeat_(repeat) {}

  void add(const Moment& now);
  [[nodiscard]] Summary summary() const;

 private:
  double half_s_;
  std::size_t repeat_;
  double step_s_ = 0.0;
  Summary seen_;
  std::vector<std::array<double, 2>> displacement_mm_;  ///< of the second half
  std::size_t walls_ = 0;
  double wall_sum_mm_ = 0.0;
  double wall_low_mm_ = 0.0;
  double wall_high_mm_ = 0.0;
};

/// Frequency of the strongest line above 0, Hann window, interpolated.
[[nodiscard]] std::optional<double> strongest_line_hz(std::vector<double> signal, double step_s);

}  // namespace steadyrest::trial::vibration
