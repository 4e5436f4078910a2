// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/plan/path/axes_at.hpp>
#include <steadyrest/nc/plan/path/piece.hpp>

namespace steadyrest::nc::plan {

using interpret::Axes;
using interpret::FeedMode;
using interpret::merge_tolerance_mm;
using interpret::Move;
using interpret::MoveKind;
using kernel::machine::least_block_s;
using kernel::machine::Machine;
using kernel::outcome::Result;
using kernel::signal::AxisValues;
using kernel::signal::Geometry;
using kernel::signal::kMaxAxes;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using math::geometry::add_scaled;
using math::geometry::dot;
using math::geometry::norm;
using math::geometry::subtract;

namespace {

constexpr double kSameRadius_mm = 1e-7;
constexpr std::size_t kNoAxis = ~std::size_t{0};

Motion motion_of(const Move& move) {
  switch (move.kind) {
    case MoveKind::rapid:
      return Motion::rapid;
    case MoveKind::probe:
      return Motion::probe;
    case MoveKind::thread:
      return Motion::thread;
    default:
      return move.override_locked ? Motion::tap : Motion::feed;
  }
}

/// The length that the feed refers to: X Y Z; without them U V W; without them the angle in
/// degrees.
double line_length(const PathSegment& s, const std::array<bool, kMaxAxes>& rotary) {
  const double main = norm(subtract(s.end_mm, s.start_mm));
  if (!(main <= kShortest_mm)) {  // including NaN, which is refused above
    return main;
  }
  double linear = 0.0;
  double angle = 0.0;
  for (std::size_t i = 0; i < s.other_start.size(); ++i) {
    const double delta = s.other_end[i] - s.other_start[i];
    (rotary[i + 3] ? angle : linear) += delta * delta;
  }
  // Rotary motion alone: a feed in mm/min then means degrees per minute.
  linear = std::sqrt(linear);
  return linear > kShortest_mm ? linear : kernel::units::deg_from_rad(std::sqrt(angle));
}

/// What axes_at() gives for a line.
AxisValues line_direction(const PathSegment& s) {
  AxisValues out{};
  const double per_mm = s.length_mm > 0.0 ? 1.0 / s.length_mm : 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = (s.end_mm[i] - s.start_mm[i]) * per_mm;
  }
  for (std::size_t i = 0; i < s.other_start.size(); ++i) {
    out[i + 3] = (s.other_end[i] - s.other_start[i]) * per_mm;
  }
  return out;
}

}  // namespace

// The axis carries the sense of rotation: segments have only counter-clockwise arcs, with a
// positive sweep. The normal turns with the work offset's rotation, as the centre does.
void set_arc(PathSegment& s, const Move& move) {
  s.geometry = Geometry::arc;
  const double sign = move.turns < 0 ? -1.0 : 1.0;
  const auto& c = move.centre_mm;
  const auto centre = interpret::machine_of(move, {c[0], c[1], c[2]});
  const auto normal =
      interpret::turned({move.normal[0], move.normal[1], move.normal[2]}, move.rotation_deg);
  for (std::size_t i = 0; i < 3; ++i) {
    s.centre_mm[i] = centre[i];
    s.axis[i] = sign * normal[i];
  }
  // The interpreter's centre may lie anywhere along the normal; bring it to the start's height.
  const double lift = dot(subtract(s.start_mm, s.centre_mm), s.axis);
  s.centre_mm = add_scaled(s.centre_mm, s.axis, lift);
  const Point from = subtract(s.start_mm, s.centre_mm);
  Point to = subtract(s.end_mm, s.centre_mm);
  s.rise_mm = dot(to, s.axis);
  to = add_scaled(to, s.axis, -s.rise_mm);
  s.radius_mm = norm(from);
  s.radius_end_mm = norm(to);
  // The program's digits are rounded: nearly equal radii mean a circle, not a spiral.
  if (std::abs(s.radius_end_mm - s.radius_mm) < kSameRadius_mm) {
    s.radius_end_mm = s.radius_mm;
  }
  // e1 points from the centre to the start, so the end's angle in this frame is the sweep of the
  // first turn. |turns| counts turns begun: each beyond the first adds a full one.
  const auto frame = math::geometry::arc_frame(s);
  double angle = std::atan2(dot(to, frame.e2), dot(to, frame.e1));
  if (angle <= 1e-9) {  // the end is at or before the start: up to one more turn
    angle += 2.0 * std::numbers::pi;
  }
  s.sweep_rad = angle + 2.0 * std::numbers::pi * (std::max(1, std::abs(move.turns)) - 1);
  s.length_mm = math::geometry::arc_length_mm(s);
}

