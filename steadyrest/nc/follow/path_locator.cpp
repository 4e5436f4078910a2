// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/follow/nearest_place.hpp>
#include <steadyrest/nc/follow/path_locator.hpp>

// A search looks at the segments of the control's line, some in each cycle, and keeps every place
// that fits as a trail. Trails move with the point; those that it leaves are dropped. What remains
// is the place.
namespace steadyrest::nc::follow {
namespace {

using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;
using kernel::units::kTurn;

constexpr std::size_t kLinesPerCycle = 32;  ///< segments of a line in one cycle
// Merged and rounded blocks show a neighbour's line: in 3D_Chips.ngc on LinuxCNC from one segment
// back to four ahead.
constexpr std::size_t kLineBehind = 2;
constexpr std::size_t kLineAhead = 6;
constexpr std::size_t kMostSegments = 200;  ///< looked at for one trail in one cycle
constexpr double kBack_mm = 0.005;          ///< rounding of the control's figures
constexpr double kAhead_mm = 0.05;
constexpr double kTravelShare = 1.5;   ///< the speed may rise within the cycle
constexpr double kRoundedShare = 4.0;  ///< a rounded corner is shorter than its legs
constexpr double kConfirm_mm = 0.1;    ///< on the way since it was found
constexpr double kWrongLine_mm = 5.0;
/// A segment that follows from the start is found only this near to it.
constexpr double kBegin_mm = 5.0;
constexpr double kOffPath_mm = 20.0;  ///< no rounded corner is longer
constexpr double kPreference = 0.01;  ///< of the expected place among equally near ones
constexpr double kSame_mm = 1e-6;
constexpr double kLongestGap_s = 0.5;
constexpr std::uint32_t kAnyLine = 1;

bool is_finite(const kernel::signal::Frame& frame) noexcept {
  bool finite = std::isfinite(frame.time_s) && std::isfinite(frame.path_speed_mm_s) &&
                frame.axis_count <= kernel::signal::kMaxAxes;
  for (const auto& axis : frame.axis) {
    finite = finite && std::isfinite(axis.command_mm) && std::isfinite(axis.offset_mm);
  }
  return finite;
}

bool is_probe(const PathSegment& segment) noexcept {
  return segment.motion == kernel::signal::Motion::probe;
}

/// The commanded point without the offsets in force, of a finite frame.
kernel::signal::AxisValues point_of(const kernel::signal::Frame& frame) noexcept {
  kernel::signal::AxisValues point{};
  for (std::size_t i = 0; i < std::min<std::size_t>(frame.axis_count, point.size()); ++i) {
    point[i] = frame.axis[i].command_mm - frame.axis[i].offset_mm;
  }
  return point;
}

}  // namespace

void PathLocator::follow(const Route* route) noexcept {
  route_ = route;
  stop();
  from_start_ = false;
  start_fits_ = false;
}

PathLocator::Output PathLocator::output(Place place) const noexcept {
  if (place == Place::on_path || place == Place::off_path) {
    return {.place = place,
            .index = trail_[0].index,
            .position_mm = trail_[0].position_mm,
            .away_mm = trail_[0].away_mm};
  }
  return {.place = place};
}

PathLocator::Output PathLocator::not_found() const noexcept {
  return output(passed_over_ && trails_ == 0 ? Place::start_unseen : Place::searching);
}

/// A control shows that its program runs some cycles after the axes have begun to move: what counts
/// is where they stood before.
void PathLocator::stand(const kernel::signal::Frame& frame) noexcept {
  if (!is_finite(frame)) {
    return;
  }
  const Axes point = point_of(frame);
  if (point == stopped_) {
    rest_ = point;
    rested_ = true;
  }
  stopped_ = point;
}

bool PathLocator::began_at_start(const Axes& point) const noexcept {
  const PathSegment& first = route_->path().front();
  const double moved_mm = std::hypot(point[0] - rest_[0], point[1] - rest_[1], point[2] - rest_[2]);
  return rested_ && moved_mm <= kBegin_mm &&
         nearest(first, rest_, 0.0, 0.0, 0.0).away_mm <= config_.near_mm;
}

/// The line of the first block that moves, or one that is merged with it: a program that is started
/// at a line begins with another.
bool PathLocator::begins_with(std::uint32_t line) const noexcept {
  const PathView path = route_->path();
  const bool ahead = path.size() > 1 && path[1].line > path[0].line;
  return ahead ? line < path[1].line : line <= path[0].line;
}

void PathLocator::begin_search() noexcept {
  start_fits_ = start_fits_ && !found_;
  passed_over_ = false;
  trails_ = 0;
  found_ = false;
  overflow_ = false;
  scan_line_ = 0;
  scanned_ = 0;
  wrong_line_mm_ = 0.0;
  off_path_mm_ = 0.0;
}

void PathLocator::stop() noexcept {
  begin_search();
  from_start_ = true;
  start_fits_ = false;
  last_line_ = 0;
  begun_ = false;
}

PathLocator::Output PathLocator::update(const kernel::signal::Frame& frame) noexcept {
  if (route_ == nullptr || route_->path().empty()) {
    return output(Place::no_route);
  }
  if (frame.program == kernel::signal::ProgramState::stopped) {
    stand(frame);
    stop();
    return output(Place::no_program);
  }
  if (!is_finite(frame)) {
    return output(Place::searching);
  }
  const Axes point = point_of(frame);
  const double dt_s = begun_ ? std::clamp(frame.time_s - time_s_, 0.0, kLongestGap_s) : 0.0;
  const double travel_mm = std::max(frame.path_speed_mm_s, speed_mm_s_) * dt_s;
  const bool moved = !begun_ || point != point_;
  probing_ = frame.motion == kernel::signal::Motion::probe;
  start_fits_ = start_fits_ || (!begun_ && from_start_ && began_at_start(point));
  time_s_ = frame.time_s;
  speed_mm_s_ = std::max(0.0, frame.path_speed_mm_s);
  point_ = point;
  begun_ = true;
  if (frame.program_line > 0) {
    if (last_line_ == 0 && !begins_with(frame.program_line)) {
      from_start_ = false;
      start_fits_ = false;
    }
    // A line further up: a loop or subprogram begins again.
    from_start_ = from_start_ && (found_ || frame.program_line >= last_line_);
    last_line_ = frame.program_line;
  }
  if (moved) {
    advance_all(point, travel_mm);
    check(frame.program_line, travel_mm);
  }
  if (!found_) {
    scan(point, config_.without_lines ? kAnyLine : frame.program_line);
    found_ = decided();
  }
  if (!found_) {
    return not_found();
  }
  trails_ = 1;
  from_start_ = false;
  return output(trail_[0].away_mm <= config_.near_mm ? Place::on_path : Place::off_path);
}

bool PathLocator::advance(Trail& trail, const Axes& point, double travel_mm) const noexcept {
  const PathView path = route_->path();
  const double expected = trail.position_mm + travel_mm;
  const double low = std::max(trail.position_mm, trail.farthest_mm) - kBack_mm;
  const double high =
      trail.position_mm + kTravelShare * travel_mm + kAhead_mm + kRoundedShare * trail.away_mm;
  std::size_t first = trail.index;
  while (first > 0 && path[first].position_mm > low && trail.index - first < kMostSegments) {
    --first;
  }
  double best = std::numeric_limits<double>::infinity();
  Trail next = trail;
  next.away_mm = best;
  const std::size_t end = std::min(path.size(), first + kMostSegments);
  for (std::size_t i = first; i < end && path[i].position_mm <= high; ++i) {
    const double start = path[i].position_mm;
    const Nearest here = nearest(path[i], point, std::clamp(low - start, 0.0, path[i].length_mm),
                                 std::clamp(high - start, 0.0, path[i].length_mm),
                                 std::clamp(expected - start, 0.0, path[i].length_mm));
    const double cost = std::hypot(here.away_mm, kPreference * (here.position_mm - expected));
    if (cost < best) {
      best = cost;
      next.index = i;
      next.position_mm = here.position_mm;
      next.away_mm = here.away_mm;
    }
  }
  next.farthest_mm = std::max(next.farthest_mm, next.position_mm);
  trail = next;
  return next.away_mm <= (found_ ? config_.far_mm : config_.near_mm);
}

/// Drops the trails that the point has left and those that have met.
void PathLocator::advance_all(const Axes& point, double travel_mm) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < trails_; ++i) {
    Trail trail = trail_[i];
    const bool stays = advance(trail, point, travel_mm);
    const bool met =
        kept > 0 && std::abs(trail_[kept - 1].position_mm - trail.position_mm) < kSame_mm;
    if (stays && !met) {
      trail_[kept++] = trail;
    }
  }
  if (trails_ > 0 && kept == 0) {
    from_start_ = from_start_ && !found_;
    begin_search();
  }
  trails_ = kept;
}

