// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/contour/offline/learn/convergence.hpp>
#include <steadyrest/contour/offline/learn/in_force.hpp>
#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/learn/part_record.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

struct LearnConfig {
  double cut_off_hz = 0.0;  ///< of the low-pass Q, −3 dB; 0: see kCutOffLags
  double tube_mm = 1.0;     ///< within which the program that was cut stays of the original
  double most_mm = 0.1;     ///< larger unknown errors are none of the model's: left out
  JudgeConfig judge;
  Uncertainty uncertainty;
};

/// What one record is learnt from.
struct Lesson {
  const kernel::machine::Machine& machine;
  const nc::plan::PlannedPath& original;  ///< that the part should have
  const nc::plan::PlannedPath& cut;       ///< that the control ran
  const PartRecord& record;
  ServoModels model;  ///< whose inverse the program is written with
};

/// A stretch of the record that was left out.
struct LeftOut {
  Use why = Use::learns;
  double from_s = 0.0;  ///< in the record's time
  double to_s = 0.0;
  std::uint32_t first_line = 0;  ///< of the program that was cut
  std::uint32_t last_line = 0;
};

struct LearningFigures {
  double cut_s = 0.0;     ///< of the record, in a cut of the program
  double learns_s = 0.0;  ///< of that, learnt from
  /// Contour error by the encoders while it learns; and that beyond the model's.
  double measured_rms_mm = 0.0;
  double unknown_rms_mm = 0.0;
  /// That beyond the model's, where it is too large to learn from as well.
  double misfit_rms_mm = 0.0;
  double cut_off_hz = 0.0;
  double convergence = 0.0;  ///< the largest factor by which an unknown error shrinks
  std::vector<LeftOut> left_out;
};

/// Learns from one part; `learnt` receives the record's stretches.
///
/// Law. By original path length s, with d the vector from the tool, by the encoders, to its foot on
/// the original path and d̂ the same of the model that runs the program that was cut:
///   r(s) = d(s) − d̂(s),   u(s) = Q·L·r(s),   L = 1 + g·d/dt,
/// g = (1 − a)/k of each axis. u displaces the command (CommandShape) beside the model's inverse.
/// d̂ holds what the program that was cut had of u already, so nothing has to be carried from part
/// to part: it is u⁺ = Q·(u + L·d) without u. It converges as that does (convergence.hpp).
///
/// Q and L are one local fit: a straight line in the record's time with Gaussian weights about each
/// sample, zero phase, r and ṙ at once, and without bias at the ends of a stretch. Stretches end at
/// corners and where the record is not in force (judge); there the weight falls to 0.
///
/// Refused: a cut-off that does not converge for the stated uncertainty, a record with fewer than
/// 2·k samples a second, a program that was not cut for this part, columns that look swapped, a
/// record with no second in force.
[[nodiscard]] kernel::outcome::Result<LearningFigures> learn(const Lesson& lesson,
                                                             const LearnConfig& config,
                                                             Learnt& learnt);

}  // namespace steadyrest::contour::offline
