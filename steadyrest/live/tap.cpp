// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <steadyrest/live/tap.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::live {
namespace {

using kernel::signal::Frame;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr std::uint32_t kCyclesPerAhead = 32;
constexpr double kHeatEvery_s = 1.0;
constexpr std::size_t kMostReadings = 1024;  ///< of a cycle
/// The page shows about a second, but no less than a corner and its surroundings.
constexpr double kSight_s = 1.0;
constexpr double kShortest_mm = 5.0;
constexpr double kLongest_mm = 200.0;

Point first_three(const Frame& frame, double kernel::signal::AxisSample::* of) noexcept {
  return {frame.axis[0].*of, frame.axis[1].*of, frame.axis[2].*of};
}

/// Points at even distances; `place` runs along with them, so that each segment is met once. At
/// most as many segments as points: a path of very short ones is seen less far.
void look_ahead(const Frame& frame, PathAhead& into) noexcept {
  into.count = 0;
  if (frame.path_index >= frame.path.size()) {
    return;
  }
  const double sight_mm =
      std::clamp(kSight_s * frame.programmed_feed_mm_s, kShortest_mm, kLongest_mm);
  const double step_mm = sight_mm / static_cast<double>(PathAhead::kMost);
  into.from_mm = frame.path_position_mm;
  into.step_mm = step_mm;
  const std::size_t last = std::min(frame.path.size() - 1, frame.path_index + 8 * PathAhead::kMost);
  std::size_t place = frame.path_index;
  for (std::size_t i = 0; i < PathAhead::kMost; ++i) {
    const double at_mm = frame.path_position_mm + step_mm * static_cast<double>(i);
    while (place < last && frame.path[place].position_mm + frame.path[place].length_mm < at_mm) {
      ++place;
    }
    const PathSegment& segment = frame.path[place];
    into.point_mm[into.count++] = math::geometry::point_at(
        segment, math::geometry::parameter_at(segment, at_mm - segment.position_mm));
    if (segment.position_mm + segment.length_mm < at_mm) {
      return;  // the path's end
    }
  }
}

}  // namespace

void Tap::watch(bool on) noexcept {
  if (on && !watched_.load(std::memory_order_relaxed)) {
    while (samples_->try_pop()) {
    }
    while (readings_->try_pop()) {
    }
  }
  watched_.store(on, std::memory_order_relaxed);
}

void Tap::put(const LiveStatus& status, const Frame& frame) noexcept {
  if (!watched_.load(std::memory_order_relaxed)) {
    return;
  }
  const bool taken = samples_->try_push(
      {.cycle = status.cycles,
       .time_s = status.time_s,
       .position_mm = first_three(frame, &kernel::signal::AxisSample::actual_mm),
       .following_mm = first_three(frame, &kernel::signal::AxisSample::following_error_mm),
       .error_known = status.error_known,
       .contour_error_mm = status.contour_error_mm,
       .feed_asked_ratio = status.feed_asked_ratio,
       .feed_ratio = status.feed_ratio,
       .feed_effective_ratio = status.feed_effective_ratio,
       .feed_panel_ratio = status.feed_panel_ratio,
       .path_speed_mm_s = status.path_speed_mm_s,
       .spindle_rev_s = status.spindle_rev_s});
  if (!taken) {
    lost_.fetch_add(1, std::memory_order_relaxed);
  }
  put_vibration(frame);
  if (++since_ahead_ >= kCyclesPerAhead) {
    since_ahead_ = 0;
    look_ahead(frame, next_);
    ahead_.store(next_);
  }
}

// A round over the table takes two forecasts for each step, one in a cycle: some 50 ms for 23 steps
// at 1 kHz. The steps are shown when all of them have been looked at. A cycle that decides is long
// already and is left alone, unless all of them do.
void Tap::look_at_steps(const LiveStatus& status, const supervisor::Supervisor& layer) noexcept {
  using Look = contour::online::FeedGovernor::Look;
  const bool looks = watched_.load(std::memory_order_relaxed) && !status.port_fault;
  const auto ratio = layer.feed_steps();
  if (!looks || !layer.previews() || ratio.size() > StepErrors::kMost) {
    turn_ = 0;
    if (steps_shown_) {
      steps_shown_ = false;
      looked_.count = 0;
      steps_.store(looked_);
    }
    return;
  }
  const auto& contour = layer.estimates().contour;
  const bool decides = contour && contour->decided;
  if (decides && !std::exchange(decided_, true)) {
    return;
  }
  decided_ = decides;
  if (turn_ >= 2 * ratio.size()) {
    turn_ = 0;  // a table of another machine file
  }
  StepErrors::Step& step = looked_.step[turn_ / 2];
  const bool held = turn_ % 2 == 0;
  const double at = ratio[turn_ / 2];
  const double error_mm = layer.preview(at, held ? Look::held : Look::change)
                              .value_or(std::numeric_limits<double>::quiet_NaN());
  step.ratio = at;
  (held ? step.held_mm : step.change_mm) = error_mm;
  if (++turn_ == 2 * ratio.size()) {
    turn_ = 0;
    looked_.count = ratio.size();
    steps_.store(looked_);
    steps_shown_ = true;
  }
}

void Tap::look_at_heat(const LiveStatus& status, const supervisor::Supervisor& layer) noexcept {
  const auto* const room = layer.thermal();
  const double since_s = status.time_s - heat_next_.time_s;
  const bool waits = heat_next_.on && since_s >= 0.0 && since_s < kHeatEvery_s;
  if (waits || status.port_fault || (room == nullptr && !heat_next_.on)) {
    return;
  }
  heat_next_.on = room != nullptr;
  heat_next_.time_s = status.time_s;
  heat_next_.offset_mm = status.offset_mm;
  if (room != nullptr) {
    heat_next_.state = room->state();
  }
  heat_.store(heat_next_);
}

void Tap::put_vibration(const Frame& frame) noexcept {
  rate_hz_.store(frame.vibration_rate_hz, std::memory_order_relaxed);
  const std::size_t most = std::min(frame.vibration.size(), kMostReadings);
  for (std::size_t i = 0; i < most; ++i) {
    if (!readings_->try_push(frame.vibration[i])) {
      return;
    }
  }
}

double Tap::take_vibration(std::vector<double>& into) {
  into.clear();
  for (std::size_t i = 0; i < kReadings; ++i) {
    const auto reading = readings_->try_pop();
    if (!reading) {
      break;
    }
    into.push_back(*reading);
  }
  return rate_hz_.load(std::memory_order_relaxed);
}

std::uint64_t Tap::take(std::vector<TapSample>& into) {
  into.clear();
  while (auto sample = samples_->try_pop()) {
    into.push_back(*sample);
  }
  return lost_.load(std::memory_order_relaxed);
}

}  // namespace steadyrest::live