// The machine file lists axes in any order after X, Y, Z; the first letter of a name tells the
// program's axis. A B C are rotary: rad inside, degrees in the program.
PieceMaker::PieceMaker(const Machine& machine)
    : machine_(machine), limits_(machine.axes, machine.control) {
  axis_of_ = {0, 1, 2, kNoAxis, kNoAxis, kNoAxis, kNoAxis, kNoAxis, kNoAxis};
  for (std::size_t i = 3; i < std::min(machine.axes.size(), kMaxAxes); ++i) {
    for (std::size_t letter = 3; letter < axis_of_.size(); ++letter) {
      if (!machine.axes[i].name.empty() &&
          machine.axes[i].name[0] == interpret::kAxisLetters[letter]) {
        axis_of_[letter] = i;
        rotary_[i] = letter < 6;
        others_ = true;
      }
    }
  }
}

AxisValues PieceMaker::machine_position(const Move& move, const Axes& work) const {
  AxisValues out{};
  if (move.rotation_deg == 0.0 && !others_) {  // nearly always
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = work[i] + move.offset[i];
    }
    return out;
  }
  const Axes machine = interpret::machine_of(move, work);
  for (std::size_t letter = 0; letter < machine.size(); ++letter) {
    const std::size_t axis = axis_of_[letter];
    if (axis != kNoAxis) {
      const double value = machine[letter];
      out[axis] = letter >= 3 && letter < 6 ? kernel::units::rad_from_deg(value) : value;
    }
  }
  return out;
}

/// Spindle speed of a move, at most the machine's. G96 keeps the cutting speed at the mean radius
/// |X| of the move.
double PieceMaker::spindle_of(const PathSegment& s, const Move& move) const {
  double most = machine_.spindle.max_rev_s;
  if (move.surface_speed_mm_s == 0.0) {
    return std::clamp(move.spindle_rev_s, -most, most);
  }
  if (move.spindle_limit_rev_s > 0.0) {
    most = std::min(most, move.spindle_limit_rev_s);
  }
  // The spindle's centre line is X = 0 of the machine. One speed for the whole move: its mean
  // radius.
  const double radius = 0.5 * (std::abs(s.start_mm[0]) + std::abs(s.end_mm[0]));
  const double wanted =
      std::abs(move.surface_speed_mm_s) / (2.0 * std::numbers::pi * std::max(radius, kShortest_mm));
  return std::copysign(std::min(wanted, most), move.surface_speed_mm_s);
}

// G93 gives moves per second, so feed times length is mm/s. A feed per revolution stays mm/rev in
// the plan, where the interpolator multiplies it by the actual spindle speed; the segment's own
// feed is the value at the commanded speed.
void PieceMaker::set_speed(Piece& out, const Move& move) const {
  SegmentPlan& p = out.plan;
  p.rapid = move.kind == MoveKind::rapid;
  p.locked = !p.rapid && (move.override_locked || move.kind == MoveKind::thread ||
                          move.kind == MoveKind::probe);
  p.per_revolution = !p.rapid && move.feed_mode == FeedMode::per_revolution;
  p.feed_mm_s = move.feed_mm_s;
  if (move.feed_mode == FeedMode::inverse_time) {
    p.feed_mm_s = move.feed_mm_s * out.segment.length_mm;
  }
  const double spindle = spindle_of(out.segment, move);
  p.spindle_rev_s = move.surface_speed_mm_s != 0.0 ? spindle : 0.0;
  out.segment.feed_mm_s = p.per_revolution ? p.feed_mm_s * std::abs(spindle) : p.feed_mm_s;
}

bool PieceMaker::clips(const Piece& piece) const {
  return machine_.control.clips_programmed_feed && !piece.plan.rapid && !piece.plan.per_revolution;
}

void PieceMaker::clip_feed(Piece& out) const {
  if (clips(out)) {
    out.plan.feed_mm_s = clipped_feed(out);
    out.segment.feed_mm_s = out.plan.feed_mm_s;
  }
}

