// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/contour/offline/predistort/shape/tool_motion.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>

namespace steadyrest::contour::offline {

/// Rounds the kinks between joined pieces that the control would slow down for: by an arc that
/// takes `share` of the acceleration across the path, or what the pieces have room for.
[[nodiscard]] std::vector<Piece> round_kinks(const std::vector<Piece>& pieces,
                                             const nc::plan::PathLimits& limits, double share);

/// A corner of the path that the command is led beyond.
struct Corner {
  double at_mm = 0.0;      ///< path length
  double behind_mm = 0.0;  ///< how far the tool is behind when the command is there
  double beyond = 0.6;     ///< how far the command is led on, in terms of that
};

/// Leads the command beyond corners: the tool lags, so it turns before the corner; straight on by
/// `beyond` and from there to the path 0.7 times the lag behind the corner keeps it nearer. Where
/// the control all but stops (Piece::passes) a detour would cost two stops for one, and the corner
/// is left alone; so it is with a share of 0. `corners` has the shares by place, ascending, and
/// receives the corners found; the default holds for one that is not in it.
[[nodiscard]] std::vector<Piece> lead_corners(const std::vector<Piece>& pieces,
                                              const ToolMotion& motion,
                                              std::vector<Corner>& corners);

}  // namespace steadyrest::contour::offline