/// Each turn of a circle is a place.
void PathLocator::look_at(std::size_t index, const Axes& point) noexcept {
  const PathSegment& segment = route_->path()[index];
  if (is_probe(segment) && !probing_) {
    return;
  }
  const auto turns = static_cast<std::size_t>(
      std::clamp(std::ceil(segment.sweep_rad / kTurn), 1.0, static_cast<double>(kMostTrails)));
  overflow_ = overflow_ || segment.sweep_rad > kTurn * static_cast<double>(kMostTrails);
  const double turn_mm =
      turns == 1 ? segment.length_mm : segment.length_mm * kTurn / segment.sweep_rad;
  for (std::size_t i = 0; i < turns; ++i) {
    const double low = turn_mm * static_cast<double>(i);
    const double high = std::min(segment.length_mm, low + turn_mm);
    const Nearest here = nearest(segment, point, low, high, 0.5 * (low + high));
    if (here.away_mm > config_.near_mm) {
      continue;
    }
    if (route_->from_start(index) && !(start_fits_ && here.position_mm <= kBegin_mm)) {
      passed_over_ = true;
    } else {
      keep(index, here.position_mm, here.away_mm);
    }
  }
}

void PathLocator::keep(std::size_t index, double position_mm, double away_mm) noexcept {
  // Sorted by place; the same place once.
  auto* const begin = trail_.begin();
  auto* const at = std::lower_bound(
      begin, begin + trails_, position_mm - kBack_mm,
      [](const Trail& trail, double position) { return trail.position_mm < position; });
  if (at != begin + trails_ && std::abs(at->position_mm - position_mm) <= kBack_mm) {
    return;
  }
  if (trails_ == kMostTrails) {
    overflow_ = true;
    if (at == begin + trails_) {
      return;
    }
    --trails_;
  }
  std::move_backward(at, begin + trails_, begin + trails_ + 1);
  *at = {.index = index,
         .position_mm = position_mm,
         .away_mm = away_mm,
         .born_mm = position_mm,
         .farthest_mm = position_mm};
  ++trails_;
}

