// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/contour/online/servo_model.hpp>
#include <steadyrest/kernel/machine/axis.hpp>

namespace steadyrest::contour::offline {

/// An axis whose servo is not what the machine file says.
struct FittedAxis {
  std::string name;
  online::AxisModel was;       ///< by the machine file
  online::AxisModel is;        ///< by the record
  double gain_sd_1_s = 0.0;    ///< standard deviation of its gain
  bool lag_was_known = false;  ///< the file has a lag
};

/// Puts servos that explain the records in the place of the machine file's, where those do not. A
/// model that the record contradicts would take its own error for the machine's: from an axis with
/// a lag of 15 ms, modelled without, a part was learnt that had 99 µm RMS; without it had 70.
///
/// Tried: what fit_servos() determines, and gain and lag alone, at the file's feed-forward and
/// without a delay; each for all axes that the path moves together, since unequal gains bend
/// straight lines. The contour error that the records leave beyond each model decides, to which a
/// delay of the whole record is nothing (LearningFigures::misfit_rms_mm): the file's model goes
/// where another leaves at most kClearly of it. Returns the axes that changed. Refused: what
/// learn_from() refuses with the file's model, where no other explains the records.
[[nodiscard]] kernel::outcome::Result<std::vector<FittedAxis>> fit_axes(
    const std::vector<CutPart>& parts, const Lessons& lessons,
    std::vector<kernel::machine::Axis>& axes);

}  // namespace steadyrest::contour::offline
