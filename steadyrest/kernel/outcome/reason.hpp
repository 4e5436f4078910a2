// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace steadyrest::kernel::outcome {

/// Why a room made its request, or why it withdrew.
///
/// The numbers are stable: logs, reports and the page use them. 0–99 common, 100–199 envelope and
/// arbiter, 200–299 motion, 300–399 contour, 400–499 chatter, 500–599 thermal. The one table in
/// `reason.cpp` gives their names and texts.
enum class Reason : std::uint16_t {
  none = 0,                     ///< neutral: nothing to correct
  input_not_finite = 1,         ///< an input was NaN or infinite
  input_out_of_range = 2,       ///< an input was outside the machine file's limits
  input_stale = 3,              ///< the sample is older than the staleness limit
  not_cutting = 4,              ///< rapid, dwell, tool change, idle: nothing to correct
  withdrawn_thread = 5,         ///< thread cutting or tapping: the override must not move
  panel_zero = 100,             ///< the operator's panel is at 0 %
  panel_lower = 101,            ///< the operator's panel is below what the layer asks for
  clamped = 102,                ///< held at a limit of the envelope
  slew_limited = 103,           ///< on the way at the slew limit
  unknown_override_code = 104,  ///< the panel's code is not in the machine's table
  heartbeat_lost = 105,         ///< the layer or the control stopped answering
  outvoted = 106,               ///< another room asked for a lower value
  observe_only = 107,           ///< the mode does not permit writing
  port_cannot_write = 108,      ///< the port has no way to write this override
  contour_limit = 300,          ///< feed reduced: the contour error would pass its limit
  contour_within_limit = 301,   ///< the largest step that keeps the limit is in force
  contour_feed_floor = 302,     ///< the lowest permitted feed does not keep the limit
  contour_objective = 303,      ///< the step that minimises the combined objective
  contour_hysteresis = 304,     ///< a step is better, but not by enough or not yet for long enough
  contour_no_effect = 305,     ///< the override does not move the feed here; the estimate is frozen
  contour_path_unknown = 306,  ///< no path window: only the error that already happened is known
  contour_in_text = 307,       ///< the program's text corrects the path: the feed stays its own
  contour_original_unknown = 308,  ///< likewise, and from which path is not known: no error either
  contour_cancelled = 320,         ///< offsets keep the tool on the path at full feed
  contour_cancel_begins = 321,     ///< the offsets grow from 0 to their full size
  contour_offset_too_slow = 322,   ///< the control moves them too slowly to help here: they go to 0
  chatter_modulating = 400,        ///< the spindle's speed swings by its law
  chatter_feed_follows = 401,      ///< feed reduced: the feed per tooth would pass its band
  chatter_feed_raised = 402,       ///< feed raised: the feed per tooth would fall below its band
  chatter_fading = 403,            ///< the swing grows or shrinks
  chatter_swing_narrowed = 404,    ///< the limits leave less room than the swing needs
  chatter_drive_limit = 405,       ///< the drive cannot follow the law
  chatter_feed_late = 406,         ///< the spindle waits until the feed is slow enough
  chatter_detected = 420,          ///< the detector hears chatter
  chatter_better_speed = 421,      ///< the planner's table has a speed that reaches deeper
  chatter_rule_speed = 422,        ///< the classical rule's speed: whole waves between two teeth
  chatter_no_better_speed = 423,   ///< no permitted speed is better: less depth, or modulation
  thermal_correcting = 500,        ///< the offset counters the forecast displacement
  thermal_following = 501,         ///< on the way at the slope limit
  thermal_clamped = 502,           ///< the forecast exceeds the largest offset
  thermal_held = 503,              ///< threading, tapping or probing: the offset must not move
  thermal_sensor_lost = 504,       ///< a temperature that the forecast needs is not known
  thermal_beyond_speed = 505,      ///< the spindle is faster than any fitted speed
  thermal_sensor_wild = 506,       ///< a temperature reading is implausible or jumped
  thermal_sensor_stuck = 507,      ///< a sensor's reading is frozen while others move
  thermal_in_text = 508,           ///< the program's text corrects the drift: the offset is held
  thermal_reading_taken = 520,     ///< a reading has corrected the model's state
  thermal_reading_outlier = 521,   ///< a reading beyond the gate: not taken
  thermal_model_unfit = 522,       ///< the readings no longer fit the model
};

/// One line of the table.
struct ReasonEntry {
  Reason reason;
  std::string_view name;
  std::string_view sentence;
};

/// The whole table in ascending order; `docs/reasons.md` is written from it.
[[nodiscard]] std::span<const ReasonEntry> reasons() noexcept;

/// `contour_limit` for Reason::contour_limit; `unknown` for a number that has no entry.
[[nodiscard]] std::string_view name(Reason reason) noexcept;

/// One English sentence for people.
[[nodiscard]] std::string_view sentence(Reason reason) noexcept;

}  // namespace steadyrest::kernel::outcome
