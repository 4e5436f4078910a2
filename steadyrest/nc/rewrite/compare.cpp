// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/nc/rewrite/compare.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Axes;
using interpret::Event;
using interpret::Move;
using interpret::State;

namespace {

bool same_axes(const Axes& a, const Axes& b) {
  return std::ranges::equal(a, b, [](double x, double y) { return same(x, y); });
}

}  // namespace

std::string_view first_difference(const Move& a, const Move& b) {
  if (a.kind != b.kind) {
    return "kind of move";
  }
  if (a.feed_mm_s != b.feed_mm_s || a.feed_mode != b.feed_mode) {
    return "feed";
  }
  if (a.normal != b.normal || a.turns != b.turns || a.spline_order != b.spline_order) {
    return "arc's plane or turns";
  }
  if (a.rotation_deg != b.rotation_deg) {
    return "rotation";
  }
  if (a.path_mode != b.path_mode || a.path_tolerance_mm != b.path_tolerance_mm) {
    return "path mode";
  }
  if (a.spindle_rev_s != b.spindle_rev_s || a.surface_speed_mm_s != b.surface_speed_mm_s ||
      a.spindle_limit_rev_s != b.spindle_limit_rev_s || a.speed_modulation != b.speed_modulation) {
    return "spindle speed";
  }
  if (a.override_locked != b.override_locked) {
    return "override lock";
  }
  return a.dwell_s == b.dwell_s ? std::string_view{} : "dwell";
}

bool equal_events(const std::vector<Event>& a, const std::vector<Event>& b) {
  return std::ranges::equal(
      a, b, [](const Event& x, const Event& y) { return x.kind == y.kind && x.value == y.value; });
}

Modes modes_of(const State& state) {
  return {.active_offset = state.active_offset,
          .rotation_deg = state.rotation_in_force_deg,
          .unit_mm = state.unit_mm,
          .plane = state.plane,
          .incremental = state.incremental,
          .centre_absolute = state.centre_absolute,
          .retract_to_initial = state.retract_to_initial,
          .motion = state.motion,
          .feed_mode = state.feed_mode,
          .feed_mm_s = state.feed_mm_s,
          .path_mode = state.path_mode,
          .path_tolerance_mm = state.path_tolerance_mm,
          .override_off = state.override_off,
          .spindle_speed_rev_s = state.spindle_speed_rev_s,
          .spindle_direction = state.spindle_direction,
          .surface_speed = state.surface_speed,
          .surface_speed_mm_s = state.surface_speed_mm_s,
          .coolant = state.coolant,
          .selected_tool = state.selected_tool,
          .tool_in_spindle = state.tool_in_spindle,
          .cutter_side = state.cutter_side,
          .diameter = state.diameter};
}

void renew(Modes& modes, const State& state, bool moved_alone) {
  if (!moved_alone) {
    modes = modes_of(state);
  }
  modes.motion = state.motion;
  modes.feed_mm_s = state.feed_mm_s;
}

std::string_view state_difference(const State& a, const State& b) {
  if (!std::ranges::equal(a.work_offset, b.work_offset, same_axes)) {
    return "work offset";
  }
  if (!same_axes(a.g92, b.g92) || !same_axes(a.g92_stored, b.g92_stored)) {
    return "shift (G52, G92)";
  }
  if (!same_axes(a.tool_offset, b.tool_offset)) {
    return "tool length";
  }
  if (!same_axes(a.offset, b.offset)) {
    return "offset";
  }
  const bool modes = modes_of(a) == modes_of(b);
  return modes ? std::string_view{} : "modal state";
}

}  // namespace steadyrest::nc::rewrite
