// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/envelope.hpp>

// Last step before any write. Everything here is clamped, slewed and bounded by the panel whatever
// comes in; the outgoing reason names the one cause that the operator can act on.
namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;

outcome::Refusal refusal(const char* name, double value, const char* allowed) {
  return outcome::bad_input(fmt::format("envelope: {} is {}; allowed: {}", name, value, allowed),
                            "correct the envelope in the machine file");
}

bool positive(double value) noexcept {
  return std::isfinite(value) && value > 0.0;
}

bool all_finite(const signal::AxisValues& values) noexcept {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

// At most one step's fall or rise towards the target: the slew limit.
double toward(double from, double target, double fall, double rise) noexcept {
  return std::clamp(target, from - fall, from + rise);
}

/// Invalid time gives no credit.
double credit_s(double step_s, double max_step_s) noexcept {
  // A clock that jumps must not buy a jump of the override.
  return std::isfinite(step_s) ? std::clamp(step_s, 0.0, max_step_s) : 0.0;
}

}  // namespace

// An infinite rate or step would switch the slew off, so neither is allowed.
outcome::Result<RatioEnvelope> RatioEnvelope::make(const Config& config) {
  if (!positive(config.max_ratio)) {
    return std::unexpected(refusal("max_ratio", config.max_ratio, "finite and > 0"));
  }
  if (!(config.min_ratio >= 0.0 && config.min_ratio <= config.max_ratio)) {
    return std::unexpected(refusal("min_ratio", config.min_ratio, "0 … max_ratio"));
  }
  if (!positive(config.fall_1_s)) {
    return std::unexpected(refusal("fall_1_s", config.fall_1_s, "finite and > 0"));
  }
  if (!positive(config.rise_1_s)) {
    return std::unexpected(refusal("rise_1_s", config.rise_1_s, "finite and > 0"));
  }
  if (!positive(config.max_step_s)) {
    return std::unexpected(refusal("max_step_s", config.max_step_s, "finite and > 0"));
  }
  return RatioEnvelope(config);
}

// An unknown or unfit panel keeps the last known value.
Reason RatioEnvelope::see_panel(const signal::OverrideState& panel) noexcept {
  if (!panel.panel_code_known) {
    return Reason::unknown_override_code;
  }
  if (const Reason fault = fault_of(panel.panel_ratio); fault != Reason::none) {
    return fault;
  }
  state_.panel_ratio = panel.panel_ratio;
  if (!state_.panel_seen) {
    state_.panel_seen = true;
    // The first panel value seen is where the machine is.
    state_.ratio = panel.panel_ratio;
  }
  return Reason::none;
}

// A wish is clamped first and bounded by the panel afterwards: the panel is the operator's and has
// no lower limit. Neutral means the panel itself, not 1.0. During a hold the target is the present
// ratio.
RatioEnvelope::Target RatioEnvelope::target(const Input& input, Reason unfit) const noexcept {
  const double panel = state_.panel_ratio;
  Target target{.ratio = panel, .unfit = unfit};
  target.neutral = unfit != Reason::none || !is_wish(input.ratio, input.reason);
  if (!target.neutral) {
    target.ratio = std::clamp(input.ratio, config_.min_ratio, config_.max_ratio);
    target.clamped = target.ratio != input.ratio;
    target.panel_limits = !config_.may_exceed_panel && target.ratio > panel;
    target.ratio = target.panel_limits ? panel : target.ratio;
  }
  if (input.hold) {
    target.neutral = state_.at_panel;
    target.ratio = state_.ratio;
  }
  return target;
}

