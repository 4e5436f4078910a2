// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/polish/chain_error.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {

namespace geometry = math::geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

namespace {

constexpr double kFootSpare_mm = 0.02;

}  // namespace

ChainError::ChainError(const Config& config, kernel::signal::PathView path)
    : config_(config), path_(path) {
  for (std::size_t i = 0; i < 3; ++i) {
    step_[i] = online::AxisStep::of(config.models[i], config.period_s);
  }
}

void ChainError::begin(const State& from, double after_s) {
  axes_ = from.axes;
  const double foot_mm = from.foot_mm;
  if (after_s > 0.0) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto s = online::AxisStep::of(config_.models[i], after_s);
      const double e = axes_.servo.error_mm[i];
      const double w = axes_.servo.velocity_mm_s[i];
      const double mean = axes_.mean_mm_s[i];
      axes_.servo.error_mm[i] = s.ee * e + s.ew * w + s.e_mean * mean;
      axes_.servo.velocity_mm_s[i] = s.we * e + s.ww * w + s.w_mean * mean;
      axes_.tool_mm[i] += mean * after_s - axes_.servo.error_mm[i] + e;
    }
  }
  segment_ = geometry::segment_at(path_, std::max(0.0, foot_mm));
  const PathSegment& near = path_[segment_];
  u_ = near.length_mm > 0.0 ? std::clamp((foot_mm - near.position_mm) / near.length_mm, 0.0, 1.0)
                            : 0.0;
  foot_ = geometry::station_at(near, u_).point_mm;
  const double spare =
      2.0 * (geometry::norm(axes_.servo.error_mm) + geometry::distance(foot_, axes_.tool_mm)) +
      kFootSpare_mm;
  find_foot(spare, spare);
}

void ChainError::find_foot(double back_mm, double ahead_mm) noexcept {
  const PathSegment& now = path_[segment_];
  const double at = now.position_mm + u_ * now.length_mm;
  std::size_t first = segment_;
  while (first > 0 && path_[first].position_mm > at - back_mm) {
    --first;
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < path_.size() && path_[i].position_mm <= at + ahead_mm; ++i) {
    const PathSegment& segment = path_[i];
    const auto share = [&](double place_mm) {
      return segment.length_mm > 0.0
                 ? std::clamp((place_mm - segment.position_mm) / segment.length_mm, 0.0, 1.0)
                 : 0.0;
    };
    const auto foot = geometry::foot_point(segment, axes_.tool_mm, share(at - back_mm),
                                           share(at + ahead_mm), share(at));
    if (foot.distance_mm < nearest) {
      nearest = foot.distance_mm;
      segment_ = i;
      u_ = foot.u;
      foot_ = foot.point_mm;
    }
  }
}

ChainError::Off ChainError::off() const noexcept {
  const Point tangent = geometry::station_at(path_[segment_], u_).tangent;
  Point away = geometry::subtract(axes_.tool_mm, foot_);
  if (config_.unknown) {
    const PathSegment& at = path_[segment_];
    const Point unknown = config_.unknown(at.position_mm + u_ * at.length_mm);
    away = geometry::subtract(
        away, geometry::add_scaled(unknown, tangent, -geometry::dot(unknown, tangent)));
  }
  const double height = geometry::dot(away, config_.normal);
  const Point flat = geometry::add_scaled(away, config_.normal, -height);
  const double side = geometry::dot(flat, geometry::cross(config_.normal, tangent));
  // At a corner the foot stays while the tool goes round it.
  return {.side_mm = std::copysign(geometry::norm(flat), side), .height_mm = height};
}

void ChainError::run(std::span<const Point> command, std::vector<Off>& out,
                     std::vector<State>* states) {
  out.clear();
  for (std::size_t j = 1; j < command.size(); ++j) {
    const Point before = axes_.tool_mm;
    online::ServoState& servo = axes_.servo;
    for (std::size_t i = 0; i < 3; ++i) {
      const double mean = (command[j][i] - command[j - 1][i]) / config_.period_s;
      const double change = mean - axes_.mean_mm_s[i];
      const online::AxisStep& s = step_[i];
      const double e = servo.error_mm[i];
      const double w = servo.velocity_mm_s[i];
      servo.error_mm[i] = s.ee * e + s.ew * w + s.e_mean * mean + s.e_change * change;
      servo.velocity_mm_s[i] = s.we * e + s.ww * w + s.w_mean * mean + s.w_change * change;
      axes_.mean_mm_s[i] = mean;
      const double motor = command[j][i] - servo.error_mm[i];
      const double half = 0.5 * config_.backlash_mm[i];
      axes_.tool_mm[i] = std::clamp(axes_.tool_mm[i], motor - half, motor + half);
    }
    // At a corner the foot jumps over what the tool leaves out.
    const double off_mm = geometry::distance(foot_, before);
    find_foot(kFootSpare_mm + off_mm,
              2.0 * off_mm + 3.0 * geometry::distance(axes_.tool_mm, before) + kFootSpare_mm);
    out.push_back(off());
    const double speed = geometry::distance(axes_.tool_mm, before) / config_.period_s;
    const double feed = path_[segment_].feed_mm_s;
    if (states != nullptr) {
      states->push_back({axes_, path_[segment_].position_mm + u_ * path_[segment_].length_mm});
    }
    out.back().fast_ratio = feed > 0.0 ? std::max(0.0, speed / feed - 1.0) : 0.0;
  }
}

}  // namespace steadyrest::contour::offline
