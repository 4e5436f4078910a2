// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/shape/command_shape.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kFadeLags = 2.0;  ///< length of a fade, in v·L
constexpr double kLeastFade_mm = 0.05;
constexpr double kChordLags = 3.0;  ///< a line shorter than this, in v·L, is one line
constexpr double kNear_mm = 1e-6;
constexpr double kPasses = 0.05;     ///< of the feed
constexpr double kKink = 2e-3;       ///< |t′ − t| of a bend that is worth an arc
constexpr double kLeastRatio = 0.8;  ///< of the feed: the command is never longer or shorter …
constexpr double kMostRatio = 2.0;   ///< … than this, in terms of the path

double end_mm(const PathSegment& segment) noexcept {
  return segment.position_mm + segment.length_mm;
}

geometry::Station station(const PathSegment& segment, double distance_mm) noexcept {
  return geometry::station_at(segment, geometry::parameter_at(segment, distance_mm));
}

}  // namespace

CommandShape::CommandShape(const nc::plan::PlannedPath& path, const std::vector<SegmentUse>& use,
                           const ServoInverse& inverse, const ToolMotion& motion,
                           const Learnt& learnt, const ShapeConfig& config)
    : path_(path),
      use_(use),
      inverse_(inverse),
      motion_(motion),
      learnt_(learnt),
      config_(config) {}

/// The curve runs through the joint behind the segment without a corner.
bool CommandShape::goes_on(std::size_t segment) const noexcept {
  if (segment + 1 >= path_.segments.size() || !use_[segment].free || !use_[segment + 1].free ||
      use_[segment].stops) {
    return false;
  }
  const Point out = station(path_.segments[segment], path_.segments[segment].length_mm).tangent;
  const Point in = station(path_.segments[segment + 1], 0.0).tangent;
  return geometry::distance(out, in) < config_.sharp;
}

/// The control goes through the joint behind the segment without coming to rest, or nearly so.
bool CommandShape::passes(std::size_t segment) const noexcept {
  const PathSegment& of = path_.segments[segment];
  return !use_[segment].stops && of.exit_speed_limit_mm_s > kPasses * of.feed_mm_s;
}

CurvePoint CommandShape::led_point(std::size_t segment, const ToolState& at,
                                   double distance_mm) const {
  const auto here = station(path_.segments[segment], distance_mm);
  const double a = inverse_.acceleration_mm_s2(here, at.speed_mm_s, at.command_mm_s);
  const Point shift = learnt_.shift_mm(path_.segments[segment].position_mm + distance_mm);
  return {.point_mm = geometry::add(inverse_.command_mm(here, at.speed_mm_s, a), shift),
          .direction = inverse_.direction(here, at.speed_mm_s, a),
          .progress_mm = at.progress_mm};
}

bool CommandShape::is_smooth(const Point& in, const Point& out) const noexcept {
  return geometry::distance(in, out) < config_.smooth;
}

CommandShape::End CommandShape::end_of(std::size_t segment) const {
  const PathSegment& of = path_.segments[segment];
  if (!goes_on(segment)) {
    return {.point_mm = of.end_mm,
            .direction = station(of, of.length_mm).tangent,
            .progress_mm = end_mm(of),
            .led = false};
  }
  const ToolState at = motion_.at(end_mm(of));
  const CurvePoint before = led_point(segment, at, of.length_mm);
  const CurvePoint after = led_point(segment + 1, at, 0.0);
  return {.point_mm = geometry::scale(geometry::add(before.point_mm, after.point_mm), 0.5),
          .direction = is_smooth(before.direction, after.direction)
                           ? geometry::unit(geometry::add(before.direction, after.direction))
                           : before.direction,
          .progress_mm = at.progress_mm,
          .led = true};
}

/// Those of the tool's states on the segment whose command is not yet at its end where the curve
/// must arrive there.
std::vector<CurvePoint> CommandShape::inner_points(std::size_t segment, const End& end) const {
  const PathSegment& of = path_.segments[segment];
  std::vector<CurvePoint> out;
  const auto& states = motion_.states();
  for (std::size_t i = motion_.from(of.position_mm + kNear_mm); i < states.size(); ++i) {
    const ToolState& at = states[i];
    const bool arrived = !end.led && at.progress_mm >= end_mm(of) - kNear_mm;
    if (at.position_mm >= end_mm(of) - kNear_mm || arrived) {
      break;
    }
    out.push_back(led_point(segment, at, at.position_mm - of.position_mm));
  }
  return out;
}

/// Length that a piece beside a kink must have, so that an arc can take the kink at full speed.
double CommandShape::kink_room_mm(std::size_t segment, const Point& in, const Point& out,
                                  double speed) const {
  const double bend = geometry::distance(in, out);
  if (bend < kKink) {
    return 0.0;
  }
  const double radius = speed * speed / config_.across_mm_s2;
  return std::min(0.9 * path_.segments[segment].length_mm, 1.15 * radius * bend + 0.04);
}