// Order: what is wrong with the input, what the operator does, what the layer does to itself.
Reason RatioEnvelope::explain(const Target& target, Reason asked) const noexcept {
  const bool at_panel = state_.ratio == state_.panel_ratio;
  if (target.unfit != Reason::none) {
    return target.unfit;
  }
  if (state_.panel_ratio == 0.0) {
    return Reason::panel_zero;
  }
  if (target.neutral) {
    return asked == Reason::none && !at_panel ? Reason::slew_limited : asked;
  }
  if (target.panel_limits && at_panel) {
    return Reason::panel_lower;
  }
  if (state_.ratio != target.ratio) {
    return Reason::slew_limited;
  }
  return target.clamped ? Reason::clamped : asked;
}

RatioEnvelope::Output RatioEnvelope::update(const Input& input) noexcept {
  // Before its first look at the panel the layer had nothing in force.
  const double step_s = state_.panel_seen ? credit_s(input.step_s, config_.max_step_s) : 0.0;
  const Reason panel_fault = see_panel(input.panel);
  Reason unfit = std::isfinite(input.step_s) ? input.unfit : Reason::input_not_finite;
  for (const Reason fault : {panel_fault, fault_of(input.ratio)}) {
    unfit = unfit == Reason::none ? fault : unfit;
  }
  const Target aim = target(input, unfit);
  const double panel = state_.panel_ratio;
  // At the panel and without a wish the operator's switch acts at once, up or down; the slew is for
  // the layer's own changes. Where the layer may exceed the panel, its way also begins there.
  if (state_.at_panel && (aim.neutral || config_.may_exceed_panel)) {
    state_.ratio = panel;
  }
  if (!aim.neutral || !state_.at_panel) {
    state_.ratio =
        toward(state_.ratio, aim.ratio, config_.fall_1_s * step_s, config_.rise_1_s * step_s);
  }
  // Down to the panel without any slew: the operator never waits for the layer.
  if (panel == 0.0 || !config_.may_exceed_panel) {
    state_.ratio = std::min(state_.ratio, panel);
  }
  state_.at_panel = aim.neutral && state_.ratio == panel;
  // Where the layer may exceed the panel, a wish keeps the mask even at the panel's own ratio.
  // Otherwise turning the switch would act until the mask is on, and the layer would then undo it
  // with a jump.
  const bool hand_back =
      config_.may_exceed_panel ? state_.at_panel || panel == 0.0 : state_.ratio == panel;
  return {.ratio = state_.ratio,
          .panel_ratio = panel,
          .panel_known = panel_fault == Reason::none,
          .hand_back = hand_back || !state_.panel_seen,
          .reason = explain(aim, input.reason)};
}

// An unfit state starts over at the panel.
void RatioEnvelope::restore(const State& state) noexcept {
  const bool fit =
      fault_of(state.ratio) == Reason::none && fault_of(state.panel_ratio) == Reason::none;
  state_ = fit ? state : State{};
}

outcome::Result<OffsetEnvelope> OffsetEnvelope::make(const Config& config) {
  for (const double max_mm : config.max_mm) {
    if (!std::isfinite(max_mm) || max_mm < 0.0) {
      return std::unexpected(refusal("max_offset_mm", max_mm, "finite and ≥ 0"));
    }
  }
  if (!positive(config.slew_mm_s)) {
    return std::unexpected(refusal("offset_slew_mm_s", config.slew_mm_s, "finite and > 0"));
  }
  if (!std::isfinite(config.fade_mm_s) || config.fade_mm_s < 0.0) {
    return std::unexpected(refusal("fade_mm_s", config.fade_mm_s, "finite and ≥ 0"));
  }
  if (!positive(config.max_step_s)) {
    return std::unexpected(refusal("max_step_s", config.max_step_s, "finite and > 0"));
  }
  return OffsetEnvelope(config);
}

