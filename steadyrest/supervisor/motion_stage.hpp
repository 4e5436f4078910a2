// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>

namespace steadyrest::supervisor {

/// Velocity and acceleration of each axis, written into the Frame before any room decides by them.
///
/// One MotionEstimator for each present axis whose encoder has counts. Each cycle it gets the last
/// edge, with the lines passed before it as lost, and the count; without time stamps only the
/// counts. The last edge's line is `count` if the edge raised the count, `count` + 1 if it lowered
/// it. Where the control does not report the direction, the sign of the count's change decides; an
/// edge that left the count unchanged is then ignored, since its line could be either.
///
/// Limits of the estimator, from the machine file:
///   speed         max_speed
///   acceleration  what the drive can do (else max_acceleration), plus the braking by friction
///   jerk          none: max_jerk is what the control plans with. Dry friction reverses at once,
///                 and a corner of the path comes through the servo as a step of the speed; with
///                 max_jerk the bounds fail in up to 3 of 10 000 cycles of the example pocket, and
///                 the estimates are as fine without
///   line error    line_error, the bound on the position of lines and so of cells; with a
///                 calibration what that leaves
///
/// Calibration: line n is at q·(n − ½) + phase[n mod 4] + table[n] of the machine file; the counter
/// must count from the same place. It leaves 4·√(σ² + (0.004 q)²), where σ is the table's own
/// figure for its lines (LineTable::sigma_mm); unless every line of the travel was learnt, at least
/// line_error plus the largest phase. As sure as the calibration is: four sigma, no proof.
///
/// An axis without estimate (not reported, not finite, ideal encoder, unfit frame) has 0 and
/// infinite bounds. An axis starts over after a gap of more than 50 cycles, a step of the count
/// that its speed cannot produce, or time that ran backwards.
class MotionStage {
 public:
  struct Config {
    std::vector<kernel::machine::Axis> axes;  ///< with their encoders
    double cycle_s = 0.001;                   ///< the control's interpolator period
  };

  struct AxisState {
    motion::online::MotionEstimator estimator;  ///< a value: a copy continues identically
    bool started = false;
    double time_s = 0.0;
    double edge_s = 0.0;  ///< the last one seen
    std::int64_t count = 0;
    motion::online::Estimate estimate{};
  };
  struct State {
    std::vector<AxisState> axis;  ///< those with an encoder
  };

  /// What the stage makes of an axis whose encoder has counts.
  struct Setup {
    motion::online::LineTable lines;
    /// `line_error_mm` below 0: a line may be off by more than a count, and there are no bounds.
    motion::online::MotionEstimator::Config limits;
  };
  static kernel::outcome::Result<Setup> setup(const kernel::machine::Axis& axis, double cycle_s);

  static kernel::outcome::Result<MotionStage> make(const Config& config);
  static kernel::outcome::Result<MotionStage> make(const kernel::machine::Machine& machine) {
    return make({.axes = machine.axes, .cycle_s = kernel::machine::layer_cycle_s(machine)});
  }

  /// Fills in the estimates; `fit` false: the frame is unusable and gets no estimates.
  void update(kernel::signal::Frame& frame, bool fit) noexcept;
  void reset() noexcept;
  [[nodiscard]] State state() const;
  /// From a stage for the same machine; a state with other axes is rejected.
  void restore(const State& state) noexcept;

 private:
  struct Axis {
    std::size_t index = 0;
    double line_error_mm = 0.0;
    double max_steps_s = 0.0;  ///< counts/s above which the counter must have been set
    double clock_s = 0.0;      ///< 0: no time stamps
    bool bounded = true;
    motion::online::LineTable lines;
    motion::online::MotionEstimator fresh;
    AxisState now;
  };

  MotionStage() = default;
  void restart(Axis& axis) const noexcept;
  [[nodiscard]] bool broken(const Axis& axis, const kernel::signal::AxisSample& sample,
                            double time_s) const noexcept;
  void take_edge(Axis& axis, const kernel::signal::AxisSample& sample,
                 double time_s) const noexcept;
  void look(Axis& axis, const kernel::signal::AxisSample& sample, double time_s) const noexcept;

  double gap_s_ = 0.05;
  std::vector<Axis> axes_;
};

}  // namespace steadyrest::supervisor
