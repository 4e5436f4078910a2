// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/motion/contour_corners.hpp>
#include <steadyrest/nc/interpret/motion/plane_element.hpp>

namespace steadyrest::nc::interpret {
namespace {

/// Sine of the smallest corner.
constexpr double kLeastCorner = 1e-6;
constexpr std::size_t kMostWaitingEvents = 16;

bool is_cut(const Move& move) noexcept {
  return move.kind == MoveKind::linear || move.kind == MoveKind::arc;
}

/// Ends `before` and begins `after` at the corner's own ends.
void join_at(Move& before, Move& corner, Move& after, PlaneAxes axes, PlanePoint from,
             PlanePoint to) noexcept {
  corner.start = before.end;
  corner.start[axes.first] = from.first;
  corner.start[axes.second] = from.second;
  corner.end = corner.start;
  corner.end[axes.first] = to.first;
  corner.end[axes.second] = to.second;
  before.end = corner.start;
  after.start = corner.end;
}

}  // namespace

void ContourCorners::round(double length_mm, bool chamfer, double feed_mm_s, std::uint32_t line) {
  if (!held_ || open_) {
    fault_ = fault_ == Fault::none ? Fault::nothing_before : fault_;
    line_ = line;
    return;
  }
  open_ = true;
  chamfer_ = chamfer;
  length_mm_ = length_mm;
  feed_mm_s_ = feed_mm_s;
  line_ = line;
}

void ContourCorners::release() {
  if (held_) {
    out_->on_move(*held_);
    held_.reset();
  }
}

// Spindle and coolant words of the second block act before it; anything else cannot be in between.
void ContourCorners::on_event(const Event& event) {
  if (!open_) {
    release();
    out_->on_event(event);
    return;
  }
  const bool harmless = event.kind == EventKind::spindle || event.kind == EventKind::coolant;
  if (!harmless || events_.size() == kMostWaitingEvents) {
    fault_ = Fault::nothing_after;
    return;
  }
  events_.push_back(event);
}

void ContourCorners::note_heading(const Move& move) {
  heading_.reset();
  if (is_cut(move) || move.kind == MoveKind::rapid) {
    const PlaneElement element(move, axes_of(plane_));
    if (element.in_plane()) {
      const PlanePoint tangent = element.end_tangent();
      heading_ = {tangent.first, tangent.second};
    }
  }
}

void ContourCorners::on_move(const Move& move) {
  if (move.kind != MoveKind::dwell) {
    note_heading(move);
  }
  if (open_) {
    join(move);
    return;
  }
  release();
  if (is_cut(move)) {
    held_ = move;
  } else {
    out_->on_move(move);
  }
}

void ContourCorners::join(const Move& next) {
  if (!is_cut(next)) {
    fault_ = Fault::nothing_after;
    return;
  }
  Move first = *held_;
  Move second = next;
  Move corner = *held_;
  corner.line = line_;
  corner.feed_mm_s = feed_mm_s_ > 0.0 ? feed_mm_s_ : corner.feed_mm_s;
  corner.after_rest = false;
  const Fault fault =
      chamfer_ ? chamfer(next, first, corner, second) : fillet(next, first, corner, second);
  if (fault != Fault::none) {
    fault_ = fault;
    return;
  }
  out_->on_move(first);
  out_->on_move(corner);
  for (const Event& event : events_) {
    out_->on_event(event);
  }
  events_.clear();
  open_ = false;
  held_ = second;
}

ContourCorners::Fault ContourCorners::chamfer(const Move& next, Move& first, Move& corner,
                                              Move& second) const {
  const PlaneAxes axes = axes_of(plane_);
  const PlaneElement a(*held_, axes);
  const PlaneElement b(next, axes);
  if (a.arc() || b.arc()) {
    return Fault::not_lines;
  }
  if (!a.in_plane() || !b.in_plane()) {
    return Fault::off_plane;
  }
  const PlanePoint in = a.end_tangent();
  const PlanePoint out = b.start_tangent();
  if (std::abs(in.first * out.second - in.second * out.first) < kLeastCorner) {
    return Fault::no_corner;
  }
  if (length_mm_ > a.length_mm() || length_mm_ > b.length_mm()) {
    return Fault::does_not_fit;
  }
  const PlanePoint at = a.end();
  join_at(
      first, corner, second, axes,
      {.first = at.first - length_mm_ * in.first, .second = at.second - length_mm_ * in.second},
      {.first = at.first + length_mm_ * out.first, .second = at.second + length_mm_ * out.second});
  return Fault::none;
}

ContourCorners::Fault ContourCorners::fillet(const Move& next, Move& first, Move& corner,
                                             Move& second) const {
  const PlaneAxes axes = axes_of(plane_);
  const PlaneElement a(*held_, axes);
  const PlaneElement b(next, axes);
  if (!a.in_plane() || !b.in_plane()) {
    return Fault::off_plane;
  }
  const PlanePoint in = a.end_tangent();
  const PlanePoint out = b.start_tangent();
  const double sine = in.first * out.second - in.second * out.first;
  if (std::abs(sine) < kLeastCorner) {
    return Fault::no_corner;
  }
  const double turn = sine > 0.0 ? 1.0 : -1.0;
  std::array<PlanePoint, 2> centres;
  const std::size_t count = PlaneElement::offset_crossings(a, b, turn * length_mm_, centres);
  double nearest = 0.0;
  bool found = false;
  for (std::size_t i = 0; i < count; ++i) {
    PlanePoint from;
    PlanePoint to;
    const double away =
        std::hypot(centres[i].first - a.end().first, centres[i].second - a.end().second);
    if (a.foot(centres[i], from) && b.foot(centres[i], to) && (!found || away < nearest)) {
      found = true;
      nearest = away;
      join_at(first, corner, second, axes, from, to);
      corner.centre_mm = {corner.start[0], corner.start[1], corner.start[2]};
      corner.centre_mm[axes.first] = centres[i].first;
      corner.centre_mm[axes.second] = centres[i].second;
    }
  }
  corner.kind = MoveKind::arc;
  corner.normal = {};
  corner.normal[axes.normal] = 1.0;
  corner.turns = turn > 0.0 ? 1 : -1;
  return found ? Fault::none : Fault::does_not_fit;
}

}  // namespace steadyrest::nc::interpret
