// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <steadyrest/contour/offline/predistort/shape/joints.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/corner.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::AxisValues;
using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kSpare = 1.02;  ///< a joint that lets this much of the speed pass is let be
constexpr double kRoom = 0.9;    ///< of a piece that an arc may take
constexpr double kLeastRadius_mm = 1e-3;
constexpr double kAnyTolerance_mm = 1.0;
constexpr double kInPlaneArc = 1.0 - 1e-9;  ///< of the arc's axis along the plane's normal
constexpr double kLeastPiece_mm = 0.01;
constexpr double kLeastLag_mm = 1e-3;
constexpr double kBack = 0.7;   ///< where the command is on the path again, in lags
constexpr double kAlone = 2.0;  ///< room that a corner needs on both sides, in lags
constexpr double kSamePlace_mm = 1e-3;
constexpr double kLeastTurn = 0.3;  ///< |t′ − t| of a corner

Point tangent_at(const PathSegment& segment, double u) noexcept {
  return geometry::station_at(segment, u).tangent;
}

AxisValues axis_values(const Point& p) noexcept {
  AxisValues out{};
  std::ranges::copy(p, out.begin());
  return out;
}

/// The control need not slow down at the joint of both.
bool passes(const Piece& from, const Piece& to, const nc::plan::PathLimits& limits, double speed) {
  const PathSegment& before = from.segment;
  const PathSegment& after = to.segment;
  const AxisValues in = axis_values(tangent_at(before, 1.0));
  const AxisValues out = axis_values(tangent_at(after, 0.0));
  if (limits.has_kinks()) {
    const double ramp = after.geometry == Geometry::line ? limits.line(out).acceleration_mm_s2
                                                         : limits.arc(after).acceleration_mm_s2;
    const bool lines = before.geometry == Geometry::line && after.geometry == Geometry::line;
    return kSpare * (lines ? 1.0 : nc::plan::kKinkOfArcs) * limits.kink(in, out, speed, ramp) <
           limits.junction_share();
  }
  return limits.junction_mm_s(in, out, before.length_mm, after.length_mm) >= kSpare * speed;
}

/// The piece between both, if the control would slow down at their joint. An arc in space cannot be
/// written.
std::optional<nc::plan::CornerArc> rounding(const Piece& from, const Piece& to,
                                            const nc::plan::PathLimits& limits, double share) {
  const PathSegment& before = from.segment;
  const PathSegment& after = to.segment;
  const Point in = tangent_at(before, 1.0);
  const Point out = tangent_at(after, 0.0);
  const auto bend = nc::plan::bend_of(in, out);
  const double speed = std::min(before.feed_mm_s, after.feed_mm_s);
  const std::size_t normal = nc::interpret::axes_of(to.plane).normal;
  if (!bend || std::abs(bend->axis[normal]) < kInPlaneArc || passes(from, to, limits, speed)) {
    return std::nullopt;
  }
  const double across =
      share * limits.centripetal_share() * limits.plane(bend->axis).acceleration_mm_s2;
  return nc::plan::round_corner(before, after, in, out, *bend,
                                {.tolerance_mm = kAnyTolerance_mm,
                                 .room_before_mm = kRoom * before.length_mm,
                                 .room_after_mm = kRoom * after.length_mm,
                                 .most_radius_mm = speed * speed / across});
}

PathSegment arc_of(const nc::plan::CornerArc& corner, const PathSegment& like, double feed_mm_s) {
  PathSegment arc;
  arc.geometry = Geometry::arc;
  arc.motion = like.motion;
  arc.line = like.line;
  arc.start_mm = corner.start_mm;
  arc.end_mm = corner.end_mm;
  arc.centre_mm = corner.centre_mm;
  arc.axis = corner.axis;
  arc.radius_mm = arc.radius_end_mm = corner.radius_mm;
  arc.sweep_rad = corner.sweep_rad;
  arc.length_mm = corner.radius_mm * corner.sweep_rad;
  arc.feed_mm_s = feed_mm_s;
  return arc;
}

}  // namespace

std::vector<Piece> round_kinks(const std::vector<Piece>& pieces, const nc::plan::PathLimits& limits,
                               double share) {
  std::vector<Piece> out;
  out.reserve(pieces.size());
  for (Piece next : pieces) {
    if (next.segment.length_mm < 1e-6) {
      continue;
    }
    if (!out.empty() && next.joined && !next.begins_run) {
      Piece& before = out.back();
      const auto corner = rounding(before, next, limits, share);
      if (corner && corner->radius_mm > kLeastRadius_mm) {
        const double feed = std::min(before.segment.feed_mm_s, next.segment.feed_mm_s);
        before = part_of(before, 0.0, geometry::foot_point(before.segment, corner->start_mm).u);
        next = part_of(next, geometry::foot_point(next.segment, corner->end_mm).u, 1.0);
        Piece arc;
        arc.plane = next.plane;
        arc.segment = arc_of(*corner, next.segment, feed);
        arc.progress_start_mm = before.progress_end_mm;
        arc.progress_end_mm = next.progress_start_mm;
        arc.joined = true;
        out.push_back(arc);
      }
    }
    out.push_back(next);
  }
  return out;
}

