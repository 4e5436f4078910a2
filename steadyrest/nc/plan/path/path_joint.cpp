// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>

// How the path goes from one piece into the next.
namespace steadyrest::nc::plan {

using interpret::PathMode;
using kernel::machine::kUnlimited;
using kernel::machine::LinuxCncPlanner;
using kernel::signal::Geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::Point;

namespace {

constexpr double kUsable = 1.0 - 1e-6;
/// LinuxCNC gives an arc up that does not fit with its radius.
constexpr double kSameRadius = 1.0 - 1e-5;

/// Within 2° of a reversal LinuxCNC stops in every mode.
bool is_reversal(const Point& in, const Point& out) {
  constexpr double kSine = 2.0 * std::numbers::pi / 180.0;
  return math::geometry::dot(in, out) < 0.0 &&
         math::geometry::norm(math::geometry::cross(in, out)) < kSine;
}

bool may_be_rounded(const Piece& before, const Piece& after) {
  return before.tolerance_mm > 0.0 && !others_move(before.segment) && !others_move(after.segment) &&
         before.plan.per_revolution == after.plan.per_revolution && !before.plan.locked &&
         !after.plan.locked;
}

}  // namespace

/// What a control without a law of its own takes: as much as there is, or the speed needs.
CornerRequest PathStream::general_request(const Piece& held, const Piece& next, const Bend& bend,
                                          double goal_mm_s) {
  const double share = machine_.control.blend_share;
  const PlaneLimits& plane = plane_of(bend.axis);
  const double kappa = pieces_.limits().centripetal_share();
  const double a_normal = kappa * plane.acceleration_mm_s2;
  const double a_tangential = std::sqrt(1.0 - kappa * kappa) * plane.acceleration_mm_s2;
  // A sliver of every piece remains, so that two corner arcs never touch.
  CornerRequest request;
  request.tolerance_mm = held.tolerance_mm;
  request.room_before_mm = kUsable * std::min(share * held.nominal_mm, held.segment.length_mm);
  request.room_after_mm = kUsable * share * next.nominal_mm;
  request.most_radius_mm =
      held.plan.per_revolution
          ? kUnlimited
          : goal_mm_s * goal_mm_s / std::min(a_normal, bend.turn_rad * a_tangential);
  return request;
}

/// Puts a tangential arc into the corner between the held piece and `next`.
bool PathStream::round_corner(Piece& next) {
  const Piece& held = places_[held_];
  if (!may_be_rounded(held, next)) {
    return false;
  }
  const auto bend = bend_of(xyz_of(held.end_direction), xyz_of(next.start_direction));
  if (!bend) {
    return false;
  }
  const double slower = std::min(held.plan.feed_mm_s, next.plan.feed_mm_s);
  const double goal = std::min({held.plan.speed_limit_mm_s, next.plan.speed_limit_mm_s,
                                machine_.feed_override.max_ratio * slower});
  const double exact = pieces_.limits().junction_mm_s(
      held.end_direction, next.start_direction, held.segment.length_mm, next.segment.length_mm);
  const double across =
      pieces_.limits().centripetal_share() * plane_of(bend->axis).acceleration_mm_s2;
  return round_corner(next, *bend, general_request(held, next, *bend, goal), exact * exact / across,
                      goal);
}

/// The same with a given request; false where the arc would be tighter than `least_radius_mm`.
/// `lasts_s`: what the arc takes instead of what its curvature permits.
bool PathStream::round_corner(Piece& next, const Bend& bend, const CornerRequest& request,
                              double least_radius_mm, double goal_mm_s, double lasts_s) {
  const Piece& held = places_[held_];
  const auto corner = plan::round_corner(held.segment, next.segment, xyz_of(held.end_direction),
                                         xyz_of(next.start_direction), bend, request);
  if (!corner || corner->radius_mm <= least_radius_mm ||
      corner->taken_before_mm <= 10.0 * kShortest_mm) {
    return false;
  }
  set_corner(*corner, held, next);
  SpeedLimits limits = pieces_.limits().circle(corner->radius_mm, plane_of(bend.axis));
  if (lasts_s > 0.0) {
    limits.speed_mm_s = corner_.segment.length_mm / lasts_s;
  }
  pieces_.limit(corner_, limits);
  put_in_corner(*corner, goal_mm_s, next);
  return true;
}

/// The arc's piece: whatever the arc does not define comes from the slower neighbour.
void PathStream::set_corner(const CornerArc& corner, const Piece& held, const Piece& next) {
  const Piece& like = held.plan.feed_mm_s <= next.plan.feed_mm_s ? held : next;
  Piece& arc = corner_;
  arc.plan = like.plan;
  arc.plan.rapid = held.plan.rapid && next.plan.rapid;
  arc.plan.from_start = held.plan.from_start || next.plan.from_start;
  arc.segment = {.geometry = Geometry::arc,
                 .motion = arc.plan.rapid ? Motion::rapid : Motion::feed,
                 .speed_modulation = like.segment.speed_modulation,
                 .line = held.segment.line,
                 .start_mm = corner.start_mm,
                 .end_mm = corner.end_mm,
                 .centre_mm = corner.centre_mm,
                 .axis = corner.axis,
                 .radius_mm = corner.radius_mm,
                 .radius_end_mm = corner.radius_mm,
                 .sweep_rad = corner.sweep_rad,
                 .other_start = held.segment.other_end,
                 .other_end = held.segment.other_end,
                 .length_mm = corner.radius_mm * corner.sweep_rad,
                 .feed_mm_s = like.segment.feed_mm_s};
  arc.nominal_mm = arc.segment.length_mm;
}

/// Makes room for the arc between the held piece and `next`; hands over the held piece and the arc.
void PathStream::put_in_corner(const CornerArc& corner, double goal_mm_s, Piece& next) {
  Piece& held = places_[held_];
  Piece& arc = corner_;
  shorten(held, corner.taken_before_mm);
  held.segment.end_mm = corner.start_mm;
  if (held.segment.radius_end_mm != held.segment.radius_mm) {
    held.segment.radius_end_mm = math::geometry::distance(corner.start_mm, held.segment.centre_mm);
  }
  const auto& control = machine_.control;
  const double gap = control.blend_gap_cycles * control.interpolator_period_s *
                     std::min(goal_mm_s, arc.plan.speed_limit_mm_s);
  if (held.segment.length_mm < gap) {
    held.plan.acceleration_mm_s2 =
        std::min(held.plan.acceleration_mm_s2, arc.plan.acceleration_mm_s2);
    held.in_arc = true;
  }
  shorten(next, corner.taken_after_mm);
  next.segment.start_mm = corner.end_mm;
  if (next.segment.radius_end_mm != next.segment.radius_mm) {
    next.segment.radius_mm = math::geometry::distance(corner.end_mm, next.segment.centre_mm);
  }
  pieces_.clip_corner_feed(arc, held, next);
  release(std::min(held.plan.speed_limit_mm_s, arc.plan.speed_limit_mm_s));
  arc.segment.exit_speed_limit_mm_s =
      std::min({arc.plan.speed_limit_mm_s, next.plan.speed_limit_mm_s, entry_mm_s_});
  emit(arc);
}

/// Shortens a piece at either end; the caller moves the end point.
void PathStream::shorten(Piece& piece, double taken_mm) {
  PathSegment& s = piece.segment;
  if (s.geometry == Geometry::arc) {
    s.sweep_rad *= 1.0 - taken_mm / s.length_mm;
  }
  s.length_mm -= taken_mm;
  piece.plan.length_mm = s.length_mm;
}

/// Decides how the path goes from the held piece into `next` and hands over the held piece.
void PathStream::join(Piece& next) {
  if (held_ == kNone) {
    return;
  }
  Piece& held = places_[held_];
  const bool probing = held.segment.motion == Motion::probe || next.segment.motion == Motion::probe;
  const bool changes =
      machine_.control.stop_between_rapid_and_feed && held.plan.rapid != next.plan.rapid;
  if (held.mode == PathMode::exact_stop || probing || changes) {
    const double settles_s = held.mode == PathMode::exact_stop ? pieces_.settle_s(held) : 0.0;
    const std::uint32_t line = held.segment.line;
    release(0.0);
    if (settles_s > 0.0) {
      receiver_.on_event(PathEvent{PathEventKind::dwell, emitted_, line, settles_s});
    }
    return;
  }
  if (pieces_.limits().has_kinks()) {
    join_at_kink(held, next);
    return;
  }
  if (held.mode == PathMode::continuous && round_corner(next)) {
    return;
  }
  const double junction = pieces_.limits().junction_mm_s(
      held.end_direction, next.start_direction, held.segment.length_mm, next.segment.length_mm);
  const double most = std::min(held.plan.speed_limit_mm_s, next.plan.speed_limit_mm_s);
  if (held.mode == PathMode::continuous && junction < most) {
    slow_beside_blend(held);
    slow_beside_blend(next);
  }
  release(std::min(junction, most));
}

/// LinuxCNC: below the threshold the corner is passed at full speed. Above it the exact path stops
/// there; in continuous mode it is rounded, blended or passed at the threshold (blend.hpp).
void PathStream::join_at_kink(Piece& held, Piece& next) {
  const double share = machine_.control.junction_share;
  const double most = std::min(held.plan.speed_limit_mm_s, next.plan.speed_limit_mm_s);
  const Point in = xyz_of(held.end_direction);
  const Point out = xyz_of(next.start_direction);
  if (is_reversal(in, out)) {
    release(0.0);
    return;
  }
  const BlendSide before = side_of(held, in, out);
  const BlendSide after = side_of(next, out, math::geometry::scale(in, -1.0));
  const double goal = std::min(before.speed_mm_s, after.speed_mm_s);
  const double kink =
      (before.arc || after.arc ? kKinkOfArcs : 1.0) *
      pieces_.limits().kink(held.end_direction, next.start_direction, goal, after.ramp_mm_s2);
  const bool lines = !before.arc && !after.arc;
  const bool goes_on = held.mode == PathMode::continuous || held.program_tolerance_mm > 0.0 ||
                       (lines && machine_.control.planner == LinuxCncPlanner::s_curve);
  const bool passes = kink < share;
  if (!passes && held.mode == PathMode::continuous &&
      blend(before, after, goal * share / kink, next)) {
    return;
  }
  for (Piece* piece : {&held, &next}) {
    piece->kink = std::max(piece->kink, std::min(kink, share));
    pieces_.slow_ramps(*piece);
  }
  release(passes ? most : goes_on ? std::min(most, goal * share / kink) : 0.0);
}

/// The faster of the ways round a corner in continuous mode; false: the sharp corner.
bool PathStream::blend(const BlendSide& before, const BlendSide& after, double sharp_mm_s,
                       Piece& next) {
  Piece& held = places_[held_];
  const double beside = machine_.control.corner_acceleration_share;
  const double guess_mm_s =
      0.5 * overlap(before, after, beside * (1.0 - machine_.control.junction_share), 0.5).kept_mm_s;
  const auto bend = bend_of(xyz_of(held.end_direction), xyz_of(next.start_direction));
  const bool flat = bend && may_be_rounded(held, next);
  if (flat) {
    const PlaneLimits& plane = plane_of(bend->axis);
    const BlendArc arc =
        blend_arc(before, after, bend->turn_rad, plane, pieces_.limits().centripetal_share());
    // A sliver of every piece remains, so that two corner arcs never touch.
    const CornerRequest request = {arc.tolerance_mm, kUsable * arc.room_before_mm,
                                   kUsable * arc.room_after_mm, arc.radius_mm};
    if (arc.speed_mm_s >= std::max(sharp_mm_s, guess_mm_s) &&
        round_corner(next, *bend, request, kSameRadius * arc.radius_mm, arc.speed_mm_s)) {
      return true;
    }
  }
  if (sharp_mm_s >= guess_mm_s) {
    return false;
  }
  slow_beside_blend(held);
  slow_beside_blend(next);
  const Overlap both = overlap(before, after, beside, 1.0);
  // The next piece reaches no more while the one before brakes.
  const double ramped_mm_s =
      both.before_mm_s * after.overlap_mm_s2(beside) / before.overlap_mm_s2(beside);
  const double slower_mm_s = std::min({both.before_mm_s, both.after_mm_s, ramped_mm_s});
  if (flat) {
    // The overlap begins and ends where the ramps do; an arc between these points takes its time.
    const double half_s = 0.5 * std::max(both.before_mm_s / before.overlap_mm_s2(beside),
                                         both.after_mm_s / after.overlap_mm_s2(beside));
    const CornerRequest request = {kUnlimited, kUsable * both.before_mm_s * half_s,
                                   kUsable * both.after_mm_s * half_s, kUnlimited};
    if (round_corner(next, *bend, request, 0.0, slower_mm_s, 2.0 * half_s)) {
      return true;
    }
  }
  release(slower_mm_s);
  return true;
}

/// A side of the corner; its direction there is `along`, and `inward` points to where an arc's
/// centre lies when it bends as the corner does.
BlendSide PathStream::side_of(const Piece& piece, const Point& along, const Point& inward) const {
  const PathSegment& s = piece.segment;
  BlendSide side;
  side.arc = s.geometry == Geometry::arc;
  side.bend = along;
  if (side.arc) {
    const Point to_centre = math::geometry::cross(s.axis, along);
    side.bend = math::geometry::unit(math::geometry::cross(to_centre, s.axis));
    side.convex = math::geometry::dot(to_centre, inward) > 0.0;
  }
  side.radius_mm = s.radius_mm;
  side.sweep_rad = s.sweep_rad;
  side.length_mm = s.length_mm;
  side.nominal_mm = piece.nominal_mm;
  side.program_tolerance_mm = piece.program_tolerance_mm;
  side.speed_mm_s =
      std::min(piece.plan.speed_limit_mm_s, machine_.feed_override.max_ratio * s.feed_mm_s);
  side.ramp_mm_s2 = pieces_.ramp_mm_s2(piece);
  return side;
}

/// Leaves a piece the share of the acceleration that is left next to a blend.
void PathStream::slow_beside_blend(Piece& out) const {
  out.beside_blend = true;
  pieces_.slow_ramps(out);
}

/// LinuxCNC enters the last piece of its queue as if it had to stop half way.
double PathStream::entry_of_last(const Piece& last) const {
  const double share =
      last.mode == PathMode::continuous ? machine_.control.corner_acceleration_share : 1.0;
  const double ramp =
      share * pieces_.ramp_mm_s2(last) * (last.segment.geometry == Geometry::arc ? 0.5 : 1.0);
  return std::sqrt(ramp * last.segment.length_mm);
}

/// The path ends or stops here.
void PathStream::rest() {
  if (waiting_ != kNone && pieces_.limits().has_kinks()) {
    entry_mm_s_ = entry_of_last(places_[waiting_]);
  }
  accept();
  entry_mm_s_ = kUnlimited;
  if (held_ != kNone && places_[held_].mode == PathMode::continuous) {
    places_[held_].beside_blend = true;
    pieces_.slow_ramps(places_[held_], Turn::as_before);
  }
  release(0.0);
}

}  // namespace steadyrest::nc::plan
