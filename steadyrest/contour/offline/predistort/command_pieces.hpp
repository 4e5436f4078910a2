// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/predistort/hold/feed_caps.hpp>
#include <steadyrest/contour/offline/predistort/shape/command_shape.hpp>
#include <steadyrest/contour/offline/predistort/shape/joints.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// What the pieces of a command are made of.
struct CommandTask {
  const kernel::machine::Machine& machine;
  const nc::plan::PlannedPath& path;
  const ServoInverse& inverse;
  const Learnt& learnt;
  const FeedCaps& caps;
  double tolerance_mm = ShapeConfig{}.tolerance_mm;  ///< of the fit
  double smooth = ShapeConfig{}.smooth;
};

/// The pieces for a command at this speed: its curve, corners led beyond, kinks rounded, feeds
/// lowered. `corners` as in lead_corners().
[[nodiscard]] inline std::vector<Piece> command_pieces(const CommandTask& task,
                                                       const std::vector<SegmentUse>& use,
                                                       const CommandSpeed& speed,
                                                       std::vector<Corner>& corners) {
  constexpr double kAcrossShare = 0.9;  // of the acceleration across the path, for kinks
  const ToolMotion motion(task.inverse, task.path, speed);
  const nc::plan::PathLimits limits(task.machine.axes, task.machine.control);
  ShapeConfig shape;
  shape.tolerance_mm = task.tolerance_mm;
  shape.smooth = task.smooth;
  shape.across_mm_s2 =
      kAcrossShare * limits.centripetal_share() * limits.plane({0.0, 0.0, 1.0}).acceleration_mm_s2;
  auto made = CommandShape(task.path, use, task.inverse, motion, task.learnt, shape).pieces();
  made = lead_corners(made, motion, corners);
  return task.caps.apply(round_kinks(made, limits, kAcrossShare));
}

}  // namespace steadyrest::contour::offline
