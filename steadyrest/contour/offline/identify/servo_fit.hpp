// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Servo gain and feed-forward of an axis from a record of its motion.
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
  double rest_error = 0.0;  ///< c − x at rest
  /// Actual less simulated position over the whole record, at rest too.
  double rms = 0.0;
  double largest = 0.0;
  double hard_rms = 0.0;  ///< the same where the command accelerates hardest, and just after
  double calm_rms = 0.0;  ///< elsewhere
  int shift_cycles = 0;
  std::size_t samples = 0;  ///< in motion: those that the fit used
  /// How far the axis falls behind the law when it reverses; backlash and friction raise it.
  double lost_motion = 0.0;
  double lost_motion_sd = 0.0;
  std::size_t reversals = 0;
};

struct ServoFits {
  std::vector<ServoFit> axes;
  double period_s = 0.0;
  bool shift_certain = false;  ///< the other shift fits clearly worse
};

/// Fits every axis; `logs` and `axes` belong together, one by one.
///
/// Law. x' = k·(c − x − o) + f·c', o the error at rest. With the command straight between two
/// samples, h apart, and e = c − x, d = Δc, that is exactly
///   e⁺ = p·e + q·d + o·(1 − p),   p = exp(−k·h),   q = (1 − f)·(1 − p)/(k·h).
/// The command may be `shift_cycles` ahead of the actual position: c is that of so many cycles
/// before. The same shift holds for all axes: 0 or 1, whichever leaves less (likelihood). With
/// little feed-forward it leaves no trace but a feed-forward lower by k·h; then 1 where 0 would
/// give one below zero, else 0.
///
/// Least squares for p, q and o over the stretches in motion, then again with the simulated e as
/// instrument and all filtered by 1/(1 − p·z⁻¹) until p stays: counts and noise in e no longer pull
/// p down, and what is made small is the error of the free simulation. Standard deviations from
/// sums over batches longer than 5/k, so residuals that hang together count for what they are.
///
/// A control that interpolates finer than the log's cycle makes k too high by about k·(k·h)²/12:
/// 0.4 % at 50 1/s and 4 ms. One that samples and holds, x⁺ = x + h·k·(c − x) + f·d, is fitted to
/// the order k·h/2.
///
/// Refused, by the axis's name: a cycle that is not even; travel, speed or gain outside the axis's
/// limits; too little motion; constant speed only; no following error; an actual position that
/// leads; a saturated drive; halves that disagree; motion that is not this law's.
[[nodiscard]] kernel::outcome::Result<ServoFits> fit_servos(
    const std::vector<ServoLog>& logs, const std::vector<kernel::machine::Axis>& axes);

}  // namespace steadyrest::contour::offline
