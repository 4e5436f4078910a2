// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::online {

/// M/T: counts between the latest edges of two ticks over the time between these edges.
///
/// Law, c and t the count after the latest edge before a tick and its stamp:
///   new edge:  v = q·Δc/Δt;  v = 0 where both edges passed the same line (a reversal by one edge:
///              Δt may be arbitrarily short, the true distance is 0)
///   no edge:   |v| ← min(|v|, q/age), age = tick − t;  v = 0 from `timeout_s` on; then
///              `edges_to_start` ticks with edges pass before v is computed again
///   a = (v_k − v_{k−1})/(tick_k − tick_{k−1}): ours, LinuxCNC gives none.
///
/// Accuracy. Relative error (stamp's unit)/Δt from the clock, plus the line errors over Δc·q;
/// averaging over Δt delays it by about 3/4 of a tick. A reversal within Δt is wrong by one count,
/// as in LinuxCNC. No bounds. Position: last line + v·age, clipped to the cell.
///
/// Sources: Ohmae et al. 1982; LinuxCNC, drivers/mesa-hostmot2/encoder.c (the defaults) and
/// components/encoder.c (`linuxcnc_encoder`; it stamps with its base thread and knows no
/// reversals).
class MOverT final : public Estimator {
 public:
  struct Config {
    double count_mm = 0.001;       ///< q > 0
    double timeout_s = 0.5;        ///< > 0; hostmot2: vel-timeout; LinuxCNC's encoder: 1/min-speed
    bool zero_on_reversal = true;  ///< hostmot2 has the rule, LinuxCNC's encoder does not
    std::uint32_t edges_to_start = 1;  ///< hostmot2 1, LinuxCNC's encoder 2
  };
  /// As LinuxCNC's software encoder with its default min-speed-estimate of 1 count/s.
  [[nodiscard]] static Config linuxcnc_encoder(double count_mm) noexcept {
    return {count_mm, 1.0, false, 2};
  }

  static kernel::outcome::Result<MOverT> make(const Config& config);

  void edge(const Edge& edge) noexcept override;
  Estimate tick(const Tick& tick) noexcept override;

 private:
  explicit MOverT(const Config& config) noexcept : config_(config) {}
  void take_edge() noexcept;
  void wait(double age_s) noexcept;

  Config config_;
  Edge latest_;     ///< last edge so far
  Edge reference_;  ///< last edge before the previous tick
  bool fresh_ = false;
  std::uint32_t seen_ = 0;  ///< ticks with edges since the timeout, saturates
  double velocity_mm_s_ = 0.0;
  double last_velocity_mm_s_ = 0.0;
  double last_tick_s_ = 0.0;
  bool ticked_ = false;
};

}  // namespace steadyrest::motion::online