namespace {

/// A piece between two points, otherwise like another.
Piece straight(const Piece& like, const Point& from, const Point& to) {
  Piece piece = like;
  piece.segment = line_segment(from, to);
  piece.segment.feed_mm_s = like.segment.feed_mm_s;
  piece.segment.line = like.segment.line;
  piece.segment.motion = like.segment.motion;
  return piece;
}

/// How far the tool is behind when the command's progress is `at_mm`.
double behind_mm(const ToolMotion& motion, double at_mm) {
  const auto& states = motion.states();
  const auto found = std::ranges::lower_bound(states, at_mm - 1e-6, {}, &ToolState::progress_mm);
  return found == states.end() ? 0.0 : at_mm - found->position_mm;
}

/// The piece behind a corner, led to from beyond it.
void lead(std::vector<Piece>& out, const Piece& next, const Corner& corner) {
  Piece& before = out.back();
  const Point in = tangent_at(before.segment, 1.0);
  const Point tip =
      geometry::add_scaled(before.segment.end_mm, in, corner.beyond * corner.behind_mm);
  const double back = std::min(kBack * corner.behind_mm, 0.5 * next.segment.length_mm);
  Piece rest = part_of(next, geometry::parameter_at(next.segment, back), 1.0);
  rest.joined = false;
  if (before.segment.geometry == Geometry::line) {
    const PathSegment longer = line_segment(before.segment.start_mm, tip);
    before.segment.end_mm = longer.end_mm;
    before.segment.length_mm = longer.length_mm;
  } else {
    Piece beyond = straight(before, before.segment.end_mm, tip);
    beyond.progress_start_mm = corner.at_mm;
    beyond.begins_run = false;
    beyond.joined = true;
    out.push_back(beyond);
  }
  Piece across = straight(next, tip, rest.segment.start_mm);
  across.progress_end_mm = rest.progress_start_mm;
  out.push_back(across);
  out.push_back(rest);
}

/// The corners between pieces, and the piece behind each.
struct FoundCorners {
  std::vector<Corner> corners;
  std::vector<std::size_t> next;
};

FoundCorners find_corners(const std::vector<Piece>& pieces, const ToolMotion& motion,
                          const std::vector<Corner>& given) {
  FoundCorners found;
  auto known = given.begin();
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Piece& before = pieces[i - 1];
    const Piece& next = pieces[i];
    const bool is_corner = !next.joined && !next.begins_run && next.passes &&
                           next.segment.length_mm >= kLeastPiece_mm &&
                           before.segment.length_mm >= kLeastPiece_mm &&
                           geometry::distance(tangent_at(before.segment, 1.0),
                                              tangent_at(next.segment, 0.0)) >= kLeastTurn;
    if (!is_corner) {
      continue;
    }
    Corner corner{.at_mm = before.progress_end_mm};
    corner.behind_mm = behind_mm(motion, corner.at_mm);
    while (known != given.end() && known->at_mm < corner.at_mm - kSamePlace_mm) {
      ++known;
    }
    if (known != given.end() && known->at_mm < corner.at_mm + kSamePlace_mm) {
      corner.beyond = known->beyond;
    }
    found.corners.push_back(corner);
    found.next.push_back(i);
  }
  return found;
}

/// Its neighbours are further away than the tool lags: else the detour is not over before the next.
bool is_alone(const std::vector<Corner>& corners, std::size_t i) {
  const double room = kAlone * corners[i].behind_mm;
  return (i == 0 || corners[i].at_mm - corners[i - 1].at_mm > room) &&
         (i + 1 == corners.size() || corners[i + 1].at_mm - corners[i].at_mm > room);
}

}  // namespace

std::vector<Piece> lead_corners(const std::vector<Piece>& pieces, const ToolMotion& motion,
                                std::vector<Corner>& corners) {
  FoundCorners found = find_corners(pieces, motion, corners);
  std::vector<Piece> out;
  out.reserve(pieces.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const bool here = at < found.next.size() && found.next[at] == i;
    const std::size_t corner = here ? at++ : found.corners.size();
    if (here && is_alone(found.corners, corner) &&
        found.corners[corner].beyond * found.corners[corner].behind_mm >= kLeastLag_mm) {
      lead(out, pieces[i], found.corners[corner]);
    } else {
      out.push_back(pieces[i]);
    }
  }
  corners = std::move(found.corners);
  return out;
}

}  // namespace steadyrest::contour::offline
