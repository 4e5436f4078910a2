// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// The path ahead, what the offsets make of it, and where a decision begins.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Frame;
using kernel::signal::Point;

/// What a lag is at a share of the speed: along the path it grows with the speed, across it with
/// the square, as on a circle.
Point slowed(const Point& lag, const Point& along, double share) noexcept {
  const Point part = geometry::scale(along, geometry::dot(lag, along));
  const Point across = geometry::subtract(lag, part);
  return geometry::add_scaled(geometry::scale(part, share), across, share * share);
}

}  // namespace

/// Without a path: the circle that the command has run on lately goes on, at the programmed feed.
void FeedGovernor::extrapolate(const Frame& frame) noexcept {
  const auto bend = curve_.update(state_.command_mm);
  guess_.reset();
  if (!bend.valid) {
    return;
  }
  const double curvature = geometry::norm(bend.curvature_1_mm);
  const Point normal = geometry::unit(bend.curvature_1_mm);
  const double speed = std::max({frame.path_speed_mm_s, frame.programmed_feed_mm_s, 1.0});
  // Behind the command far enough to hold the foot: the lag v/k, three times. Cells so short that
  // the cubic term κ²h³/6 stays below 5·10⁻⁵ mm, and not more than about 400 of them.
  const double back = 3.0 * speed / softest_gain_1_s_ + 0.5;
  const double ahead = speed * reach_s_;
  const double fine = curvature > 1e-6 ? std::cbrt(3e-4 / (curvature * curvature)) : ahead;
  const double length = std::max(fine, (back + ahead) / 400.0);
  double a = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min<std::size_t>(3, config_.axes.size()); ++i) {
    a = std::min(a, config_.axes[i].max_acceleration_au_s2);
  }
  for (double s = -back; s < ahead; s += length) {
    Cell cell;
    cell.position_mm = s;
    cell.length_mm = length;
    cell.cap_mm_s = std::numeric_limits<double>::infinity();
    cell.feed_mm_s = frame.programmed_feed_mm_s;
    cell.acceleration_mm_s2 = std::min(a, 1e9);
    cell.cutting = true;
    const double angle = curvature * s;
    const double along = curvature > 1e-9 ? std::sin(angle) / curvature : s;
    const double across = curvature > 1e-9 ? (1.0 - std::cos(angle)) / curvature : 0.0;
    cell.point_mm = geometry::add_scaled(
        geometry::add_scaled(state_.command_mm, bend.tangent, along), normal, across);
    cell.tangent = geometry::add_scaled(geometry::scale(bend.tangent, std::cos(angle)), normal,
                                        std::sin(angle));
    cell.curvature_1_mm =
        geometry::scale(geometry::add_scaled(geometry::scale(normal, std::cos(angle)), bend.tangent,
                                             -std::sin(angle)),
                        curvature);
    guess_.append(cell, std::numeric_limits<double>::infinity());
  }
}

bool FeedGovernor::look(const Frame& frame, const ContourError::Output& error) noexcept {
  if (frame.path.empty() || frame.path_index >= frame.path.size()) {
    curve_.update({frame.axis[0].command_mm, frame.axis[1].command_mm, frame.axis[2].command_mm});
    ahead_.reset();
    return false;
  }
  const double speed = std::max(
      {frame.path_speed_mm_s, frame.programmed_feed_mm_s * config_.contour.max_ratio, 5.0});
  const double s = frame.path_position_mm;
  const double foot = error.valid ? error.foot_position_mm : s;
  const double tool = precompensator_.started() ? precompensator_.position_mm() : s;
  const double reach_s = frame.original.empty() ? reach_s_ : std::max(reach_s_, back_s_);
  const Outset& shadow = state_.shadow.outset;
  const double shadows =
      state_.shadow.on ? std::min(shadow.foot_mm, shadow.tool ? shadow.tool->position_mm : s) : s;
  ahead_.update(frame.path, frame.path_index, std::min({foot, s, tool, shadows}) - 0.5, s,
                s + speed * reach_s);
  if (ahead_.empty()) {
    return false;
  }
  state_.command_cell = ahead_.find(s, state_.command_cell);
  state_.foot_cell = ahead_.find(foot, state_.foot_cell);
  return true;
}

