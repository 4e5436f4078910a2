// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/blocks/machine_words.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/tool_table.hpp>

namespace steadyrest::nc::interpret {

void MachineWords::feed(const Step& step) noexcept {
  const int mode = step.code(GGroup::feed_mode);
  if (mode != kNoCode) {
    const FeedMode wanted = mode == g::kInverseTime ? FeedMode::inverse_time
                            : mode == g::kPerMinute ? FeedMode::per_minute
                                                    : FeedMode::per_revolution;
    // LinuxCNC clears F at every G94 and G95, the others only when the mode changes: a feed per
    // minute makes no sense per revolution.
    if (wanted != state_.feed_mode || control_.rules.feed_mode_clears_feed) {
      state_.feed_mode = wanted;
      state_.feed_mm_s = 0.0;
      state_.feed_deg_s = 0.0;
    }
  }
  if (!step.has('F')) {
    return;
  }
  // F is in the unit in force for feeds, which G70 and G71 do not change. For rotary axes it is in
  // degrees, whatever the unit.
  const double unit = state_.feed_unit_mm;
  switch (state_.feed_mode) {
    case FeedMode::per_minute:
      state_.feed_mm_s = step['F'] * unit / 60.0;
      state_.feed_deg_s = step['F'] / 60.0;
      break;
    // F is 1/min, so feed_mm_s holds moves per second; the length converts it to mm/s later.
    case FeedMode::inverse_time:
      state_.feed_mm_s = step['F'] / 60.0;
      state_.feed_deg_s = state_.feed_mm_s;
      break;
    case FeedMode::per_revolution:
      state_.feed_mm_s = step['F'] * unit;
      state_.feed_deg_s = step['F'];
      break;
  }
}

bool MachineWords::spindle_speed(const Step& step) {
  const int mode = step.code(GGroup::spindle_mode);
  if (!std::isnan(step.speed_limit_rpm)) {
    state_.kept_limit_rev_s = step.speed_limit_rpm / 60.0;
    state_.spindle_limit_rev_s = state_.surface_speed ? state_.kept_limit_rev_s : 0.0;
  }
  if (mode == g::kCuttingSpeed) {
    if (!step.has('S')) {
      return refusals_.g_word(step, g::kCuttingSpeed, "speed_missing",
                              "G96 without its cutting speed (S)");
    }
    state_.surface_speed = true;
    // The limit acts as the tool comes near the centre; without D or G92 S only the spindle limits.
    state_.spindle_limit_rev_s =
        step.has('D') ? std::abs(step['D']) / 60.0 : state_.kept_limit_rev_s;
  } else if (mode == g::kSpindleSpeed) {
    state_.surface_speed = false;
    state_.surface_speed_mm_s = 0.0;
    state_.spindle_limit_rev_s = 0.0;
  }
  // G97 without S continues at the last S in rev/min.
  if (!step.has('S')) {
    return within_limit(step);
  }
  if (state_.surface_speed) {  // m/min, after G20 ft/min
    constexpr double kMmPerFoot = 304.8;
    const bool inch = state_.unit_mm != 1.0;
    state_.surface_speed_mm_s = step['S'] * (inch ? kMmPerFoot : 1000.0) / 60.0;
    state_.spindle_speed_rev_s = 0.0;
  } else {
    state_.spindle_speed_rev_s = step['S'] / 60.0;
  }
  if (!within_limit(step)) {
    return false;
  }
  // A new S takes effect at once if the spindle is turning.
  if (state_.spindle_direction != 0) {
    out_.spindle();
  }
  return true;
}

// sinumerik: LIMS and G26 S. The spindle would turn at the limit, not at S.
bool MachineWords::within_limit(const Step& step) {
  const bool above = control_.rules.speed_limit_always && state_.kept_limit_rev_s > 0.0 &&
                     state_.spindle_speed_rev_s > state_.kept_limit_rev_s;
  return !above || refusals_.letter(step, 'S', "speed_above_limit",
                                    "a spindle speed (S) above the limit that the program has set "
                                    "(LIMS, G26 S)");
}

// T prepares, M6 changes. On sinumerik a tool may have a name instead of a number.
bool MachineWords::select_tool(const Step& step) {
  if (!step.tool_name.empty()) {
    selected_name_ = step.tool_name;
    state_.selected_tool = 0;
    return true;
  }
  if (step.has('T')) {
    selected_name_.clear();
  }
  return !step.has('T') || tool_number(control_, step, 'T', state_.selected_tool);
}

// The control takes the machine's position: after G40 not the contour's.
bool MachineWords::change_tool(const Step& step) {
  const int code = step.code(MGroup::tool_change);
  if (code == kNoCode) {
    return true;
  }
  // M61 tells which tool is in the spindle; nothing moves.
  if (code == m::kToolInSpindle) {
    if (!step.has('Q') || step['Q'] != std::floor(step['Q']) || step['Q'] < 0.0) {
      return refusals_.m_word(step, 61, "tool_missing",
                              "M61 without the number of the tool in the spindle (Q)");
    }
    state_.position = out_.take_place();
    if (!tool_number(control_, step, 'Q', state_.tool_in_spindle)) {
      return false;
    }
    load_tool(control_);
    return true;
  }
  state_.tool_in_spindle = state_.selected_tool;
  load_tool(control_);
  // LinuxCNC takes G43 as in force while some length is.
  if (control_.config.settings.tool_change_keeps_offset && state_.tool_offset != Axes{}) {
    const Tool* const tool = find_tool(control_.config, state_.tool_in_spindle);
    state_.tool_offset = tool == nullptr ? Axes{} : tool->offset;
    update_offset(state_);
  }
  state_.position = out_.take_place();
  out_.event(EventKind::tool_change, static_cast<double>(state_.tool_in_spindle), selected_name_);
  return true;
}

// An event for each word, even if nothing changes: M3 also starts the wait for the speed.
void MachineWords::spindle(const Step& step) {
  const int code = step.code(MGroup::spindle);
  // M29 stops the spindle; the tapping cycles start it at the R plane, in step with the feed.
  if (step.rigid_tap) {
    state_.rigid_tap = true;
    if (state_.spindle_direction != 0) {
      state_.spindle_direction = 0;
      out_.spindle();
    }
  }
  if (code != kNoCode) {
    state_.spindle_direction = code == m::kClockwise ? 1 : code == m::kCounterClockwise ? -1 : 0;
    out_.spindle();
  }
}

void MachineWords::coolant(const Step& step) {
  const int code = step.code(MGroup::coolant);
  if (code == kNoCode) {
    return;
  }
  // Bit 1 is mist, bit 2 flood: both may be on; M9 switches both off.
  const auto bits = static_cast<unsigned>(state_.coolant);
  const unsigned wanted = code == m::kCoolantOff ? 0U : code == m::kMist ? bits | 1U : bits | 2U;
  state_.coolant = static_cast<double>(wanted);
  out_.event(EventKind::coolant, state_.coolant);
}

void MachineWords::overrides(const Step& step) noexcept {
  const int code = step.code(MGroup::override_switch);
  if (code == kNoCode) {
    return;
  }
  // M50 P0 switches the feed override off; another P or none switches it on.
  const bool off = step.has('P') && step['P'] == 0.0;
  if (code == m::kOverridesOn || code == m::kOverridesOff) {
    state_.override_off = code == m::kOverridesOff;
  } else if (code == m::kFeedOverride) {
    state_.override_off = off;
  }
  // M51 controls the spindle override, M52 adaptive feed, M53 feed hold: no effect on the moves.
}

// Outputs and inputs move nothing, but a missing number would be an error on the control.
bool MachineWords::outputs(const Step& step) {
  const int code = step.code(MGroup::io);
  if (code >= m::kOutputOnWithMove && code <= m::kOutputOff && !step.has('P')) {
    return refusals_.m_word(step, code, "word_missing", "an output without its number (P)");
  }
  if (code == m::kWaitForInput && step.has('P') == step.has('E')) {
    return refusals_.m_word(step, code, "word_missing",
                            "M66 needs the number of one input: P (digital) or E (analog)");
  }
  if ((code == m::kAnalogWithMove || code == m::kAnalog) && !(step.has('E') && step.has('Q'))) {
    return refusals_.m_word(step, code, "word_missing",
                            "an analog output without its number (E) or value (Q)");
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
