// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/sim/cut/cutting_process.hpp>

namespace steadyrest::sim {

/// Runs the cut on the machine's clock: steps the process over the spindle's angle with the
/// machine's speed and feed in a period, and sums up its output in time.
///
/// Feed per tooth = speed along the path over (spindle speed · teeth). Both are constant within a
/// period. Below half of `slowest_rev_s` nothing is cut and the tool only rings down. `unforced`
/// compares each point with the one a tooth earlier (a turn earlier, where pitch or runout differ)
/// at the same angle: forced vibration repeats there, regenerative does not. The sensor: velocity
/// of the tool along both axes of the machine, their sum (one sensor at 45°, times √2), sampled at
/// `sensor_rate_hz` by straight lines between steps.
/// times √2), sampled at `sensor_rate_hz` by straight lines between steps.
class CuttingVibration {
 public:
  struct Config {
    Cutting cut;
    double slowest_rev_s = 10.0;  ///< the slowest speed at which the program cuts, > 0
    double steps_per_period = 40.0;
    double sensor_rate_hz = 10'000.0;  ///< 100 … 1e6
  };
  struct Input {
    double period_s = 0.001;
    double speed_rev_s = 0.0;  ///< magnitude counts
    double path_speed_mm_s = 0.0;
    std::array<double, 2> feed_direction{1.0, 0.0};
    bool in_cut = false;
  };
  /// Over the time in the cut since begin_cycle(); lengths in mm.
  struct Cycle {
    double cutting_s = 0.0;
    double peak_mm = 0.0;                  ///< largest displacement from rest
    std::array<double, 2> sum_mm_s{};      ///< ∫x dt, along and across the feed
    std::array<double, 2> square_mm2_s{};  ///< ∫x² dt
    double unforced_mm2_s = 0.0;           ///< ∫½·|x − x a tooth ago|² dt
    double force_peak_n = 0.0;
    double power_peak_w = 0.0;
    double chip_peak_mm = 0.0;
    std::size_t walls = 0;  ///< points of the finished wall
    double wall_sum_mm = 0.0;
    double wall_low_mm = 0.0;
    double wall_high_mm = 0.0;
  };

  /// Refuses what CuttingProcess refuses, and a sensor rate outside its range.
  static kernel::outcome::Result<CuttingVibration> make(const Config& config);

  /// Clears cycle() and samples(). Keeps at most one second of samples per cycle.
  void begin_cycle() noexcept;
  void advance(const Input& input) noexcept;

  [[nodiscard]] const Cycle& cycle() const noexcept { return cycle_; }
  /// mm/s, oldest first, of this cycle.
  [[nodiscard]] std::span<const double> samples() const noexcept { return samples_; }
  [[nodiscard]] double sensor_rate_hz() const noexcept { return rate_hz_; }

 private:
  CuttingVibration(const Config& config, CuttingProcess process);
  void take(const CuttingProcess::Output& now) noexcept;
  void sense(const CuttingProcess::Output& now, const std::array<double, 2>& direction) noexcept;
  void forget() noexcept;

  CuttingProcess process_;
  double slowest_rev_s_;
  double per_tooth_;  ///< 1/teeth
  double rate_hz_;
  double due_s_ = 0.0;          ///< time by which the process lags the machine
  double next_sample_s_ = 0.0;  ///< from the step's start
  double last_mm_s_ = 0.0;
  std::vector<std::array<double, 2>> pass_mm_;  ///< displacement over the last tooth's pass
  std::size_t at_ = 0;
  std::size_t kept_ = 0;
  std::vector<double> samples_;
  Cycle cycle_;
};

}  // namespace steadyrest::sim
