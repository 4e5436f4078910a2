// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Servo gain, feed-forward, lag and delay of an axis from a record of its motion.
namespace steadyrest::contour::offline {

/// Positions of one axis, sampled once a cycle. mm, on a rotary axis rad; so are all lengths below.
struct ServoLog {
  std::vector<double> time_s;  ///< rising; a gap is a lost sample
  std::vector<double> command;
  std::vector<double> actual;
};

struct ServoFit {
  std::string axis;
  bool rotary = false;
  double gain_1_s = 0.0;  ///< k
  double gain_sd_1_s = 0.0;
  double feed_forward = 0.0;  ///< f
  double feed_forward_sd = 0.0;
  double lag_s = 0.0;  ///< τ of the velocity loop; 0: the record shows none
  double lag_sd_s = 0.0;
  double least_lag_s = 0.0;  ///< what the record allows, two standard deviations each way
  double most_lag_s = 0.0;
  bool second_order = false;  ///< the velocity loop has a second pole
  double delay_s = 0.0;       ///< d, of all axes
  double delay_sd_s = 0.0;
  double mode_hz = 0.0;  ///< of a structure that the encoder sees; 0: none
  double mode_damping = 0.0;
  double mode_weight = 0.0;
  /// The record determines gain (3 %) and feed-forward (0.05) well enough for the machine file.
  bool determined = true;
  double rest_error = 0.0;  ///< c − x at rest
  /// Actual less simulated position over the whole record, at rest too.
  double rms = 0.0;
  double largest = 0.0;
  double hard_rms = 0.0;    ///< the same where the command accelerates hardest, and just after
  double calm_rms = 0.0;    ///< elsewhere
  int shift_cycles = 0;     ///< the delay in whole cycles
  std::size_t samples = 0;  ///< in motion: those that the fit used
  /// How far the axis falls behind when it reverses: backlash and friction.
  double lost_motion = 0.0;
  double lost_motion_sd = 0.0;
  std::size_t reversals = 0;
};

struct ServoFits {
  std::vector<ServoFit> axes;
  double period_s = 0.0;
  bool shift_certain = false;  ///< the delay is known to half a cycle, two standard deviations
};

/// Fits every axis; `logs` and `axes` belong together, one by one.
///
/// Law (servo_law.hpp). τ·x″ + x′ = k·(c(t − d) − x − o) + f·c′(t − d), o the error at rest, d
/// common to all axes; where the record supports it with a second pole of the velocity loop, a
/// structural mode that the encoder sees, and motion lost at reversals. Maximum likelihood of the
/// free simulation over what is in motion, exact in discrete time, residuals with the colour of an
/// autoregression of up to 8 cycles (servo_likelihood.hpp).
///
/// From the simplest law up: gain, feed-forward and a delay of no cycle or one, where they leave no
/// more than the counts and the unknown between the samples do (servo_simplest.hpp). Else what the
/// record supports: −2·ln of the likelihood and 6 for each number, over all combinations, with
/// delays of 0, ½ and 1 cycle beside a free one (servo_orders.hpp). Standard deviations hold what
/// this choice leaves open: near τ = f = 0 a delay, a lag and a gain look alike to the first order.
///
/// Of 44 random axes (k 12 … 57 1/s, τ to 20 ms, f to 0.9, delays to 3 ms, 1 µm of noise, half of
/// them with a mode of 40 Hz) 6 were refused, as f and the delay could not be told apart; of the
/// other 38 had 35 k within 2 % and τ within 1 ms. Two standard deviations held for k in 34, for f
/// in 32, for τ in 35: they are too small where a mode passes for delay and feed-forward.
///
/// A control that interpolates finer than the log's cycle makes k too high by about k·(k·h)²/12:
/// 0.4 % at 50 1/s and 4 ms.
///
/// Refused, by the axis's name: a cycle that is not even; travel, speed or gain outside the axis's
/// limits; too little motion; constant speed only; no following error; an actual position that
/// leads; a saturated drive; halves that disagree; motion that is not this law's.
[[nodiscard]] kernel::outcome::Result<ServoFits> fit_servos(
    const std::vector<ServoLog>& logs, const std::vector<kernel::machine::Axis>& axes);

}  // namespace steadyrest::contour::offline
