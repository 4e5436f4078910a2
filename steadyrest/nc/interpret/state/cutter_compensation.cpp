// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/state/cutter_compensation.hpp>

namespace steadyrest::nc::interpret {
namespace {

// The contour's points come in as `programmed`; the tool centre goes out, offset by the tool
// radius. Where a move ends depends on the corner after it, so each waits until the next one is
// known (cutter_compensation_waiting.cpp). `current_` is the tool centre at the end of what is
// planned so far, `start_` where the waiting move begins. Bounds and special cases are LinuxCNC
// 2.9's, found with rs274.

constexpr double kMmPerMil = 0.0254;

}  // namespace

void CutterCompensation::begin(Plane plane, const Tool& tool, const Axes& machine) {
  tool_ = tool;
  // A negative diameter in the tool table puts the tool on the other side.
  if (tool_.radius_mm < 0.0) {
    tool_.radius_mm = -tool_.radius_mm;
    tool_.side = -tool_.side;
  }
  axes_ = axes_of(plane);
  lathe_ = plane == Plane::zx;
  entered_ = false;
  stopped_ = false;
  overflow_ = false;
  waiting_.clear();
  machine_ = machine;
}

// G40: nothing follows that could shorten the waiting moves, so they keep their own end.
CutterCompensation::Fault CutterCompensation::end(bool inch) {
  return meet_at(current_, inch);
}

// A program stop releases the waiting moves, since the operator acts at that point. The move before
// it can no longer be shortened: a concave corner right after it is refused.
CutterCompensation::Fault CutterCompensation::stop(bool inch) {
  if (!active() || !entered_) {
    return Fault::none;
  }
  stopped_ = true;
  return meet_at(current_, inch);
}

PlanePoint CutterCompensation::point(const Axes& axes) const noexcept {
  return {.first = axes[axes_.first], .second = axes[axes_.second]};
}

void CutterCompensation::put(Axes& axes, PlanePoint value) const noexcept {
  axes[axes_.first] = value.first;
  axes[axes_.second] = value.second;
}

// The tool centre for a point of the contour; before the entry they are the same.
Axes CutterCompensation::centre(Axes point) const noexcept {
  if (active() && entered_) {
    put(point, current_);
  }
  return point;
}

PlanePoint CutterCompensation::to_tool(PlanePoint direction) const noexcept {
  const PlanePoint normal = left_of(direction);
  return left() ? normal : PlanePoint{.first = -normal.first, .second = -normal.second};
}

// The contour's direction from its normal: left_of() twice turns by 180°, hence the sign on the
// left side.
PlanePoint CutterCompensation::from_tool(PlanePoint normal) const noexcept {
  const PlanePoint direction = left_of(normal);
  return left() ? PlanePoint{.first = -direction.first, .second = -direction.second} : direction;
}

OffsetCircle CutterCompensation::offset_of(PlanePoint centre, double radius,
                                           int turns) const noexcept {
  // A counter-clockwise arc has its centre on the left of the path.
  const bool inside = left() == (turns > 0);
  return {.centre = centre,
          .radius = inside ? radius - tool_.radius_mm : radius + tool_.radius_mm,
          .tool_inside = inside,
          .counter_clockwise = turns > 0};
}

const Move* CutterCompensation::waiting_arc() const noexcept {
  const auto* const first =
      waiting_.empty() ? nullptr : std::get_if<WaitingMove>(&waiting_.front());
  return first != nullptr && first->move.kind == MoveKind::arc ? &first->move : nullptr;
}

// Decides how to treat a reversal (offset_corner.cpp).
bool CutterCompensation::behind_outer_arc() const noexcept {
  const Move* const arc = waiting_arc();
  return arc != nullptr && left() != (arc->turns > 0);
}

CutterCompensation::Fault CutterCompensation::line(const Move& move, const Axes& programmed,
                                                   bool inch) {
  const double radius = tool_.radius_mm;
  const PlanePoint from = point(programmed);
  const PlanePoint to = point(move.end);
  Move offset = move;
  // The entry: straight from the tool's position to the offset of the programmed end.
  if (!entered_) {
    current_ = from;
    if (length(between(from, to)) <= radius) {
      return Fault::entry_too_short;
    }
    start_ = from;
    current_ = along(to, to_tool(unit(between(from, to))), radius);
    put(offset.end, current_);
    entered_ = true;
    return wait(offset, to_tool(unit(between(from, to))), 0.0);
  }
  const PlanePoint way = between(from, to);
  if (way.first == 0.0 && way.second == 0.0) {  // only other axes
    put(offset.end, current_);
    return wait(offset, way, 0.0);
  }
  const PlanePoint direction = unit(way);
  const PlanePoint normal = to_tool(direction);
  // The tool is on the contour's normal at the corner, so its position gives the direction before
  // the corner, whatever the kind of the previous move.
  const double turn = turn_between(from_tool(unit(between(from, current_))), direction, tool_.side);
  const Corner corner = kind_of(turn, behind_outer_arc());
  if (corner == Corner::concave) {
    // Both offsets end where they cross, so the previous move must still be here to be shortened.
    if (waiting_.empty() || stopped_) {
      return Fault::after_stop;
    }
    PlanePoint meet;
    Fault fault = line_corner(from, direction, turn, meet);
    fault = fault != Fault::none ? fault : meet_at(meet, inch);
    if (fault != Fault::none) {
      return fault;
    }
  } else {
    // Tangent or convex: the previous move keeps its end. A convex corner gets an arc about the
    // contour's point.
    const Fault fault = corner == Corner::convex ? meet_at(current_, inch) : Fault::none;
    if (fault != Fault::none) {
      return fault;
    }
    release();
    start_ = current_;
    if (corner == Corner::convex) {
      join(move, programmed, normal);
    }
  }
  current_ = along(to, normal, radius);
  put(offset.end, current_);
  return wait(offset, way, 0.0);
}

// An arc about the contour's corner, for G0 a straight line, with the other axes where they were
// before the move.
void CutterCompensation::join(const Move& move, const Axes& programmed, PlanePoint normal) {
  const PlanePoint corner = point(programmed);
  Move arc = move;
  arc.end = programmed;
  start_ = along(corner, normal, tool_.radius_mm);
  put(arc.end, start_);
  if (move.kind != MoveKind::rapid) {
    arc.kind = MoveKind::arc;
    arc.centre_mm = {};
    arc.centre_mm[axes_.first] = corner.first;
    arc.centre_mm[axes_.second] = corner.second;
    arc.normal = {};
    arc.normal[axes_.normal] = 1.0;
    arc.turns = left() ? -1 : 1;
  }
  send(arc);
}

CutterCompensation::Fault CutterCompensation::line_corner(PlanePoint corner, PlanePoint direction,
                                                          double turn, PlanePoint& meet) const {
  if (const Move* const arc = waiting_arc(); arc != nullptr) {
    const PlanePoint centre{.first = arc->centre_mm[axes_.first],
                            .second = arc->centre_mm[axes_.second]};
    OffsetCircle circle = offset_of(centre, 0.0, arc->turns);
    circle.radius = length(between(centre, point(arc->end)));
    const PlanePoint normal = to_tool(direction);
    // An entry arc's centre may lie beyond its end: the contour's radius is measured from the
    // offset.
    const double contour =
        circle.radius + (circle.tool_inside ? tool_.radius_mm : -tool_.radius_mm);
    const double height = contour * dot(unit(between(corner, centre)), normal);
    const auto found = crossing(circle, normal, direction, height, tool_.radius_mm, true);
    meet = found.value_or(PlanePoint{});
    return found ? Fault::none : Fault::does_not_fit;
  }
  // Both offset lines pass the corner at the distance r. Their crossing lies r·tan(turn/2) before
  // the end of the first.
  const PlanePoint before = from_tool(unit(between(corner, current_)));
  meet = along(current_, before, -tool_.radius_mm * std::tan(0.5 * turn));
  return Fault::none;
}

CutterCompensation::Fault CutterCompensation::arc_corner(const Move& move, PlanePoint corner,
                                                         PlanePoint& meet) const {
  const PlanePoint centre{.first = move.centre_mm[axes_.first],
                          .second = move.centre_mm[axes_.second]};
  const double radius = length(between(centre, point(move.end)));
  const OffsetCircle after = offset_of(centre, radius, move.turns);
  if (const Move* const arc = waiting_arc(); arc != nullptr) {
    const PlanePoint old{.first = arc->centre_mm[axes_.first],
                         .second = arc->centre_mm[axes_.second]};
    OffsetCircle before = offset_of(old, 0.0, arc->turns);
    before.radius = length(between(old, point(arc->end)));
    // Concentric circles coincide or never meet: there is no corner point.
    if (before.radius == 0.0 || length(between(old, centre)) == 0.0) {
      return Fault::same_centre;
    }
    const auto found = crossing(before, after);
    meet = found.value_or(PlanePoint{});
    return found ? Fault::none : Fault::does_not_fit;
  }
  const PlanePoint normal = unit(between(corner, current_));
  // Height of the arc's centre above the tangent line at the corner, for the crossing of a line and
  // a circle.
  const double height = radius * dot(unit(between(corner, centre)), normal);
  const auto found = crossing(after, normal, from_tool(normal), height, tool_.radius_mm, false);
  meet = found.value_or(PlanePoint{});
  return found ? Fault::none : Fault::does_not_fit;
}

// A new arc from the start to the offset of the end: its centre is where the end's radius meets the
// perpendicular bisector of the chord.
CutterCompensation::Fault CutterCompensation::entry_arc(const Move& move, PlanePoint end,
                                                        PlanePoint& centre) const {
  const PlanePoint old{.first = move.centre_mm[axes_.first],
                       .second = move.centre_mm[axes_.second]};
  const PlanePoint inwards = unit(between(end, old));
  const PlanePoint chord = between(end, current_);
  // The centre is equally far from the tool's position and the end: in this isosceles triangle the
  // leg is half the chord divided by the cosine of the angle at the end.
  const double cosine = dot(unit(chord), inwards);
  if (std::abs(cosine) < 1e-6) {
    return Fault::entry_arc;
  }
  centre = along(end, inwards, 0.5 * length(chord) / cosine);
  return Fault::none;
}

// The first compensated move, an arc: from the tool's position to the offset of the arc's end.
CutterCompensation::Fault CutterCompensation::enter_on_arc(const Move& move, const Axes& programmed,
                                                           PlanePoint end) {
  const PlanePoint from = point(programmed);
  current_ = from;
  if (length(between(from, point(move.end))) <= tool_.radius_mm) {
    return Fault::entry_too_short;
  }
  PlanePoint moved;
  if (const Fault fault = entry_arc(move, end, moved); fault != Fault::none) {
    return fault;
  }
  start_ = from;
  entered_ = true;
  if (lathe_ && tool_.orientation != 0 && tool_.orientation != 9) {
    Move first = move;  // the tool point goes to its place first
    first.kind = MoveKind::linear;
    first.end = programmed;
    first.centre_mm = {};
    first.normal = {};
    first.turns = 0;
    static_cast<void>(wait(first, {}, 0.0));
  }
  Move offset = move;
  put(offset.end, end);
  offset.centre_mm[axes_.first] = moved.first;
  offset.centre_mm[axes_.second] = moved.second;
  current_ = end;
  return wait(offset, {}, 0.0);
}

// The corner before an arc: the waiting moves end there, or go out and are joined to the arc.
CutterCompensation::Fault CutterCompensation::turn_into_arc(const Move& move,
                                                            const Axes& programmed,
                                                            bool tool_inside, bool inch) {
  const PlanePoint from = point(programmed);
  const PlanePoint centre{.first = move.centre_mm[axes_.first],
                          .second = move.centre_mm[axes_.second]};
  // The tangent at the arc's start is perpendicular to the radius there.
  const PlanePoint across = unit(between(from, centre));
  PlanePoint direction = left_of(across);  // clockwise
  if (move.turns > 0) {
    direction = {.first = -direction.first, .second = -direction.second};
  }
  const double turn = turn_between(from_tool(unit(between(from, current_))), direction, tool_.side);
  const Corner corner = kind_of(turn, !tool_inside);
  if (corner == Corner::concave) {
    if (waiting_.empty() || stopped_) {
      return Fault::after_stop;
    }
    PlanePoint meet;
    const Fault fault = arc_corner(move, from, meet);
    return fault != Fault::none ? fault : meet_at(meet, inch);
  }
  release();
  start_ = current_;
  if (corner == Corner::convex) {
    join(move, programmed, to_tool(direction));
  }
  return Fault::none;
}

CutterCompensation::Fault CutterCompensation::arc(const Move& move, const Axes& programmed,
                                                  bool inch) {
  const PlanePoint to = point(move.end);
  const PlanePoint centre{.first = move.centre_mm[axes_.first],
                          .second = move.centre_mm[axes_.second]};
  const OffsetCircle circle = offset_of(centre, length(between(centre, to)), move.turns);
  const PlanePoint outwards = unit(between(centre, to));
  const PlanePoint end =
      along(to, outwards, circle.tool_inside ? -tool_.radius_mm : tool_.radius_mm);
  // Inside, the tool centre runs on R − r: nothing remains of the arc.
  if (circle.tool_inside && circle.radius <= 0.0) {
    return Fault::arc_too_small;
  }
  if (!entered_) {
    return enter_on_arc(move, programmed, end);
  }
  if (const Fault fault = turn_into_arc(move, programmed, circle.tool_inside, inch);
      fault != Fault::none) {
    return fault;
  }
  Move offset = move;
  put(offset.end, end);
  const double angle = swept(point(programmed), to, centre, move.turns);
  current_ = end;
  return wait(offset, {}, angle);
}

// All waiting moves end at the corner found and go out.
CutterCompensation::Fault CutterCompensation::meet_at(PlanePoint meet, bool inch) {
  for (Waiting& one : waiting_) {
    auto* const waiting = std::get_if<WaitingMove>(&one);
    if (waiting == nullptr || !waiting->in_plane) {
      continue;
    }
    Move& move = waiting->move;
    if (move.kind == MoveKind::arc) {
      const PlanePoint centre{.first = move.centre_mm[axes_.first],
                              .second = move.centre_mm[axes_.second]};
      // The crossing must lie on the arc's own circle; otherwise the corner came from another arc.
      const double miss =
          std::abs(length(between(centre, point(move.end))) - length(between(centre, meet)));
      if (miss > (inch ? 0.01 * kMmPerInch : 0.01)) {
        return Fault::arc_broken;
      }
      // Shortened at a corner, the arc may sweep less than the contour but never more: more means
      // running all the way round. LinuxCNC applies its length tolerance to this angle.
      const double angle = swept(start_, meet, centre, move.turns);
      if (waiting->angle != 0.0 &&
          std::abs(angle) > std::abs(waiting->angle) + (inch ? 0.001 : kMmPerMil)) {
        return Fault::runs_backwards;
      }
    } else if (dot(waiting->direction, between(start_, meet)) < 0.0) {
      // The new end lies before the start: the tool does not fit between the two corners.
      return Fault::runs_backwards;
    }
    put(move.end, meet);
  }
  release();
  start_ = meet;
  return Fault::none;
}

}  // namespace steadyrest::nc::interpret
