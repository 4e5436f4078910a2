// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_orders.hpp>
#include <steadyrest/contour/offline/identify/servo_runs.hpp>
#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// What a record must show, and what a fit must leave, to be of use.
namespace steadyrest::contour::offline {

/// RMS of the motion that a fit can see.
struct ServoMoves {
  std::size_t samples = 0;
  double error = 0.0;
  double speed_au_s = 0.0;
};

/// How far the axis is from the fitted law.
struct ServoMisfit {
  double rms = 0.0;
  double largest = 0.0;
  double moving_rms = 0.0;
  double hard_rms = 0.0;
  double calm_rms = 0.0;
};

/// An axis with its record, ready to be fitted.
struct ServoSubject {
  const kernel::machine::Axis& axis;
  const ServoLog& log;
  double period_s = 0.0;
  std::vector<ServoRun> runs;    ///< unbroken
  std::vector<ServoRun> moving;  ///< parts of them
  ServoMoves moves{};
  ServoProblem problem{};
};

/// Refused: a cycle that is not even, travel or speed outside the axis's, too little motion, no
/// following error.
[[nodiscard]] kernel::outcome::Result<ServoSubject> prepared_subject(
    const kernel::machine::Axis& axis, const ServoLog& log, double period_s);

[[nodiscard]] ServoMisfit misfit_of(const ServoProblem& problem, const ServoLaw& law);

/// Well enough for the machine file (ServoFit::determined).
[[nodiscard]] bool is_determined(const ServoNumbers& found) noexcept;

/// Refused: halves that disagree, motion that is not the law's, a gain beyond what the layer
/// takes, numbers that the record does not determine, a drive at its limit.
[[nodiscard]] kernel::outcome::Result<void> check_fit(const ServoSubject& subject,
                                                      const ServoNumbers& found,
                                                      const ServoMisfit& off);

}  // namespace steadyrest::contour::offline
