// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/contour/offline/learn/learnt.hpp>
#include <steadyrest/contour/offline/predistort/shape/curve_fit.hpp>
#include <steadyrest/contour/offline/predistort/shape/servo_inverse.hpp>
#include <steadyrest/contour/offline/predistort/shape/tool_motion.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// What may be done with a segment of the planned path.
struct SegmentUse {
  bool free = false;  ///< its block may be replaced
  bool stops = true;  ///< the control comes to rest at its end, or something happens there
  nc::interpret::Plane plane = nc::interpret::Plane::xy;
};

struct ShapeConfig {
  double tolerance_mm = 1e-3;
  double sharp = 0.8;  ///< |t′ − t| from which a joint is a corner that the path is not led around
  /// Kinks of the command are rounded by arcs that take this share of the acceleration across the
  /// path that the axes have; pieces beside a kink are kept long enough for that.
  double across_mm_s2 = 2000.0;
  /// |t′ − t| of the command up to which a joint has one direction, the mean of both.
  double smooth = 0.0;
};

/// The curve that the command must run so that the tool runs on the path (ServoInverse at the
/// tool's motion, and what was learnt), as pieces, block by block: a block's pieces are commanded
/// while the tool is on the block, so block ends move by v·L along the tangent and arcs keep their
/// centre.
///
/// At a joint where the path's direction changes a little (chords) both sides meet half-way. At
/// corners, at stops and beside blocks that stay, the curve goes through the path's own point; on
/// the last 2·v·L before it fades to it.
class CommandShape {
 public:
  CommandShape(const nc::plan::PlannedPath& path, const std::vector<SegmentUse>& use,
               const ServoInverse& inverse, const ToolMotion& motion, const Learnt& learnt,
               const ShapeConfig& config);

  /// Those of all free segments, in order; `segment.line` and `feed_mm_s` are the block's, the feed
  /// in proportion to the length of the command: the program's time is kept.
  [[nodiscard]] std::vector<Piece> pieces();

 private:
  /// The curve at one side of a joint.
  struct End {
    kernel::signal::Point point_mm{};
    kernel::signal::Point direction{};
    double progress_mm = 0.0;
    bool led = false;  ///< by the tool's motion, not through the path's own point
  };
  [[nodiscard]] bool goes_on(std::size_t segment) const noexcept;
  [[nodiscard]] bool passes(std::size_t segment) const noexcept;
  [[nodiscard]] End end_of(std::size_t segment) const;
  [[nodiscard]] CurvePoint led_point(std::size_t segment, const ToolState& at,
                                     double distance_mm) const;
  [[nodiscard]] std::vector<CurvePoint> curve(std::size_t segment, const End& start,
                                              const End& end) const;
  [[nodiscard]] std::vector<CurvePoint> inner_points(std::size_t segment, const End& end) const;
  [[nodiscard]] bool is_smooth(const kernel::signal::Point& in,
                               const kernel::signal::Point& out) const noexcept;
  [[nodiscard]] double kink_room_mm(std::size_t segment, const kernel::signal::Point& in,
                                    const kernel::signal::Point& out, double speed) const;

  const nc::plan::PlannedPath& path_;
  const std::vector<SegmentUse>& use_;
  const ServoInverse& inverse_;
  const ToolMotion& motion_;
  const Learnt& learnt_;
  const ShapeConfig& config_;
};

}  // namespace steadyrest::contour::offline
