// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/kernel/outcome/reason.hpp>

namespace steadyrest::kernel::outcome {
namespace {

using Entry = ReasonEntry;

constexpr std::array kEntries = {
    Entry{Reason::none, "none", "Nothing to correct."},
    Entry{Reason::input_not_finite, "input_not_finite", "An input was not a finite number."},
    Entry{Reason::input_out_of_range, "input_out_of_range",
          "An input was outside of the machine's range."},
    Entry{Reason::input_stale, "input_stale", "The input is too old to act on."},
    Entry{Reason::not_cutting, "not_cutting", "The machine is not cutting."},
    Entry{Reason::withdrawn_thread, "withdrawn_thread",
          "Threading or tapping: the override must not move."},
    Entry{Reason::panel_zero, "panel_zero", "The operator's panel stops the feed."},
    Entry{Reason::panel_lower, "panel_lower",
          "The operator's panel is lower than the layer's wish."},
    Entry{Reason::clamped, "clamped", "Held at a limit of the envelope."},
    Entry{Reason::slew_limited, "slew_limited", "On the way; the slew limit holds it."},
    Entry{Reason::unknown_override_code, "unknown_override_code",
          "The panel's code is not in the machine's table; the panel's value stays."},
    Entry{Reason::heartbeat_lost, "heartbeat_lost",
          "The heartbeat was lost; the correction ramps out."},
    Entry{Reason::outvoted, "outvoted", "Another room asked for a lower value."},
    Entry{Reason::observe_only, "observe_only", "The mode does not permit writing."},
    Entry{Reason::port_cannot_write, "port_cannot_write",
          "The port has no way to write this override."},
    Entry{Reason::contour_limit, "contour_limit",
          "Slower, so that the contour error keeps its limit."},
    Entry{Reason::contour_within_limit, "contour_within_limit",
          "The largest step that keeps the contour limit."},
    Entry{Reason::contour_feed_floor, "contour_feed_floor",
          "Even the lowest permitted feed does not keep the contour limit."},
    Entry{Reason::contour_objective, "contour_objective",
          "The step with the best sum of contour error and time."},
    Entry{Reason::contour_hysteresis, "contour_hysteresis",
          "A better step exists, but not for long enough."},
    Entry{Reason::contour_no_effect, "contour_no_effect",
          "The override does not move the feed here."},
    Entry{Reason::contour_path_unknown, "contour_path_unknown",
          "The path ahead is not known; only the measured error counts."},
    Entry{Reason::chatter_modulating, "chatter_modulating",
          "The spindle's speed swings, so that chatter cannot grow."},
    Entry{Reason::chatter_feed_follows, "chatter_feed_follows",
          "Slower with the spindle, so that the feed per tooth keeps its band."},
    Entry{Reason::chatter_feed_raised, "chatter_feed_raised",
          "Faster with the spindle, so that the feed per tooth keeps its band."},
    Entry{Reason::chatter_fading, "chatter_fading",
          "The swing of the spindle's speed grows or fades out."},
    Entry{Reason::chatter_swing_narrowed, "chatter_swing_narrowed",
          "The limits leave less room than the swing needs: it is moved or narrowed."},
    Entry{Reason::chatter_drive_limit, "chatter_drive_limit",
          "The drive or the slew limit cannot follow the law."},
    Entry{Reason::chatter_feed_late, "chatter_feed_late",
          "The spindle waits until the feed is low enough for the feed per tooth."},
    Entry{Reason::chatter_detected, "chatter_detected", "The cut chatters."},
    Entry{Reason::chatter_better_speed, "chatter_better_speed",
          "To the spindle speed at which the planner's table permits more depth."},
    Entry{Reason::chatter_rule_speed, "chatter_rule_speed",
          "To the spindle speed at which whole waves of the chatter lie between two teeth."},
    Entry{Reason::chatter_no_better_speed, "chatter_no_better_speed",
          "The cut chatters and no permitted spindle speed is better."},
    Entry{Reason::thermal_correcting, "thermal_correcting",
          "The axes stand against the forecast displacement."},
    Entry{Reason::thermal_following, "thermal_following",
          "On the way to the forecast displacement; the slope limit holds the offset."},
    Entry{Reason::thermal_clamped, "thermal_clamped",
          "The forecast displacement passes the largest thermal offset."},
    Entry{Reason::thermal_held, "thermal_held",
          "Threading, tapping or probing: the offset must not move."},
    Entry{Reason::thermal_sensor_lost, "thermal_sensor_lost",
          "A temperature that the forecast needs is not known: the offset is held and fades "
          "once no tool is in the cut."},
    Entry{Reason::thermal_beyond_speed, "thermal_beyond_speed",
          "The spindle is faster than the thermal model knows: the offset is held."},
    Entry{Reason::thermal_sensor_wild, "thermal_sensor_wild",
          "A temperature that the forecast needs cannot be: the offset is held and fades once no "
          "tool is in the cut."},
    Entry{Reason::thermal_sensor_stuck, "thermal_sensor_stuck",
          "A temperature sensor that the forecast needs stands still while others move: the offset "
          "is held and fades once no tool is in the cut."},
    Entry{Reason::thermal_reading_taken, "thermal_reading_taken",
          "A reading has corrected the thermal model's state."},
    Entry{Reason::thermal_reading_outlier, "thermal_reading_outlier",
          "A reading too far from the forecast was not taken."},
    Entry{Reason::thermal_model_unfit, "thermal_model_unfit",
          "The readings no longer fit the thermal model: identify it anew."},
};

const Entry* find(Reason reason) noexcept {
  const auto* entry = std::ranges::find(kEntries, reason, &Entry::reason);
  return entry == kEntries.end() ? nullptr : entry;
}

}  // namespace

std::span<const ReasonEntry> reasons() noexcept {
  return kEntries;
}

std::string_view name(Reason reason) noexcept {
  const Entry* entry = find(reason);
  return entry == nullptr ? "unknown" : entry->name;
}

std::string_view sentence(Reason reason) noexcept {
  const Entry* entry = find(reason);
  return entry == nullptr ? "Unknown reason." : entry->sentence;
}

}  // namespace steadyrest::kernel::outcome