/// The text corrects the path between the tool and where the command can be before the override is
/// back at 1: a fall would spoil what was written for the programmed feed.
bool FeedGovernor::is_by_text(const Frame& frame) const noexcept {
  if (frame.original.empty() || ahead_.empty()) {
    return !frame.original.empty();  // the place is lost, and what the text does here is not known
  }
  double time_s = 0.0;
  for (std::size_t i = state_.foot_cell; i < ahead_.end() && time_s < back_s_; ++i) {
    const Cell& cell = ahead_.cell(i);
    if (cell.by_text) {
      return true;
    }
    // The least time to the next cell, whatever the override.
    if (const double left_mm = cell.position_mm + cell.length_mm - frame.path_position_mm;
        left_mm > 0.0) {
      const double most = cell.cutting ? std::max(1.0, candidate_.back()) : 1.0;
      const double fastest_mm_s = std::max(1e-3, std::min(cell.cap_mm_s, most * cell.feed_mm_s));
      time_s += std::min(left_mm, cell.length_mm) / fastest_mm_s;
    }
  }
  return time_s < back_s_ && !ahead_.complete();
}

/// The offsets that take the contour error away, where the machine takes any.
void FeedGovernor::cancel(const Frame& frame, double dt, bool by_text, Output& output) noexcept {
  const bool locked = kernel::signal::is_locked(frame.motion);
  output.path_offset =
      precompensator_.update({.frame = frame,
                              .path = ahead_,
                              .step_s = is_step(dt) ? dt : 0.0,
                              .active = state_.offsets_act,
                              .permitted = output.path_known && !locked && !by_text,
                              .follows = state_.offsets_follow});
}

bool FeedGovernor::cutting_within_reach(const Frame& frame) const noexcept {
  if (ahead_.empty()) {
    return false;
  }
  const Forecast::Timing& timing = forecast_.timing();
  // Time within which a step told now can still fall: dead time, scan, two decisions and the whole
  // slew.
  const double time = timing.dead_s + timing.scan_s + 2.0 * decision_s_ + 1.0 / timing.fall_1_s;
  const double a = ahead_.cell(state_.command_cell).acceleration_mm_s2;
  const double reach = (frame.path_speed_mm_s + 0.5 * std::min(a, 1e5) * time) * time;
  for (std::size_t i = state_.command_cell; i < ahead_.end(); ++i) {
    const Cell& cell = ahead_.cell(i);
    if (cell.position_mm - frame.path_position_mm > reach) {
      return false;
    }
    if (cell.cutting) {
      return true;
    }
  }
  return false;
}

/// The operator's panel caps the forecast as it will cap the word, unless the machine file lets the
/// layer exceed it. A panel that cannot be read caps nothing.
double FeedGovernor::panel_limit(const Frame& frame) const noexcept {
  const bool caps = !config_.feed_override.layer_may_exceed_panel && frame.feed.panel_ratio >= 0.0;
  return caps ? frame.feed.panel_ratio : std::numeric_limits<double>::infinity();
}

Outset FeedGovernor::outset(const Frame& frame) const noexcept {
  const bool shadows = state_.shadow.on;
  Outset outset = shadows && state_.last.path_known ? state_.shadow.outset : machine(frame);
  outset.rapid_ratio = frame.rapid.effective_ratio;
  outset.panel_ratio = panel_limit(frame);
  if (shadows && !state_.last.path_known) {
    const double share = shadow_share(frame);
    outset.speed_mm_s *= share;
    const Cell& here = guess_.cell(outset.command_cell);
    const Point along =
        geometry::unit(geometry::add_scaled(here.tangent, here.curvature_1_mm, -here.position_mm));
    outset.servo.error_mm = slowed(outset.servo.error_mm, along, share);
    outset.servo.velocity_mm_s = slowed(outset.servo.velocity_mm_s, along, share);
    outset.foot_cell = guess_.find(-geometry::norm(outset.servo.error_mm), outset.command_cell);
  }
  return outset;
}

/// Where the machine is, as the frame shows it.
Outset FeedGovernor::machine(const Frame& frame) const noexcept {
  Outset outset;
  outset.speed_mm_s = std::max(0.0, frame.path_speed_mm_s);
  for (std::size_t i = 0; i < 3; ++i) {
    outset.servo.error_mm[i] = frame.axis[i].command_mm - frame.axis[i].actual_mm;
    outset.servo.velocity_mm_s[i] = state_.velocity_mm_s[i];
    outset.play_mm[i] = state_.table_mm[i] - frame.axis[i].actual_mm;
  }
  if (state_.last.path_known) {
    outset.position_mm = frame.path_position_mm;
    outset.command_cell = state_.command_cell;
    outset.foot_cell = state_.foot_cell;
    if (state_.offsets_act) {
      outset.tool = precompensator_.in_full();
      outset.offset = precompensator_.state().offset;
      outset.follows = state_.offsets_follow;
    }
  } else {
    outset.command_cell = guess_.find(0.0, guess_.begin());
    outset.foot_cell = guess_.find(-geometry::norm(outset.servo.error_mm), outset.command_cell);
  }
  return outset;
}

}  // namespace steadyrest::contour::online
