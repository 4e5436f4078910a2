// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>

namespace steadyrest::contour::offline {

/// A point of the commanded curve.
struct CurvePoint {
  kernel::signal::Point point_mm{};
  kernel::signal::Point direction{};  ///< unit vector
  double progress_mm = 0.0;
};

struct FitConfig {
  nc::interpret::Plane plane = nc::interpret::Plane::xy;
  double tolerance_mm = 1e-3;
  bool one_line = false;  ///< a single line from end to end: chords of a CAM path, lines in space
};

/// The curve through the points as lines and arcs that no point misses by more than the tolerance
/// and that go on without a bend.
///
/// A span becomes a line where that is straight to a fifth of the tolerance and 2 mrad, else a
/// biarc: two arcs that have the curve's directions at the ends and a common one where they meet
/// (Bolton 1975; d from the condition of equal tangent lengths), one arc where both have the same
/// centre. Where a point is missed the span is halved. The progress along a span is in proportion
/// to length.
[[nodiscard]] std::vector<Piece> fit_curve(const std::vector<CurvePoint>& points,
                                           const FitConfig& config);

}  // namespace steadyrest::contour::offline