// What is beyond the allowed goes there first, by the slew: nobody may hold it. What the slew then
// leaves of this cycle each axis moves at the room's slope. A target not yet reached counts as
// slew-limited only where the envelope limits: a room that chose to go slowly is not held up.
bool OffsetEnvelope::approach(const signal::AxisValues& target_mm,
                              const signal::AxisValues& slope_mm_s,
                              const signal::AxisValues& beside_mm, double step_s) noexcept {
  const double most_mm = config_.slew_mm_s * step_s;
  bool reached = true;
  for (std::size_t axis = 0; axis < target_mm.size(); ++axis) {
    double& offset_mm = state_.offset_mm[axis];
    const double before_mm = offset_mm;
    offset_mm = toward(offset_mm, within(axis, offset_mm, beside_mm[axis]), most_mm, most_mm);
    const double returned_mm = std::abs(offset_mm - before_mm);
    // A slope that is NaN or negative moves nothing.
    const double slope = slope_mm_s[axis] >= 0.0 ? slope_mm_s[axis] : 0.0;
    const double step_mm =
        std::min(std::min(slope, config_.slew_mm_s) * step_s, std::max(0.0, most_mm - returned_mm));
    offset_mm = toward(offset_mm, target_mm[axis], step_mm, step_mm);
    reached = reached &&
              (offset_mm == target_mm[axis] || (returned_mm == 0.0 && slope <= config_.slew_mm_s));
  }
  return reached;
}

/// What the limit and the others' offset leave.
double OffsetEnvelope::within(std::size_t axis, double offset_mm, double beside_mm) const noexcept {
  const double limit_mm = config_.max_mm[axis];
  const double beside = std::isfinite(beside_mm) ? std::clamp(beside_mm, -limit_mm, limit_mm) : 0.0;
  return std::clamp(offset_mm, std::max(-limit_mm, -limit_mm - beside),
                    std::min(limit_mm, limit_mm - beside));
}

// The limits may have been lowered since the state was written: cutting to them would jump.
bool OffsetEnvelope::restore(const State& state) noexcept {
  bool fit = true;
  for (std::size_t axis = 0; axis < state.offset_mm.size(); ++axis) {
    const double most_mm = std::max(kMostOffset_mm, config_.max_mm[axis]);
    fit = fit && std::abs(state.offset_mm[axis]) <= most_mm;  // false for NaN
  }
  state_ = fit ? state : State{};
  return fit;
}

OffsetEnvelope::Output OffsetEnvelope::update(const Input& input) noexcept {
  const double step_s = credit_s(input.step_s, config_.max_step_s);
  const auto& request = input.request;
  const bool finite = all_finite(request.offset_mm);
  Reason unfit = std::isfinite(input.step_s) ? input.unfit : Reason::input_not_finite;
  unfit = unfit == Reason::none && !finite ? Reason::input_not_finite : unfit;

  Output output;
  // Without a wish the offset freezes while the machine or the room says that a tool may be in the
  // cut; moving it there would leave a step in the part. Afterwards it ramps out at the envelope's
  // own slew.
  if (unfit == Reason::none && is_wish(request.reason)) {
    signal::AxisValues target_mm{};
    for (std::size_t axis = 0; axis < target_mm.size(); ++axis) {
      target_mm[axis] = within(axis, request.offset_mm[axis], input.beside_mm[axis]);
    }
    output.reason = target_mm == request.offset_mm ? request.reason : Reason::clamped;
    if (!approach(target_mm, request.slope_mm_s, input.beside_mm, step_s)) {
      output.reason = Reason::slew_limited;
    }
  } else {
    output.reason = unfit != Reason::none ? unfit : request.reason;
    if (config_.fade_mm_s > 0.0) {
      signal::AxisValues fade{};
      fade.fill(config_.fade_mm_s);
      approach({}, fade, input.beside_mm, step_s);
    } else if (!input.tool_in_cut && !request.tool_in_cut) {
      approach({}, signal::any_slope(), input.beside_mm, step_s);
    } else {
      approach({}, {}, input.beside_mm, step_s);
    }
  }
  output.offset_mm = state_.offset_mm;
  output.at_zero = state_.offset_mm == signal::AxisValues{};
  return output;
}

}  // namespace steadyrest::kernel::override
