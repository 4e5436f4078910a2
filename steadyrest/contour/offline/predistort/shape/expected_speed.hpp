// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <steadyrest/contour/offline/predistort/shape/tool_motion.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// How fast a smooth command of the path would move, from how the control runs the path itself.
///
/// Law. v is the path's own speed `planned`, at most `most_mm_s` by path length. The command is
/// ahead by v·L, L = `lag_s`, and where the tool is on an arc of radius R it moves at
/// v·√(1 + (v·L/R)²). A shape made for the speeds of the run before alternates where the control
/// slows down for the shape; one made for these does not.
[[nodiscard]] CommandSpeed expected_speed(const nc::plan::PlannedPath& path, CommandSpeed planned,
                                          double lag_s,
                                          const std::function<double(double at_mm)>& most_mm_s);

}  // namespace steadyrest::contour::offline
