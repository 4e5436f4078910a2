// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::contour::offline {

/// A line or an arc that is commanded in place of a part of a block.
struct Piece {
  kernel::signal::PathSegment segment;  ///< machine coordinates; `feed_mm_s` at 100 %
  nc::interpret::Plane plane = nc::interpret::Plane::xy;  ///< of the block: of its arcs
  /// Original path lengths that correspond to its ends.
  double progress_start_mm = 0.0;
  double progress_end_mm = 0.0;
  bool begins_run = false;  ///< nothing that may be changed is before it
  bool joined = false;      ///< it goes on from the piece before; else the original has a corner …
  bool passes = false;      ///< … that the control passes at speed
};

[[nodiscard]] kernel::signal::PathSegment line_segment(const kernel::signal::Point& start,
                                                       const kernel::signal::Point& end);
/// The arc or helix in a plane from `start`, where it has the direction `tangent`, to `end`; less
/// than one turn. Nothing where it would be straight (a radius above 3 m).
[[nodiscard]] std::optional<kernel::signal::PathSegment> arc_from_tangent(
    nc::interpret::Plane plane, const kernel::signal::Point& start,
    const kernel::signal::Point& tangent, const kernel::signal::Point& end);
inline constexpr double kLeastArc_mm =
    0.005;  ///< written digits could leave a smaller one no centre
/// An arc that the text has as one. One that turns by less than 10 µrad is a line there: LinuxCNC
/// takes a turn of 1 µrad for a whole circle.
[[nodiscard]] bool is_written_as_arc(const kernel::signal::PathSegment& segment) noexcept;
/// The part of a piece between two of its parameters 0 ≤ u < w ≤ 1; its progress in proportion.
[[nodiscard]] Piece part_of(const Piece& piece, double u, double w);

}  // namespace steadyrest::contour::offline