void PieceMaker::clip_corner_feed(Piece& arc, const Piece& before, const Piece& after) const {
  if (clips(arc)) {
    arc.plan.feed_mm_s = std::max(clipped_feed(before), clipped_feed(after));
    arc.segment.feed_mm_s = arc.plan.feed_mm_s;
  }
}

/// What the axes permit of F.
double PieceMaker::clipped_feed(const Piece& piece) const {
  const double feed = piece.plan.feed_mm_s;
  if (!clips(piece)) {
    return feed;
  }
  const PathSegment& s = piece.segment;
  return std::min(feed, s.geometry == Geometry::line ? limits_.line(line_direction(s)).speed_mm_s
                                                     : fastest_arc(s));
}

/// The speed that LinuxCNC gives an arc (2.9, measured): around it that of the slowest axis of its
/// plane, and what the least acceleration of these axes permits across the path at the tight end;
/// along a helix the time that the other axes take.
double PieceMaker::fastest_arc(const PathSegment& s) const {
  double speed_mm_s = kernel::machine::kUnlimited;
  double acceleration_mm_s2 = kernel::machine::kUnlimited;
  double least_s = 0.0;
  for (std::size_t i = 0; i < std::min(machine_.axes.size(), kMaxAxes); ++i) {
    const auto& axis = machine_.axes[i];
    if (i < 3 && std::abs(s.axis[i]) < 1.0 - 1e-9) {
      speed_mm_s = std::min(speed_mm_s, axis.max_speed_au_s);
      acceleration_mm_s2 = std::min(acceleration_mm_s2, axis.max_acceleration_au_s2);
    }
    const double travel =
        i < 3 ? s.end_mm[i] - s.start_mm[i] : s.other_end[i - 3] - s.other_start[i - 3];
    least_s = std::max(least_s, std::abs(travel) / axis.max_speed_au_s);
  }
  const double wider_mm = s.radius_end_mm - s.radius_mm;
  const double tight_mm = std::min(s.radius_mm, s.radius_end_mm);
  const double radius_mm = std::hypot(tight_mm, wider_mm / s.sweep_rad);
  const double across_mm_s =
      std::sqrt(limits_.centripetal_share() * acceleration_mm_s2 * radius_mm);
  const double around_mm = std::hypot(tight_mm * s.sweep_rad, wider_mm);
  least_s = std::max(least_s, around_mm / std::min(speed_mm_s, across_mm_s));
  return std::hypot(around_mm, s.rise_mm) / least_s;
}

void PieceMaker::limit(Piece& out) const {
  if (out.segment.geometry == Geometry::arc) {
    limit(out, limits_.arc(out.segment));
    return;
  }
  out.start_direction = line_direction(out.segment);
  out.end_direction = out.start_direction;
  limit(out, limits_.line(out.start_direction));
}

void PieceMaker::limit_rest(Piece& out) const {
  const double block_s = least_block_s(machine_.control);
  if (!limits_.has_kinks() || out.in_arc || block_s <= 0.0) {
    return;
  }
  out.plan.speed_limit_mm_s = std::min(out.plan.speed_limit_mm_s, out.segment.length_mm / block_s);
  out.segment.speed_limit_mm_s = out.plan.speed_limit_mm_s;
}

void PieceMaker::limit(Piece& out, const SpeedLimits& limits) const {
  PathSegment& s = out.segment;
  SegmentPlan& p = out.plan;
  const auto& control = machine_.control;
  double speed = std::min(limits.speed_mm_s, p.rapid ? control.rapid_mm_s : control.max_feed_mm_s);
  // The length before rounding counts: that is the control's block. The chords of a spline are
  // ours.
  if (const double block_s = least_block_s(control); block_s > 0.0 && !out.in_spline) {
    speed = std::min(speed, out.nominal_mm / block_s);
  }
  s.speed_limit_mm_s = speed;
  p.speed_limit_mm_s = speed;
  p.acceleration_mm_s2 = limits.acceleration_mm_s2;
  p.length_mm = s.length_mm;
  // A rapid has no F: it runs as fast as axes and control permit, scaled by the rapid override.
  if (p.rapid) {
    s.feed_mm_s = speed;
    p.feed_mm_s = speed;
  }
}

