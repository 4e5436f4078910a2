// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/bounded/jerk_ramp.hpp>
#include <steadyrest/motion/online/bounded/lag_smoother.hpp>
#include <steadyrest/motion/online/bounded/model_bank.hpp>
#include <steadyrest/motion/online/bounded/motion_bound.hpp>
#include <steadyrest/motion/online/edges/edge_group.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

/// Position, velocity and acceleration from every edge and its time, with guaranteed bounds.
///
/// Five hypotheses run side by side (interacting multiple models, Blom and Bar-Shalom 1988): four
/// Kalman filters of white jerk, from almost steady motion to a shock, and standstill. Each edge is
/// a measurement of position with variance σ_line² + (v·clock)²/12; the absence of an edge is the
/// cell's interval information. Likelihoods weight the hypotheses, so the filter needs no tuning to
/// the motion: calm motion is averaged over a long time, a jerk is followed at once. σ_line is
/// learnt from the innovations. A known jerk limit removes the models beyond it; JerkRamp predicts
/// stops and starts at constant jerk; the estimate is kept within MotionBound's proof.
///
/// Internal lengths are counts from the first cell. Limits, accuracy and figures:
/// steadyrest/motion/README.md.
namespace steadyrest::motion::online {

class MotionEstimator final : public Estimator {
 public:
  struct Config {
    double count_mm = 0.001;  ///< length of one count (rad for rotary axes), > 0
    double cycle_s = 0.001;   ///< nominal control cycle, 1e-6 … 1
    double clock_s = 1e-7;    ///< period of the edges' time stamps, 0 … cycle; 0 = exact
    double line_error_mm =
        -1.0;  ///< bound on a line's position error after calibration; < 0: not known, four times
               ///< the learnt σ is taken and the bounds are no longer guaranteed
    double max_speed_mm_s = kNoBound;
    double max_acceleration_mm_s2 = kNoBound;
    double max_jerk_mm_s3 = kNoBound;  ///< without it velocity and acceleration have no bounds
    double lag_s = 0.0;  ///< the estimate may be this late, 0 … 32 cycles; rounded to whole cycles
  };
  static kernel::outcome::Result<MotionEstimator> make(const Config& config);

  void edge(const Edge& edge) noexcept override;
  Estimate tick(const Tick& tick) noexcept override;

  /// Learnt σ of the lines' positions, mm.
  [[nodiscard]] double line_sigma_mm() const noexcept;
  /// Probability that the axis is at rest.
  [[nodiscard]] double standstill() const noexcept { return weight_rest_; }
  /// Inputs rejected: not finite, or earlier than the last one.
  [[nodiscard]] std::uint64_t rejected() const noexcept { return rejected_; }
  [[nodiscard]] std::uint64_t contradictions() const noexcept { return bound_.contradictions(); }

 private:
  static constexpr double kLeastVariance = 1e-10;  ///< counts²
  static constexpr double kMostVariance = 0.09;

  /// How standstill begins and ends; see tuning() for the values.
  struct Tuning {
    double start_speed =
        0.0;  ///< at the first line, of the speed that J gives on the way from rest
    double start_speed_spread = 0.0;  ///< σ of it
    double start_acceleration = 0.0;
    double start_acceleration_spread = 0.0;
    double start_at_edge = 0.0;  ///< likelihood that an edge is a start from rest, 1/count
    double edge_at_rest = 0.0;   ///< likelihood of an edge in standstill, 1/count
    double jerk_of_start = 0.0;  ///< s: a model of density S starts with J = √(S/this)
    double decay_1_s = 0.0;      ///< largest decay of a model reduced to the jerk limit
    double switch_1_s = 0.0;     ///< rate at which a model hands over to its neighbours
    double stop_1_s = 0.0;       ///< … to standstill, where the model's speed may be 0
    double start_1_s = 0.0;      ///< from standstill to the models, without an edge
  };
  struct Rest {
    double x = 0.0;
    double variance = 0.0;
  };
  /// Shares of a hypothesis' probability that are exchanged in a tick.
  struct Exchange {
    double hand_over = 0.0;  ///< from a model to its neighbours
    double starts = 0.0;     ///< from standstill to all models
    Lanes stops{};           ///< from the model to standstill
    Lanes stays{};
  };
  struct Mixed {
    double x = 0.0;
    double v = 0.0;
    double a = 0.0;
  };

  [[nodiscard]] static Tuning tuning(bool jerk_known) noexcept;
  MotionEstimator(const Config& config, const MotionBound& bound) noexcept;
  void start(double t_s, double x, double variance) noexcept;
  void restart_after_gap(double t_s) noexcept;
  void observe(const Observation& seen) noexcept;
  void start_moving(double share, double x, std::int8_t direction) noexcept;
  void normalise() noexcept;
  void sampled(const Tick& tick) noexcept;
  Mixed look(const Tick& tick) noexcept;
  void take_over(std::size_t j, const Lanes& part, double part_rest) noexcept;
  [[nodiscard]] Exchange exchange() const noexcept;
  void hand_over(const Exchange& gives) noexcept;
  [[nodiscard]] double come_to_rest(const Exchange& gives) noexcept;
  void mix() noexcept;
  [[nodiscard]] Estimate finish(const Tick& tick, double now_s, const Mixed& mixed,
                                const MotionIntervals& sure) const noexcept;
  [[nodiscard]] Estimate late(double now_s, const MotionIntervals& now) noexcept;

  Config config_;
  Tuning tuning_;
  Lanes jerk_density_{};  ///< count²/s⁵
  Lanes decay_1_s_{};
  Lanes start_speed_{};  ///< count/s at the first line after standstill
  Lanes start_acceleration_{};
  double clock_ = 0.0;
  MotionBound bound_;
  EdgeGroup group_;
  LagSmoother smoother_;
  ModelBank bank_;
  JerkRamp ramp_;
  Lanes weight_{};
  std::size_t turn_ = 0;  ///< model that receives from the others at the next tick
  double weight_rest_ = 1.0;
  Rest rest_;
  Lanes least_share_{};  ///< of the models' probability inside the cell since the last edge
  double line_variance_ = 0.0;
  double origin_mm_ = 0.0;
  double edge_s_ = 0.0;
  double feed_back_s_ = 0.0;
  double last_s_ = 0.0;
  std::int64_t last_count_ = 0;
  bool started_ = false;
  bool sampled_ = true;
  std::uint64_t rejected_ = 0;
};

}  // namespace steadyrest::motion::online
