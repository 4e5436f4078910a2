// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/learn/stretches.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/predistort/shape/command_shape.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// The displacement that takes a share of the errors away that a round has left on free segments.
///
/// Law. As from a record (stretches.hpp), with a low-pass of σ = 3 L, L the largest lag: with 1 to
/// 2 L the displacement has kinks that the control slows down for, and that costs more than it
/// wins (rib pocket, 2026-11-24).
[[nodiscard]] std::vector<Learnt::Stretch> refinement(std::vector<ErrorSample> errors,
                                                      const nc::plan::PlannedPath& path,
                                                      const std::vector<SegmentUse>& use,
                                                      const ServoModels& model, double share);

}  // namespace steadyrest::contour::offline