// The lag that a ramp leaves at its end is (1 − ff)·a/k² at most; it decays with k.
double PieceMaker::settle_s(const Piece& piece) const {
  const double near_mm = machine_.control.exact_stop_mm;
  double longest_s = 0.0;
  for (std::size_t i = 0; near_mm > 0.0 && i < std::min<std::size_t>(machine_.axes.size(), 3);
       ++i) {
    const auto& axis = machine_.axes[i];
    const double gain = axis.servo_gain_1_s;
    const double a = std::abs(piece.end_direction[i]) * piece.plan.acceleration_mm_s2;
    const double lag_mm = std::abs(1.0 - axis.feed_forward) * a / (gain * gain);
    if (lag_mm > near_mm) {
      longest_s = std::max(longest_s, std::log(lag_mm / near_mm) / gain);
    }
  }
  return longest_s;
}

double PieceMaker::ramp_mm_s2(const Piece& piece) const {
  const PathSegment& s = piece.segment;
  return s.geometry == Geometry::line ? limits_.line(line_direction(s)).acceleration_mm_s2
                                      : limits_.plane(s.axis).acceleration_mm_s2;
}

void PieceMaker::slow_ramps(Piece& out, Turn turn) const {
  const double share =
      (1.0 - out.kink) * (out.beside_blend ? machine_.control.corner_acceleration_share : 1.0);
  if (share >= out.ramp_share) {
    return;
  }
  const double ratio = share / out.ramp_share;
  out.ramp_share = share;
  out.plan.acceleration_mm_s2 *= ratio;
  if (turn == Turn::slower && out.segment.geometry == Geometry::arc && limits_.has_kinks()) {
    // v² = κ_n·a·R, where the axes' speed does not bind.
    const double slower = std::sqrt(ratio) * limits_.arc(out.segment).speed_mm_s;
    out.plan.speed_limit_mm_s = std::min(out.plan.speed_limit_mm_s, slower);
    out.segment.speed_limit_mm_s = out.plan.speed_limit_mm_s;
  }
}

Result<bool> PieceMaker::make(const Move& move, Piece& out) const {
  const auto refuse = [&move](const char* what, const char* to_do) {
    return kernel::outcome::refuse("", move.line, what, to_do);
  };
  out = {};
  PathSegment& s = out.segment;
  const AxisValues start = machine_position(move, move.start);
  const AxisValues end = machine_position(move, move.end);
  s.start_mm = xyz_of(start);
  s.end_mm = xyz_of(end);
  std::copy(start.begin() + 3, start.end(), s.other_start.begin());
  std::copy(end.begin() + 3, end.end(), s.other_end.begin());
  s.motion = motion_of(move);
  s.line = move.line;
  s.speed_modulation = move.speed_modulation;
  out.plan.from_start = move.from_start;
  if (move.kind == MoveKind::arc) {
    set_arc(s, move);
  } else {
    s.length_mm = line_length(s, rotary_);
  }
  if (!std::isfinite(s.length_mm)) {
    return refuse("the move has a coordinate that is not a finite number", "correct the block");
  }
  if (s.length_mm <= kShortest_mm) {
    return false;
  }
  out.nominal_mm = s.length_mm;
  out.in_spline = move.in_spline;
  out.mode = move.path_mode;
  out.tolerance_mm =
      move.path_tolerance_mm > 0.0 ? move.path_tolerance_mm : machine_.control.corner_tolerance_mm;
  out.program_tolerance_mm = move.path_tolerance_mm;
  out.merge_tolerance_mm = machine_.control.merge_share * merge_tolerance_mm(move);
  set_speed(out, move);
  if (!out.plan.rapid && !(out.plan.feed_mm_s > 0.0)) {
    return refuse("a feed move without a feed above 0", "give F before or in this block");
  }
  if (out.plan.per_revolution && out.segment.feed_mm_s == 0.0) {
    return refuse("a feed per revolution without a running spindle", "start the spindle first");
  }
  limit(out);
  // A machine file may omit limits. Without any bound the move would take no time.
  if (!std::isfinite(out.plan.speed_limit_mm_s) && !std::isfinite(out.plan.feed_mm_s)) {
    return refuse("a rapid move of axes without a speed limit", "give max_speed of the axes");
  }
  if (!std::isfinite(out.plan.acceleration_mm_s2)) {
    return refuse("a move of axes without an acceleration limit",
                  "give max_acceleration of the axes");
  }
  if (s.geometry == Geometry::arc) {
    out.start_direction = axes_at(s, 0.0).direction;
    out.end_direction = axes_at(s, s.length_mm).direction;
  }
  return true;
}

}  // namespace steadyrest::nc::plan
