// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Axes;
using interpret::Event;
using interpret::Move;
using interpret::State;

namespace {

bool same_axes(const Axes& a, const Axes& b) {
  return std::ranges::equal(a, b, [](double x, double y) { return same(x, y); });
}

bool same_tool(const interpret::Tool& a, const interpret::Tool& b) {
  return a.number == b.number && same_axes(a.offset, b.offset) &&
         same(a.diameter_mm, b.diameter_mm) && same(a.front_angle_deg, b.front_angle_deg) &&
         same(a.back_angle_deg, b.back_angle_deg) && a.orientation == b.orientation;
}

using Variables = std::vector<std::pair<std::string, double>>;

/// The first variable that only one has or whose values differ. Both lists are sorted (numbers,
/// then names), so the first mismatch of a merge is the first difference.
std::string variable_difference(Variables a, Variables b) {
  for (Variables* const one : {&a, &b}) {
    // The corrections' own parameters always differ, and no program may use them.
    std::erase_if(*one, [](const auto& named) { return named.first.starts_with(kOwnNames); });
  }
  const auto [in_a, in_b] = std::ranges::mismatch(a, b, [](const auto& x, const auto& y) {
    // The difference of equal infinities is NaN, hence ==; an unset value is NaN in both.
    const bool value = same(x.second, y.second) || x.second == y.second ||
                       (std::isnan(x.second) && std::isnan(y.second));
    return x.first == y.first && value;
  });
  return in_a != a.end() ? in_a->first : in_b != b.end() ? in_b->first : std::string{};
}

}  // namespace

// Compared without tolerance: both values come from the same text by the same arithmetic. Only
// positions may differ; Shifts checks those.
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

// What the inserted lines must leave unchanged. Position and offsets are missing on purpose: a
// correction changes them.
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

// A plain line sets only motion and feed. Copying all modes for each line would cost more than the
// rest of the comparison.
void renew(Modes& modes, const State& state, bool moved_alone) {
  if (!moved_alone) {
    modes = modes_of(state);
  }
  modes.motion = state.motion;
  modes.feed_mm_s = state.feed_mm_s;
}

std::string_view state_difference(const State& a, const State& b) {
  // Every correction must be gone at the end, so offsets agree again within rounding.
  if (!std::ranges::equal(a.work_offset, b.work_offset, same_axes)) {
    return "work offset";
  }
  if (!same_axes(a.g92, b.g92) || !same_axes(a.g92_stored, b.g92_stored) || a.g92_on != b.g92_on) {
    return "shift (G52, G92)";
  }
  if (!same_axes(a.tool_offset, b.tool_offset)) {
    return "tool length";
  }
  if (!same_axes(a.offset, b.offset) || !same_axes(a.work_in_force, b.work_in_force) ||
      !same_axes(a.external, b.external) || a.work_offset_on != b.work_offset_on) {
    return "offset";
  }
  const bool modes = modes_of(a) == modes_of(b);
  return modes ? std::string_view{} : "modal state";
}

// What the control keeps after the program: reference points, rotations, tool data, parameters. A
// correction that gets in here stays.
std::string kept_difference(const interpret::ProgramRun& original,
                            const interpret::ProgramRun& changed) {
  const State& a = original.state();
  const State& b = changed.state();
  if (!same_axes(a.home[0], b.home[0]) || !same_axes(a.home[1], b.home[1])) {
    return same_axes(a.home[0], b.home[0]) ? "the reference point of G30"
                                           : "the reference point of G28";
  }
  if (!std::ranges::equal(a.rotation_deg, b.rotation_deg, same)) {
    return "the rotation of a work offset";
  }
  interpret::ProgramRun::Kept kept = original.kept();
  interpret::ProgramRun::Kept kept_changed = changed.kept();
  const auto [tool, other] = std::ranges::mismatch(kept.tools, kept_changed.tools, same_tool);
  if (tool != kept.tools.end() || other != kept_changed.tools.end()) {
    return fmt::format("the data of tool {}",
                       tool != kept.tools.end() ? tool->number : other->number);
  }
  return variable_difference(std::move(kept.variables), std::move(kept_changed.variables));
}

}  // namespace steadyrest::nc::rewrite