std::vector<CurvePoint> CommandShape::curve(std::size_t segment, const End& start,
                                            const End& end) const {
  const PathSegment& of = path_.segments[segment];
  std::vector<CurvePoint> inner = inner_points(segment, end);
  const ToolState at_start = motion_.at(of.position_mm);
  const ToolState at_end = motion_.at(end_mm(of));
  const double lag = inverse_.lag_s();
  // What the ends differ from the curve of this segment alone fades out within it.
  Point off_start{};
  Point off_end{};
  Point direction = start.direction;
  if (start.led) {
    const CurvePoint own = led_point(segment, at_start, 0.0);
    off_start = geometry::subtract(start.point_mm, own.point_mm);
    direction = is_smooth(start.direction, own.direction) ? start.direction : own.direction;
  }
  if (end.led) {
    off_end = geometry::subtract(end.point_mm, led_point(segment, at_end, of.length_mm).point_mm);
  } else if (!inner.empty()) {
    const CurvePoint& last = inner.back();
    const double left = std::max(0.0, end_mm(of) - last.progress_mm);
    off_end =
        geometry::subtract(geometry::add_scaled(end.point_mm, end.direction, -left), last.point_mm);
  }
  const double speed = std::max(at_start.speed_mm_s, at_end.speed_mm_s);
  const double fade = std::min(of.length_mm, std::max(kLeastFade_mm, kFadeLags * speed * lag));
  const double from = start.progress_mm;
  const double room_start =
      start.led ? kink_room_mm(segment, start.direction, direction, at_start.command_mm_s) : 0.0;
  double room_end = 0.0;
  if (end.led) {
    const Point next = led_point(segment + 1, at_end, 0.0).direction;
    room_end = kink_room_mm(segment, end.direction, next, at_end.command_mm_s);
  }
  std::vector<CurvePoint> out = {{start.point_mm, direction, from}};
  for (CurvePoint point : inner) {
    const double near_start = std::max(0.0, 1.0 - (point.progress_mm - from) / fade);
    const double near_end = std::max(0.0, 1.0 - (end.progress_mm - point.progress_mm) / fade);
    point.point_mm = geometry::add_scaled(point.point_mm, off_start, near_start);
    point.point_mm = geometry::add_scaled(point.point_mm, off_end, near_end);
    point.progress_mm = std::max(point.progress_mm, out.back().progress_mm);
    if (geometry::distance(point.point_mm, start.point_mm) >= room_start &&
        geometry::distance(point.point_mm, end.point_mm) >= room_end) {
      out.push_back(point);
    }
  }
  out.push_back({end.point_mm, end.direction, std::max(end.progress_mm, out.back().progress_mm)});
  return out;
}

std::vector<Piece> CommandShape::pieces() {
  std::vector<Piece> out;
  out.reserve(path_.segments.size());
  End start;
  for (std::size_t i = 0; i < path_.segments.size(); ++i) {
    const PathSegment& of = path_.segments[i];
    if (!use_[i].free) {
      continue;
    }
    const bool begins = i == 0 || !use_[i - 1].free;
    if (begins || !start.led) {
      start = {.point_mm = of.start_mm,
               .direction = station(of, 0.0).tangent,
               .progress_mm = of.position_mm,
               .led = false};
    }
    const End end = end_of(i);
    const double speed = motion_.at(of.position_mm).speed_mm_s;
    const bool flat =
        std::abs(station(of, 0.0).tangent[nc::interpret::axes_of(use_[i].plane).normal]) < 1e-9;
    const bool is_line = of.geometry == Geometry::line;
    const FitConfig fit = {
        .plane = use_[i].plane,
        .tolerance_mm = config_.tolerance_mm,
        .one_line = is_line && (!flat || of.length_mm < kChordLags * speed * inverse_.lag_s())};
    std::vector<Piece> fitted = fit_curve(curve(i, start, end), fit);
    for (std::size_t j = 0; j < fitted.size(); ++j) {
      Piece& piece = fitted[j];
      const double gain = piece.progress_end_mm - piece.progress_start_mm;
      const double ratio = gain > kNear_mm
                               ? std::clamp(piece.segment.length_mm / gain, kLeastRatio, kMostRatio)
                               : 1.0;
      piece.segment.feed_mm_s = of.feed_mm_s * ratio;
      piece.segment.line = of.line;
      piece.segment.motion = Motion::feed;
      piece.plane = use_[i].plane;
      piece.begins_run = begins && j == 0;
      piece.joined = j > 0 || start.led;
      piece.passes = j == 0 && !begins && passes(i - 1);
      out.push_back(piece);
    }
    start = end;
  }
  return out;
}

}  // namespace steadyrest::contour::offline
