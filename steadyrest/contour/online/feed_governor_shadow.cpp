// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Where nothing is written the axes lag as the panel's feed makes them, an error that nobody holds
// down. The decisions then start from a shadow: the same program at the ratio that they would have
// in force by now. It is at the machine's place on the path, which takes it more time.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Frame;

/// Forecast steps in a cycle; more where the share of the work that a search may have holds more.
constexpr std::size_t kMostCarried = 256;
constexpr double kAtRest_mm_s = 1e-6;
/// Further off its place on the path, in times of what the machine travels in a cycle, the shadow
/// begins again.
constexpr double kLostCycles = 50.0;
constexpr double kLeastShare = 0.02;  ///< of the machine's speed, where no path is known

}  // namespace

double FeedGovernor::Shadow::told(std::size_t back) const noexcept {
  return word[(at + kHistory - 1 - std::min(back, kHistory - 1)) % kHistory];
}

/// The word that acts by now: told a dead time and half of a scan ago.
double FeedGovernor::acting_ratio() const noexcept {
  const Forecast::Timing& timing = forecast_.timing();
  return state_.shadow.told(
      static_cast<std::size_t>((timing.dead_s + 0.5 * timing.scan_s) / cycle_s_));
}

/// Begins where the machine is.
void FeedGovernor::begin_shadow(const Frame& frame) noexcept {
  Shadow& shadow = state_.shadow;
  shadow.outset = machine(frame);
  shadow.outset.foot_mm = contour_.state().foot_position_mm;
  if (precompensator_.enabled() && state_.last.path_known) {
    const double first_mm = ahead_.cell(ahead_.begin()).position_mm;
    const double behind_mm = frame.path_speed_mm_s * precompensator_.point().lag_s();
    shadow.outset.tool = precompensator_.point().at(
        ahead_, std::max(first_mm, frame.path_position_mm - behind_mm), frame.path_speed_mm_s);
    shadow.outset.offset = {};
  }
  shadow.on = true;
}

/// Along the path to the machine's place; the time that takes.
double FeedGovernor::carry_shadow(const Frame& frame, double dt) noexcept {
  Outset& from = state_.shadow.outset;
  const double place_mm = frame.path_position_mm;
  const double lost_mm = kLostCycles * std::max(dt * frame.path_speed_mm_s, 0.01);
  const double first_mm = ahead_.cell(ahead_.begin()).position_mm;
  if (!(frame.path_speed_mm_s > kAtRest_mm_s) || std::abs(from.position_mm - place_mm) > lost_mm ||
      std::min({from.foot_mm, from.position_mm, from.tool ? from.tool->position_mm : place_mm}) <
          first_mm ||
      from.position_mm > ahead_.known_to_mm()) {
    begin_shadow(frame);
    return dt;
  }
  // The cells may have been made again since.
  from.command_cell = ahead_.find(from.position_mm, state_.command_cell);
  from.foot_cell = std::min(ahead_.find(from.foot_mm, state_.foot_cell), from.command_cell);
  if (from.tool) {
    from.tool->cell = ahead_.find(from.tool->position_mm, from.foot_cell);
  }
  from.rapid_ratio = frame.rapid.effective_ratio;
  from.panel_ratio = panel_limit(frame);
  from.follows = state_.offsets_follow;
  const std::size_t steps = forecast_.carry(ahead_, place_mm, acting_ratio(),
                                            std::max(kMostCarried, search_steps_), from);
  return forecast_.timing().step_s * static_cast<double>(steps);
}

/// The ratio goes on as the envelope would let it, and each cycle tells it.
void FeedGovernor::tell_shadow(const Frame& frame, double step_s) noexcept {
  Shadow& shadow = state_.shadow;
  const Forecast::Timing& timing = forecast_.timing();
  const double panel = panel_limit(frame);
  const double wanted =
      std::min({state_.last.request.ratio, panel, config_.envelope.max_feed_ratio});
  shadow.ratio = std::clamp(wanted, shadow.ratio - timing.fall_1_s * step_s,
                            shadow.ratio + timing.rise_1_s * step_s);
  shadow.untold_s += step_s;
  for (std::size_t i = 0; i < kHistory && shadow.untold_s >= cycle_s_; ++i) {
    shadow.untold_s -= cycle_s_;
    shadow.word[shadow.at] = std::min(panel, forecast_.floor_ratio(shadow.ratio));
    shadow.at = (shadow.at + 1) % kHistory;
  }
  shadow.untold_s = std::min(shadow.untold_s, cycle_s_);
}

void FeedGovernor::follow_shadow(const Frame& frame, const kernel::signal::InForce& in_force,
                                 double dt) noexcept {
  Shadow& shadow = state_.shadow;
  if (in_force.written) {
    if (shadow.on) {
      // Its time was another.
      shadow = {};
      state_.next_decision_s = state_.next_objective_s = state_.time_s;
      state_.fallen_s = state_.time_s - config_.pause_s;
    }
    return;
  }
  if (!shadow.on) {
    shadow.ratio = in_force.feed.ratio;
    shadow.word.fill(in_force.feed.word_ratio);
    begin_shadow(frame);
  }
  if (!is_step(dt)) {
    // A repeated frame takes no time; after a gap the shadow begins where the machine is.
    if (dt != 0.0) {
      begin_shadow(frame);
    }
    shadow.step_s = 0.0;
  } else {
    shadow.step_s = state_.last.path_known ? carry_shadow(frame, dt) : dt / shadow_share(frame);
    shadow.lead_s += shadow.step_s - dt;
    tell_shadow(frame, shadow.step_s);
  }
  state_.in_force_ratio = shadow.ratio;
}

/// Of the machine's speed. A lag grows with the speed, so its share is the same.
double FeedGovernor::shadow_share(const Frame& frame) const noexcept {
  const double effective = frame.feed.effective_ratio;
  return effective > 0.0 ? std::clamp(acting_ratio() / effective, kLeastShare, 1.0) : 1.0;
}

}  // namespace steadyrest::contour::online