/// Looks at the next segments of the line; a line that is done is not looked at again while its
/// trails live.
void PathLocator::scan(const Axes& point, std::uint32_t line) noexcept {
  if (line == 0 || (trails_ > 0 && line != scan_line_)) {
    return;
  }
  if (line != scan_line_ || trails_ == 0) {
    const bool goes_on = line == scan_line_ && scanned_ < to_scan(line);
    scanned_ = goes_on ? scanned_ : 0;
    passed_over_ = passed_over_ && goes_on;
    scan_line_ = line;
  }
  const std::size_t end = std::min(to_scan(line), scanned_ + kLinesPerCycle);
  for (; scanned_ < end; ++scanned_) {
    if (config_.without_lines) {
      look_at(scanned_, point);
    } else {
      look_around(point, line, scanned_);
    }
  }
}

/// One segment of the line with those that may show it as theirs.
void PathLocator::look_around(const Axes& point, std::uint32_t line, std::size_t number) noexcept {
  const auto segments = route_->of_line(line);
  const bool of_line = number < segments.size();
  const std::size_t at =
      of_line ? segments[number] : route_->after_line(line)[number - segments.size()];
  const std::size_t first = at - std::min(at, kLineAhead);
  const std::size_t last = std::min(route_->path().size() - 1, at + (of_line ? kLineBehind : 0));
  for (std::size_t i = first; i <= last; ++i) {
    look_at(i, point);
  }
}

std::size_t PathLocator::to_scan(std::uint32_t line) const noexcept {
  if (config_.without_lines) {
    return route_->path().size();
  }
  return route_->of_line(line).size() + route_->after_line(line).size();
}

bool PathLocator::decided() const noexcept {
  if (trails_ == 0 || trail_[0].position_mm - trail_[0].born_mm < kConfirm_mm) {
    return false;
  }
  // Without lines only the path's own begin tells the first pass from a later one.
  const bool first_pass = from_start_ && (!config_.without_lines || trail_[0].born_mm <= kBegin_mm);
  return first_pass || (trails_ == 1 && !overflow_ && scanned_ >= to_scan(scan_line_));
}

bool PathLocator::line_fits(std::uint32_t line) const noexcept {
  const PathView path = route_->path();
  const std::size_t at = trail_[0].index;
  const std::size_t first = at - std::min(at, kLineBehind);
  const std::size_t last = std::min(path.size() - 1, at + kLineAhead);
  std::uint32_t low = path[at].line;
  std::uint32_t high = low;
  for (std::size_t i = first; i <= last; ++i) {
    low = std::min(low, path[i].line);
    high = std::max(high, path[i].line);
  }
  // The last line of a merged block lies before the line that follows it.
  return route_->line_before(low) <= line && line <= high;
}

/// A place that the control has left for long, or whose lines are others than the control's, is not
/// the place.
void PathLocator::check(std::uint32_t line, double travel_mm) noexcept {
  if (!found_) {
    return;
  }
  off_path_mm_ = trail_[0].away_mm <= config_.near_mm ? 0.0 : off_path_mm_ + travel_mm;
  wrong_line_mm_ = line == 0 || line_fits(line) ? 0.0 : wrong_line_mm_ + travel_mm;
  const bool probed = is_probe(route_->path()[trail_[0].index]) && !probing_;
  if (probed || off_path_mm_ > kOffPath_mm || wrong_line_mm_ > kWrongLine_mm) {
    begin_search();
  }
}

}  // namespace steadyrest::nc::follow
