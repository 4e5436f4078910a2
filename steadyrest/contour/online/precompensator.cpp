// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <steadyrest/contour/online/precompensator.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// The tool point is led by what the command really did up to this frame, and a copy of it ahead by
// one cycle and the port's delay by what the command will probably do: so an error of that
// prediction is forgotten with the next frame.
namespace steadyrest::contour::online {
namespace {

using kernel::outcome::Reason;
using kernel::outcome::refuse;
using kernel::signal::OffsetRequest;
using kernel::signal::Point;
using kernel::signal::Room;

constexpr double kLongestDelay_s = 0.02;
constexpr double kMostCycles = 20.0;
/// Of a command that is at rest: nothing moves, so the offsets may begin at their full size.
constexpr double kStill_mm_s = 1e-6;

/// The cells reach from here to the command; after a start within a long arc they do so only once
/// enough of them have been made.
bool covers(const LookAhead& path, double position_mm) noexcept {
  return !path.empty() && path.cell(path.begin()).position_mm <= position_mm &&
         path.known_to_mm() >= position_mm;
}

}  // namespace

kernel::outcome::Result<Precompensator> Precompensator::make(const Config& config) {
  if (!(config.max_offset_mm >= 0.0) || !std::isfinite(config.max_offset_mm)) {
    return refuse("the largest path offset is " + std::to_string(config.max_offset_mm) +
                      " mm; allowed: 0 or more",
                  "correct max_path_offset_um in [envelope]");
  }
  if (!(config.delay_s >= 0.0 && config.delay_s <= kLongestDelay_s)) {
    return refuse(
        "path offsets act " + std::to_string(config.delay_s) + " s late; allowed: 0 … 0.02 s",
        "correct the delay that the port states");
  }
  if (!(config.acceleration_mm_s2 >= 0.0)) {
    return refuse("path offsets accelerate with " + std::to_string(config.acceleration_mm_s2) +
                      " mm/s²; allowed: 0 (no limit) or more",
                  "correct the acceleration that the port states");
  }
  if (!(config.fade_in_s > 0.0)) {
    return refuse("fade_in_s is " + std::to_string(config.fade_in_s) + "; allowed: above 0",
                  "correct fade_in_s");
  }
  return Precompensator(config);
}

Precompensator::Precompensator(const Config& config) noexcept : config_(config) {
  ToolPoint::Config point{.half_backlash_mm = {}, .most_behind_mm = config.max_offset_mm};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, config.axes.size()); ++i) {
    point.half_backlash_mm[i] = 0.5 * config.axes[i].backlash_au;
  }
  point_ = ToolPoint(point);
}

std::optional<ToolPoint::State> Precompensator::in_full() const noexcept {
  const bool is_full = enabled() && state_.started && state_.share >= 1.0;
  return is_full ? std::optional(state_.tool) : std::nullopt;
}

std::optional<ToolPoint::State> Precompensator::tool() const noexcept {
  return enabled() && state_.started ? std::optional(state_.tool) : std::nullopt;
}

OffsetRequest Precompensator::update(const Input& input) noexcept {
  const auto offset = state_.offset;
  const OffsetRequest request = ask(input);
  state_.offset = offset;  // it goes on moving, whatever becomes of the request
  if (config_.acceleration_mm_s2 > 0.0 && input.step_s > 0.0) {
    for (std::size_t i = 0; i < state_.offset.size(); ++i) {
      state_.offset[i].follow(input.active ? request.offset_mm[i] : 0.0, config_.acceleration_mm_s2,
                              input.step_s);
    }
  }
  return request;
}

OffsetRequest Precompensator::ask(const Input& input) noexcept {
  OffsetRequest request{.room = Room::contour};
  const kernel::signal::Frame& frame = input.frame;
  if (!enabled() || !input.permitted || !covers(input.path, frame.path_position_mm)) {
    state_ = {};
    return request;
  }
  const double position_mm = frame.path_position_mm;
  const double speed_mm_s = frame.path_speed_mm_s;
  const bool goes_on = state_.started && input.step_s > 0.0 && position_mm >= state_.position_mm;
  if (goes_on) {
    point_.advance(input.path, state_.position_mm, position_mm, input.step_s, state_.tool);
  } else {
    const double first_mm = input.path.cell(input.path.begin()).position_mm;
    const double behind_mm = speed_mm_s * point_.lag_s();
    state_.tool = point_.at(input.path, std::max(first_mm, position_mm - behind_mm), speed_mm_s);
    state_.share = 0.0;
    state_.speed_mm_s = speed_mm_s;
  }
  const bool at_rest = speed_mm_s < kStill_mm_s;
  const double more = at_rest ? 1.0 : input.step_s / config_.fade_in_s;
  state_.share = input.active ? std::min(1.0, state_.share + more) : 0.0;
  const double change_mm_s = speed_mm_s - state_.speed_mm_s;
  state_.started = true;
  state_.position_mm = position_mm;
  state_.speed_mm_s = speed_mm_s;
  if (!(input.step_s > 0.0)) {
    return request;  // the length of a cycle is not known yet
  }
  double next_mm = position_mm;
  ToolPoint::State next = state_.tool;
  const double cycles = std::clamp(std::round(config_.delay_s / input.step_s), 0.0, kMostCycles);
  for (double i = 0.0; i <= cycles; i += 1.0) {
    const double from_mm = next_mm;
    next_mm = std::clamp(from_mm + (speed_mm_s + (i + 0.5) * change_mm_s) * input.step_s, from_mm,
                         std::max(from_mm, input.path.known_to_mm()));
    point_.advance(input.path, from_mm, next_mm, input.step_s, next);
  }
  const Cell& cell = input.path.cell(input.path.find(next_mm, next.cell));
  const Point command = on_cell(cell, next_mm - cell.position_mm);
  for (std::size_t i = 0; i < std::min<std::size_t>(3, config_.axes.size()); ++i) {
    request.offset_mm[i] = input.follows ? state_.share * (next.command_mm[i] - command[i]) : 0.0;
  }
  request.reason = !input.follows       ? Reason::contour_offset_too_slow
                   : state_.share < 1.0 ? Reason::contour_cancel_begins
                                        : Reason::contour_cancelled;
  return request;
}

}  // namespace steadyrest::contour::online
