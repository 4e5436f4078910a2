// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/kernel/outcome/reason.hpp>

// The one table behind code, logs, docs/reasons.md and the page. Numbers are stable, in ranges by
// room (reason.hpp) and in ascending rows; a test compares the table with the enumerators and
// writes the page.
namespace steadyrest::kernel::outcome {
namespace {

using Entry = ReasonEntry;

constexpr std::array kEntries = {
    Entry{Reason::none, "none", "Nothing to correct."},
    Entry{Reason::input_not_finite, "input_not_finite", "An input was not a finite number."},
    Entry{Reason::input_out_of_range, "input_out_of_range",
          "An input was outside the machine's range."},
    Entry{Reason::input_stale, "input_stale", "The input is too old to act on."},
    Entry{Reason::not_cutting, "not_cutting", "The machine is not cutting."},
    Entry{Reason::withdrawn_thread, "withdrawn_thread",
          "Threading or tapping: the override must not move."},
    Entry{Reason::panel_zero, "panel_zero", "The feed override on the panel is at 0 %."},
    Entry{Reason::panel_lower, "panel_lower",
          "The operator's panel is set lower than the layer asks."},
    Entry{Reason::clamped, "clamped", "Held at a limit of the envelope."},
    Entry{Reason::slew_limited, "slew_limited", "Moving to its target at the slew limit."},
    Entry{Reason::unknown_override_code, "unknown_override_code",
          "The panel's code is not in the override table; the panel keeps control."},
    Entry{Reason::heartbeat_lost, "heartbeat_lost", "Heartbeat lost; the correction ramps out."},
    Entry{Reason::outvoted, "outvoted", "Another room asked for a lower value."},
    Entry{Reason::observe_only, "observe_only", "This mode does not write."},
    Entry{Reason::port_cannot_write, "port_cannot_write",
          "This port is unable to write that override."},
    Entry{Reason::contour_limit, "contour_limit", "Feed reduced to hold the contour limit."},
    Entry{Reason::contour_within_limit, "contour_within_limit",
          "Highest feed step that holds the contour limit."},
    Entry{Reason::contour_feed_floor, "contour_feed_floor",
          "Even the lowest permitted feed exceeds the contour limit."},
    Entry{Reason::contour_objective, "contour_objective",
          "Feed step with the best balance of contour error and time."},
    Entry{Reason::contour_hysteresis, "contour_hysteresis",
          "A better feed step exists, but not for long enough."},
    Entry{Reason::contour_no_effect, "contour_no_effect",
          "The override has no effect on the feed here."},
    Entry{Reason::contour_path_unknown, "contour_path_unknown",
          "The path ahead is unknown; only the measured error counts."},
    Entry{Reason::contour_in_text, "contour_in_text",
          "The program's text corrects the path here: feed and offsets stay as programmed."},
    Entry{Reason::contour_original_unknown, "contour_original_unknown",
          "The program's text corrects the path, but its original is unknown: no contour "
          "correction."},
    Entry{Reason::contour_cancelled, "contour_cancelled",
          "Axis offsets keep the tool on the path at full feed."},
    Entry{Reason::contour_cancel_begins, "contour_cancel_begins",
          "The axis offsets against the contour error are ramping in."},
    Entry{Reason::contour_offset_too_slow, "contour_offset_too_slow",
          "The control moves its offsets too slowly to help on this part of the path."},
    Entry{Reason::chatter_modulating, "chatter_modulating",
          "Spindle speed modulated to keep chatter from growing."},
    Entry{Reason::chatter_feed_follows, "chatter_feed_follows",
          "Feed follows the slower spindle to hold the feed per tooth."},
    Entry{Reason::chatter_feed_raised, "chatter_feed_raised",
          "Feed follows the faster spindle to hold the feed per tooth."},
    Entry{Reason::chatter_fading, "chatter_fading", "The speed modulation is ramping in or out."},
    Entry{Reason::chatter_swing_narrowed, "chatter_swing_narrowed",
          "The limits are too tight for the full modulation: it is shifted or narrowed."},
    Entry{Reason::chatter_drive_limit, "chatter_drive_limit",
          "The modulation is too fast for the drive."},
    Entry{Reason::chatter_feed_late, "chatter_feed_late",
          "The spindle waits for the feed to come down, to hold the feed per tooth."},
    Entry{Reason::chatter_detected, "chatter_detected", "The cut chatters."},
    Entry{Reason::chatter_better_speed, "chatter_better_speed",
          "Chatter: moving to a speed with a deeper limit in the planner's table."},
    Entry{Reason::chatter_rule_speed, "chatter_rule_speed",
          "Chatter: moving to a speed with a whole number of chatter waves between teeth."},
    Entry{Reason::chatter_no_better_speed, "chatter_no_better_speed",
          "The cut chatters and no permitted spindle speed is better."},
    Entry{Reason::thermal_correcting, "thermal_correcting",
          "The axis offsets cancel the forecast drift."},
    Entry{Reason::thermal_following, "thermal_following",
          "The offset is catching up with the forecast drift at the slope limit."},
    Entry{Reason::thermal_clamped, "thermal_clamped",
          "The forecast drift exceeds the largest thermal offset."},
    Entry{Reason::thermal_held, "thermal_held",
          "Threading, tapping or probing: the offset is held."},
    Entry{Reason::thermal_sensor_lost, "thermal_sensor_lost",
          "A temperature reading is missing: the offset is held, then fades once the tool is out "
          "of the cut."},
    Entry{Reason::thermal_beyond_speed, "thermal_beyond_speed",
          "The spindle is faster than any speed the thermal model was fitted to: the offset is "
          "held."},
    Entry{Reason::thermal_sensor_wild, "thermal_sensor_wild",
          "A temperature reading is implausible: the offset is held, then fades once the tool is "
          "out of the cut."},
    Entry{Reason::thermal_sensor_stuck, "thermal_sensor_stuck",
          "A temperature reading is stuck while others change: the offset is held, then fades once "
          "the tool is out of the cut."},
    Entry{Reason::thermal_in_text, "thermal_in_text",
          "The program's text corrects the thermal drift: the layer adds no thermal offset."},
    Entry{Reason::thermal_reading_taken, "thermal_reading_taken",
          "A probe reading re-zeroed the thermal model."},
    Entry{Reason::thermal_reading_outlier, "thermal_reading_outlier",
          "A probe reading too far from the forecast was rejected."},
    Entry{Reason::thermal_model_unfit, "thermal_model_unfit",
          "The readings no longer fit the thermal model: fit it again."},
};

// Linear: fewer than a hundred rows, and only people read the sentences.
const Entry* find(Reason reason) noexcept {
  const auto* entry = std::ranges::find(kEntries, reason, &Entry::reason);
  return entry == kEntries.end() ? nullptr : entry;
}

}  // namespace

// For lists of all reasons: the generated page, the summary of a run.
std::span<const ReasonEntry> reasons() noexcept {
  return kEntries;
}

// A number from a newer record may have no row here.
std::string_view name(Reason reason) noexcept {
  const Entry* entry = find(reason);
  return entry == nullptr ? "unknown" : entry->name;
}

// What the operator reads; a full sentence, so that it can be shown alone.
std::string_view sentence(Reason reason) noexcept {
  const Entry* entry = find(reason);
  return entry == nullptr ? "Unknown reason." : entry->sentence;
}

}  // namespace steadyrest::kernel::outcome
