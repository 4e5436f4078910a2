// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <steadyrest/contour/online/axis_step.hpp>
#include <steadyrest/contour/online/look_ahead.hpp>
#include <steadyrest/contour/online/servo_model.hpp>
#include <steadyrest/contour/online/tool_point.hpp>
#include <steadyrest/kernel/offset/limited_follower.hpp>

namespace steadyrest::contour::online {

/// What the override will do, from now on.
///
/// r(t), the ratio that the envelope lets pass, moves to `target` at the slew limits, stays there
/// for `hold_s`, then falls to `floor`. It acts after the dead time. A rise is assumed to act
/// immediately after it, a fall a whole scan later: the worse case of both for the contour. The
/// control sees the largest step not above r.
struct RatioPlan {
  double start = 1.0;  ///< the envelope's ratio now
  double target = 1.0;
  double floor = 0.1;
  double hold_s = 0.02;
  double judged_from_s = 0.0;  ///< errors before it do not count; those in the dead time never do
};

/// The machine's state at the beginning of a forecast.
struct Outset {
  double position_mm = 0.0;  ///< commanded path length
  double speed_mm_s = 0.0;   ///< commanded path speed
  double rapid_ratio = 1.0;
  double panel_ratio = 1.0;  ///< the override never acts above it
  ServoState servo;
  std::array<double, 3> play_mm{};  ///< table − motor, within half of the backlash
  std::size_t command_cell = 0;
  std::size_t foot_cell = 0;
  double foot_mm = 0.0;  ///< path length of the foot; of carry() alone
  /// Where the tool point is, while offsets cancel the contour error; empty: they do not.
  std::optional<ToolPoint::State> tool;
  /// Where the port moves the offsets slowly: where they are, and whether they follow the tool
  /// point or go to 0.
  std::array<kernel::offset::LimitedFollower, 3> offset{};
  bool follows = true;
};

/// Simulates the control's speed and the servos along the cells ahead, for one candidate.
///
/// Speed: target = min(cap, feed·r); changes at most by a·h; keeps v² ≤ min(cap², square + 2a·left)
/// and the next cell's target. Servo: exact linear step (AxisStep). The table follows the motors
/// within the play of the backlash. Contour error: distance from the predicted table to the
/// parabola of the foot's cell; the foot moves forward only, over corners by comparison with the
/// first cell behind the corner, as ContourError would find it. Where offsets cancel the error
/// (Outset::tool) the servos follow the tool point's command, held to the largest offset: what
/// remains is what the offsets cannot do, nor a port that moves them slowly
/// (set_offset_acceleration).
///
/// Accuracy against the closed forms of constant curvature: 0.1 % of ε and 0.1 µm (test). Not
/// modelled: jerk beyond its mean delay, friction, drive saturation; the governor measures the
/// rest.
class Forecast {
 public:
  static constexpr std::size_t kMaxSteps = 512;
  static constexpr std::size_t kMaxTable = 256;

  struct Timing {
    double step_s = 0.002;
    double dead_s = 0.0;
    double scan_s = 0.01;
    double fall_1_s = 10.0;
    double rise_1_s = 2.0;
    double settle_s = 0.08;  ///< after the last change
  };

  /// The least error still attainable, by place: an error that exceeds the limit anyway must not
  /// stop a candidate.
  struct Trace {
    std::size_t count = 0;
    std::array<double, kMaxSteps> position_mm{};
    std::array<double, kMaxSteps> error_mm{};
  };

  struct Result {
    double error_mm =
        0.0;             ///< largest |ε| while the candidate can still change something; with sign
    double at_mm = 0.0;  ///< commanded path length then
    bool kept = true;    ///< never above the limit (and the trace)
    double broken_mm = 0.0;  ///< else the foot's path length at the first break
    bool judged = false;     ///< there was an error to judge
    std::size_t steps = 0;
  };

  Forecast() = default;
  void set_timing(const Timing& timing) noexcept;
  [[nodiscard]] const Timing& timing() const noexcept { return timing_; }
  void set_model(std::span<const AxisModel, 3> model) noexcept;
  /// How the offsets would be chosen, and how large one may be.
  void set_tool_point(const ToolPoint& tool_point, double most_mm) noexcept;
  /// The port moves an offset with this at most; 0: no limit.
  void set_offset_acceleration(double acceleration_mm_s2) noexcept {
    offset_acceleration_mm_s2_ = acceleration_mm_s2;
  }
  /// The table follows the motor within this play, either way.
  void set_half_backlash(const std::array<double, 3>& half_mm) noexcept {
    half_backlash_mm_ = half_mm;
  }
  /// Ratios of the table's steps in rising order.
  void set_table(std::span<const double> ratio) noexcept;
  /// Ratios already on their way: entry n acts at most until n·step_s; 0 = nothing pending.
  [[nodiscard]] std::array<double, kMaxSteps>& pending() noexcept { return pending_; }
  void set_pending_count(std::size_t count) noexcept { pending_count_ = count; }

  /// Stops at the first |ε| above `limit_mm` unless `stop_early` is false. `trace` (may be null)
  /// raises the limit; `record` (may be null) receives the errors by place.
  [[nodiscard]] Result run(const LookAhead& path, const Outset& outset, const RatioPlan& plan,
                           double limit_mm, bool stop_early, const Trace* trace,
                           Trace* record) const noexcept;

  /// Squares of the contour error in the cut, with the ratio held for so long, kMaxSteps at most.
  /// The foot is the nearest place around the tool point (Outset::tool), which run() need not have.
  struct Squares {
    double mean_mm2 = 0.0;
    double largest_mm2 = 0.0;
    std::size_t steps = 0;
  };
  [[nodiscard]] Squares squares(const LookAhead& path, const Outset& outset, double ratio,
                                double time_s) const noexcept;

  /// Takes the machine along the path to `to_mm` with a ratio in force: how many steps that took,
  /// `most` at most.
  [[nodiscard]] std::size_t carry(const LookAhead& path, double to_mm, double ratio,
                                  std::size_t most, Outset& machine) const noexcept;

  [[nodiscard]] double floor_ratio(double ratio) const noexcept;
  [[nodiscard]] const AxisStep& axis_step(std::size_t i) const noexcept { return step_[i]; }

 private:
  class FootTracker;
  struct Walk;
  [[nodiscard]] double planned(const RatioPlan& plan, double t_s) const noexcept;

  Timing timing_;
  std::array<AxisModel, 3> model_{};
  std::array<AxisStep, 3> step_{};
  ToolPoint tool_point_;
  double most_offset_mm_ = 0.0;
  double offset_acceleration_mm_s2_ = 0.0;
  std::array<double, 3> half_backlash_mm_{};
  std::array<double, kMaxTable> table_{};
  std::size_t table_count_ = 0;
  std::array<double, kMaxSteps> pending_{};
  std::size_t pending_count_ = 0;
};

}  // namespace steadyrest::contour::online
