// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/sim/axis/edge_search.hpp>
#include <steadyrest/sim/axis/encoder.hpp>
#include <steadyrest/sim/axis/friction.hpp>

namespace steadyrest::sim {

/// One axis of the machine: position loop, velocity loop, drive, friction, backlash, encoder.
///
/// Law between two servo periods (x motor side, z table side, c commanded position):
///   v_cmd(t) = k·(c(t) − x(t) − δₙ) + a·ċ(t)        position loop with velocity feed-forward
///   τ·v̇ = v_cmd − v   (τ = 0: v = v_cmd)            closed velocity loop, nominal
///   u = sat_A(v̇_nominal + d̂),  v̇ = u − f(v)         drive limit and friction (friction.hpp)
///   Ti·d̂˙ = f − d̂                                   the velocity loop's integral part
///   z = min(max(z, x − b/2), x + b/2)               backlash: the table follows within the play
///   δₙ = encoder(xₙ) − xₙ, sampled at the servo period and held through it
///
/// Discretisation: c(t) is the parabola through the commanded positions at both ends of the servo
/// period whose slope changes by as much as the commanded velocity (without a velocity: the
/// straight line). The linear law is then solved exactly, so that the continuous closed forms (lag
/// v/k, circle gain 1/√(1 + q²), …) hold at any servo period; the sampling delay of a real control
/// is not simulated separately: it is part of τ. With friction or a drive limit the period is
/// divided into the drive's own steps (125 µs by default); each is the exact linear step, corrected
/// by what limit and friction take away. There τ = 0 means a velocity loop that is deadbeat in one
/// drive step.
/// Symbols: k servo gain 1/s, a feed-forward 0…1, τ s, A drive limit mm/s², b backlash mm, Ti s.
/// With dry friction, a command at rest and an encoder error of at most one count (0.5 µm if that
/// is more) count as arrived, as in real drives: the loop holds its position, so that stiction,
/// count size and integral part together do not hunt. Rotary axes: rad, not mm.
class AxisServo {
 public:
  struct Config {
    kernel::machine::Axis axis;
    double period_s = 0.001;         ///< servo period, (0, 0.1]
    double drive_period_s = 125e-6;  ///< longest step with friction or drive limit, > 0
    double integral_s = 0.010;       ///< Ti: how fast the velocity loop rejects friction, > 0
  };

  /// Plain values: enough to log and to restore.
  struct State {
    double motor_mm = 0.0;
    double velocity_mm_s = 0.0;       ///< of the motor side
    double acceleration_mm_s2 = 0.0;  ///< of the motor side; mean over the last drive step where
                                      ///< there is friction or a drive limit
    double table_mm = 0.0;
    double table_velocity_mm_s = 0.0;
    double disturbance_mm_s2 = 0.0;              ///< d̂
    double encoder_mm = 0.0;                     ///< last reading
    std::int64_t count = 0;                      ///< of the encoder; 0 where it is ideal
    std::optional<Passage> edge = std::nullopt;  ///< last one in this period, if any
    double command_mm = 0.0;                     ///< last commanded position
    double command_mm_s = 0.0;                   ///< last commanded velocity
    double drive_mm_s2 = 0.0;                    ///< u of the last step
    bool saturated = false;                      ///< the drive was at its limit in this period
  };

  static kernel::outcome::Result<AxisServo> make(const Config& config);

  /// Standstill at a position, backlash centred, no friction load.
  void reset(double position_mm) noexcept;
  void restore(const State& state) noexcept { state_ = state; }

  /// Advances one servo period to the commanded position and velocity at its end.
  const State& update(double command_mm, double command_mm_s) noexcept;

  [[nodiscard]] const State& state() const noexcept { return state_; }

 private:
  /// Transition of (x, v) minus the particular solution over one step.
  struct Transition {
    double h_s = 0.0;
    double rate_1_s = 0.0;  ///< 1/h
    double xx = 0.0, xv = 0.0, vx = 0.0, vv = 0.0;
  };
  /// Commanded parabola in one step: position, slope at its start, curvature, at its end position.
  struct Piece {
    double start_mm, slope_mm_s, curvature_mm_s2, end_mm;
  };

  AxisServo(const Config& config, const Encoder& encoder) noexcept;
  /// Advances x and v over one step of the linear law; returns the law's velocity at the step's
  /// start.
  double nominal(const Piece& piece, double held_mm, double& x, double& v) const noexcept;
  void limited(const Piece& piece, double held_mm, State& s) const noexcept;
  [[nodiscard]] bool holds(double command_mm, double command_mm_s) const noexcept;
  void move_table(State& s) const noexcept;
  [[nodiscard]] double nominal_acceleration(const Piece& piece, double held_mm) const noexcept;
  void keep(std::size_t step, double start_mm, double start_mm_s, const State& end) noexcept;
  [[nodiscard]] bool turned() const noexcept;
  void count_edges() noexcept;

  double gain_1_s_;
  double inverse_gain_s_;
  double lag_gain_;  ///< 1 − a
  double lag_s_;
  double drive_mm_s2_;
  double half_backlash_mm_;
  double window_mm_;
  double period_s_;
  double integral_share_ = 0.0;
  bool linear_;
  std::uint32_t steps_;
  Transition step_;
  Friction friction_;
  Encoder encoder_;
  std::vector<Stretch> stretches_;  ///< of this period, one for each step
  State state_;
};

}  // namespace steadyrest::sim
