// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <steadyrest/nc/interpret/parameters/parameter_answers.hpp>

namespace steadyrest::nc::interpret {
namespace {

// LinuxCNC's truth values are 1 and 0.
constexpr double truth(bool yes) noexcept {
  return yes ? 1.0 : 0.0;
}

// LinuxCNC's predefined named parameters (documentation 2.9, "Parameters"). An answer's `mode`
// tells which part of the state it shows, so that a rewriter knows what a line depends on. G codes
// are shown times ten, as in LinuxCNC: G54 is 540, G59.1 is 591.
constexpr auto kAnswers = std::to_array<std::pair<std::string_view, Answer>>({
    {"_vmajor", {.value = [](const State&) { return 2.9; }}},
    {"_vminor", {.value = [](const State&) { return 0.0; }}},
    {"_motion_mode",
     {.value = [](const State& s) { return s.motion < 0 ? 800.0 : static_cast<double>(s.motion); },
      .mode = mode(GGroup::motion)}},
    {"_plane",
     {.value =
          [](const State& s) {
            return s.plane == Plane::xy ? 170.0 : s.plane == Plane::zx ? 180.0 : 190.0;
          },
      .mode = mode(GGroup::plane)}},
    {"_ccomp",
     {.value =
          [](const State& s) {
            return s.cutter_side == 0 ? 400.0 : s.cutter_side < 0 ? 410.0 : 420.0;
          },
      .mode = mode(GGroup::cutter)}},
    {"_metric",
     {.value = [](const State& s) { return truth(s.unit_mm == 1.0); },
      .mode = mode(GGroup::units)}},
    {"_imperial",
     {.value = [](const State& s) { return truth(s.unit_mm != 1.0); },
      .mode = mode(GGroup::units)}},
    {"_absolute",
     {.value = [](const State& s) { return truth(!s.incremental); },
      .mode = mode(GGroup::distance)}},
    {"_incremental",
     {.value = [](const State& s) { return truth(s.incremental); },
      .mode = mode(GGroup::distance)}},
    {"_inverse_time",
     {.value = [](const State& s) { return truth(s.feed_mode == FeedMode::inverse_time); },
      .mode = mode(GGroup::feed_mode)}},
    {"_units_per_minute",
     {.value = [](const State& s) { return truth(s.feed_mode == FeedMode::per_minute); },
      .mode = mode(GGroup::feed_mode)}},
    {"_units_per_rev",
     {.value = [](const State& s) { return truth(s.feed_mode == FeedMode::per_revolution); },
      .mode = mode(GGroup::feed_mode)}},
    {"_coord_system",
     {.value =
          [](const State& s) {
            const auto set = static_cast<double>(s.active_offset);
            return set < 6.0 ? 540.0 + 10.0 * set : 585.0 + set;
          },
      .mode = mode(GGroup::work_offset)}},
    {"_tool_offset",
     {.value = [](const State& s) { return truth(s.tool_offset != Axes{}); },
      .mode = mode(GGroup::tool_length)}},
    {"_retract_r_plane",
     {.value = [](const State& s) { return truth(!s.retract_to_initial); },
      .mode = mode(GGroup::retract)}},
    {"_retract_old_z",
     {.value = [](const State& s) { return truth(s.retract_to_initial); },
      .mode = mode(GGroup::retract)}},
    {"_spindle_rpm_mode",
     {.value = [](const State& s) { return truth(!s.surface_speed); },
      .mode = mode(GGroup::spindle_mode)}},
    {"_spindle_css_mode",
     {.value = [](const State& s) { return truth(s.surface_speed); },
      .mode = mode(GGroup::spindle_mode)}},
    {"_ijk_absolute_mode",
     {.value = [](const State& s) { return truth(s.centre_absolute); },
      .mode = mode(GGroup::arc_centre)}},
    {"_lathe_diameter_mode",
     {.value = [](const State& s) { return truth(s.diameter); },
      .mode = mode(GGroup::lathe_diameter)}},
    {"_lathe_radius_mode",
     {.value = [](const State& s) { return truth(!s.diameter); },
      .mode = mode(GGroup::lathe_diameter)}},
    {"_spindle_on",
     {.value = [](const State& s) { return truth(s.spindle_direction != 0); },
      .mode = kSpindleMode}},
    {"_spindle_cw",
     {.value = [](const State& s) { return truth(s.spindle_direction > 0); },
      .mode = kSpindleMode}},
    {"_mist",
     {.value = [](const State& s) { return truth((static_cast<unsigned>(s.coolant) & 1U) != 0); },
      .mode = kCoolantMode}},
    {"_flood",
     {.value = [](const State& s) { return truth((static_cast<unsigned>(s.coolant) & 2U) != 0); },
      .mode = kCoolantMode}},
    {"_speed_override", {.value = [](const State&) { return 1.0; }}},
    {"_feed_override",
     {.value = [](const State& s) { return truth(!s.override_off); }, .mode = kOverrideMode}},
    {"_adaptive_feed", {.value = [](const State&) { return 0.0; }}},
    {"_feed_hold", {.value = [](const State&) { return 1.0; }}},
    {"_feed",
     {.value =
          [](const State& s) {
            return s.feed_mm_s * (s.feed_mode == FeedMode::per_revolution ? 1.0 : 60.0) /
                   (s.feed_mode == FeedMode::inverse_time ? 1.0 : s.unit_mm);
          },
      .mode = kFeedMode}},
    {"_rpm",
     {.value = [](const State& s) { return s.spindle_speed_rev_s * 60.0; }, .mode = kSpeedMode}},
    {"_current_tool",
     {.value = [](const State& s) { return static_cast<double>(s.tool_in_spindle); },
      .mode = kToolMode}},
    {"_selected_tool",
     {.value = [](const State& s) { return static_cast<double>(s.selected_tool); },
      .mode = kToolMode}},
    {"_remap_level", {.value = [](const State&) { return 0.0; }}},
});

}  // namespace

// A linear search: such names are rare in programs.
const Answer* answer_of(std::string_view name) {
  const auto* const found =
      std::ranges::find(kAnswers, name, [](const auto& one) { return one.first; });
  return found == kAnswers.end() ? nullptr : &found->second;
}

}  // namespace steadyrest::nc::interpret
