// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/predistort/shape/tool_motion.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;

constexpr double kStepOfLag = 0.1;
/// A command that stands still would never bring the tool to the end: it creeps at least so fast.
constexpr double kCreep_mm_s = 0.3;
constexpr double kLeastTool_mm_s = 0.05;

/// w by progress, which only grows.
class Lookup {
 public:
  explicit Lookup(const CommandSpeed& command) : command_(command) {}

  double at(double progress_mm) {
    const auto& at = command_.progress_mm;
    if (at.empty()) {
      return kCreep_mm_s;
    }
    while (index_ + 1 < at.size() && at[index_ + 1] <= progress_mm) {
      ++index_;
    }
    double speed = command_.speed_mm_s[index_];
    if (index_ + 1 < at.size()) {
      const double share =
          std::clamp((progress_mm - at[index_]) / (at[index_ + 1] - at[index_]), 0.0, 1.0);
      speed += share * (command_.speed_mm_s[index_ + 1] - speed);
    }
    return std::max(speed, kCreep_mm_s);
  }

 private:
  const CommandSpeed& command_;
  std::size_t index_ = 0;
};

}  // namespace

ToolMotion::ToolMotion(const ServoInverse& inverse, const nc::plan::PlannedPath& path,
                       const CommandSpeed& command) {
  if (path.segments.empty()) {
    return;
  }
  constexpr double kNoLag_s = 1e-4;
  const double lag = std::max(inverse.lag_s(), kNoLag_s);
  const double h = kStepOfLag * lag;
  const double decay = std::exp(-kStepOfLag);
  const double end = path.segments.back().position_mm + path.segments.back().length_mm;
  Lookup lookup(command);
  std::size_t segment = 0;
  ToolState now;
  while (now.position_mm < end) {
    while (segment + 1 < path.segments.size() &&
           path.segments[segment].position_mm + path.segments[segment].length_mm <=
               now.position_mm) {
      ++segment;
    }
    now.progress_mm = std::max(now.progress_mm, now.position_mm + lag * now.speed_mm_s);
    now.command_mm_s = lookup.at(now.progress_mm);
    states_.push_back(now);
    const auto& here = path.segments[segment];
    const auto station = geometry::station_at(
        here, geometry::parameter_at(here, now.position_mm - here.position_mm));
    const double steady = now.speed_mm_s + lag * inverse.acceleration_mm_s2(station, now.speed_mm_s,
                                                                            now.command_mm_s);
    const double next = std::max(steady + (now.speed_mm_s - steady) * decay, kLeastTool_mm_s);
    now.position_mm += 0.5 * (now.speed_mm_s + next) * h;
    now.speed_mm_s = next;
  }
}

std::size_t ToolMotion::from(double position_mm) const noexcept {
  const auto found = std::ranges::lower_bound(states_, position_mm, {}, &ToolState::position_mm);
  return static_cast<std::size_t>(found - states_.begin());
}

ToolState ToolMotion::at(double position_mm) const noexcept {
  const std::size_t next = from(position_mm);
  if (next == 0 || next == states_.size()) {
    return states_.empty() ? ToolState{} : states_[std::min(next, states_.size() - 1)];
  }
  const ToolState& a = states_[next - 1];
  const ToolState& b = states_[next];
  const double share = (position_mm - a.position_mm) / (b.position_mm - a.position_mm);
  const auto between = [share](double x, double y) { return x + share * (y - x); };
  return {.position_mm = position_mm,
          .speed_mm_s = between(a.speed_mm_s, b.speed_mm_s),
          .command_mm_s = between(a.command_mm_s, b.command_mm_s),
          .progress_mm = between(a.progress_mm, b.progress_mm)};
}

}  // namespace steadyrest::contour::offline
