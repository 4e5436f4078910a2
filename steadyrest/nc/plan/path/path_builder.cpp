// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/state/spline_curve.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/path/spline_lines.hpp>

namespace steadyrest::nc::plan {

using interpret::FeedMode;
using interpret::merge_tolerance_mm;
using interpret::Move;
using interpret::MoveKind;
using interpret::PathMode;
using kernel::machine::Machine;
using kernel::outcome::bad_input;
using kernel::outcome::Result;
using kernel::signal::Geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using math::geometry::add_scaled;
using math::geometry::dot;
using math::geometry::norm;
using math::geometry::subtract;

namespace {

// A move is built in a free place, waits there for merging (waiting_), then for its corner (held_),
// and goes out once the corner is decided. Three places are enough.

/// A spline is planned as chords within this distance.
constexpr double kSplineTolerance_mm = 5e-4;
constexpr std::size_t kMostMerged = 512;

}  // namespace

PathStream::PathStream(const Machine& machine, PathReceiver& receiver)
    : machine_(machine),
      receiver_(receiver),
      pieces_(machine),
      plane_(pieces_.limits().plane(plane_normal_)) {}

const PlaneLimits& PathStream::plane_of(const Point& normal) noexcept {
  if (normal != plane_normal_) {
    plane_normal_ = normal;
    plane_ = pieces_.limits().plane(normal);
  }
  return plane_;
}

void PathStream::emit(Piece& out) {
  out.segment.position_mm = position_mm_;
  out.plan.exit_speed_limit_mm_s = out.segment.exit_speed_limit_mm_s;
  position_mm_ += out.segment.length_mm;
  ++emitted_;
  receiver_.on_segment(out.segment, out.plan);
}

void PathStream::release(double exit_speed_limit_mm_s) {
  if (held_ == kNone) {
    return;
  }
  places_[held_].segment.exit_speed_limit_mm_s = std::min(exit_speed_limit_mm_s, entry_mm_s_);
  pieces_.limit_rest(places_[held_]);
  pieces_.clip_feed(places_[held_]);
  emit(places_[held_]);
  held_ = kNone;
}

/// Merges `next` into the waiting line when every point between stays within the merge tolerance.
bool PathStream::merge(const Piece& next) {
  Piece& line = places_[waiting_];
  const double tolerance = line.merge_tolerance_mm;
  if (!(tolerance > 0.0)) {
    return false;
  }
  const bool alike = line.segment.motion == Motion::feed && next.segment.motion == Motion::feed &&
                     line.segment.geometry == Geometry::line &&
                     next.segment.geometry == Geometry::line && next.mode == line.mode &&
                     next.plan.feed_mm_s == line.plan.feed_mm_s &&
                     next.plan.per_revolution == line.plan.per_revolution &&
                     next.plan.from_start == line.plan.from_start &&
                     next.segment.speed_modulation == line.segment.speed_modulation;
  if (!alike || line.mode != PathMode::continuous || others_move(line.segment) ||
      others_move(next.segment) || merged_.size() >= kMostMerged) {
    return false;
  }
  const Point from = line.segment.start_mm;
  Point chord = subtract(next.segment.end_mm, from);
  const double length = norm(chord);
  if (length <= kShortest_mm) {
    return false;
  }
  for (double& c : chord) {
    c /= length;
  }
  const auto near = [&](const Point& p) {
    const Point to = subtract(p, from);
    const double along = dot(to, chord);
    return along >= 0.0 && along <= length && norm(add_scaled(to, chord, -along)) <= tolerance;
  };
  if (!near(line.segment.end_mm) || !std::all_of(merged_.begin(), merged_.end(), near)) {
    return false;
  }
  merged_.push_back(line.segment.end_mm);
  line.segment.end_mm = next.segment.end_mm;
  line.segment.length_mm = length;
  line.nominal_mm = length;
  pieces_.limit(line);
  return true;
}

/// Passes the waiting piece on to its corner.
void PathStream::accept() {
  if (waiting_ == kNone) {
    return;
  }
  join(places_[waiting_]);
  held_ = std::exchange(waiting_, kNone);
  merged_.clear();
}

/// An arc that is a line within the merge tolerance becomes two, over its middle; LinuxCNC does so
/// in the XY plane under G64 P (manual, G64).
bool PathStream::split_flat_arc(const Move& move) {
  const double tolerance_mm = machine_.control.merge_share * merge_tolerance_mm(move);
  if (move.kind != MoveKind::arc || move.path_mode != PathMode::continuous ||
      move.feed_mode == FeedMode::inverse_time || move.override_locked || !(tolerance_mm > 0.0) ||
      move.normal[2] == 0.0 || std::abs(move.turns) > 1) {
    return false;
  }
  PathSegment arc;
  arc.start_mm = {move.start[0], move.start[1], move.start[2]};
  arc.end_mm = {move.end[0], move.end[1], move.end[2]};
  Move bare = move;
  bare.offset = {};
  bare.rotation_deg = 0.0;
  set_arc(arc, bare);
  if (arc.radius_mm * (1.0 - std::cos(arc.sweep_rad / 2.0)) >= tolerance_mm) {
    return false;
  }
  Move first = move;
  first.kind = MoveKind::linear;
  Move second = first;
  for (std::size_t i = 0; i < first.end.size(); ++i) {
    first.end[i] = (move.start[i] + move.end[i]) / 2.0;
  }
  const Point middle = math::geometry::point_at(arc, 0.5);
  std::copy(middle.begin(), middle.begin() + 2, first.end.begin());
  second.start = first.end;
  on_move(first);
  on_move(second);
  return true;
}

void PathStream::on_move(const Move& move) {
  if (refusal_ || split_flat_arc(move)) {
    return;
  }
  if (move.kind == MoveKind::spline) {
    if (move.spline_order < 2 || interpret::spline_spans(move.spline, move.spline_order) < 1) {
      refusal_ = bad_input("", move.line, "a spline without its control points",
                           "output lines or arcs from the CAM system");
      return;
    }
    spline_lines(move, kSplineTolerance_mm, [this](const Move& line) { on_move(line); });
    return;
  }
  if (move.after_rest) {
    rest();
  }
  if (move.kind == MoveKind::dwell) {
    refusal_ = least_.add_dwell(move);
    if (!refusal_) {
      event(PathEventKind::dwell, move.line, move.dwell_s);
    }
    return;
  }
  Piece& next = places_[next_];
  const auto made = pieces_.make(move, next);
  if (!made) {
    refusal_ = made.error();
    return;
  }
  refusal_ = *made ? least_.add(next, move) : std::nullopt;
  if (!*made || refusal_) {
    return;
  }
  if (spindle_pending_ && !next.plan.rapid) {
    spindle_pending_ = false;
    event(PathEventKind::spindle_wait, spindle_line_, spindle_rev_s_);
  }
  if (waiting_ != kNone && merge(next)) {
    return;
  }
  accept();
  waiting_ = next_;
  // The places are 0, 1, 2 and add up to 3: the remainder is the free one.
  next_ = held_ == kNone ? (waiting_ + 1) % kNone : kNone - held_ - waiting_;
}

void PathStream::event(PathEventKind kind, std::uint32_t line, double value) {
  rest();
  receiver_.on_event(PathEvent{kind, emitted_, line, value});
}

void PathStream::on_event(const interpret::Event& e) {
  if (refusal_) {
    return;
  }
  switch (e.kind) {
    case interpret::EventKind::spindle:
      spindle_pending_ = e.value != 0.0;
      spindle_line_ = e.line;
      // The drive turns no faster, whatever S asks for.
      spindle_rev_s_ = std::clamp(e.value, -machine_.spindle.max_rev_s, machine_.spindle.max_rev_s);
      event(PathEventKind::spindle, e.line, spindle_rev_s_);
      break;
    case interpret::EventKind::coolant:
      event(PathEventKind::coolant, e.line, e.value);
      break;
    case interpret::EventKind::tool_change:
      event(PathEventKind::tool_change, e.line, e.value);
      break;
    case interpret::EventKind::stop:
      event(PathEventKind::stop, e.line, e.value);
      break;
    case interpret::EventKind::end:
      event(PathEventKind::end, e.line, e.value);
      break;
  }
}

Result<PlannedPath> PathBuilder::take() {
  stream_.finish();
  if (stream_.refusal()) {
    return std::unexpected(*stream_.refusal());
  }
  return std::move(store_.path);
}

}  // namespace steadyrest::nc::plan
