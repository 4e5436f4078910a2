// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>

/// What `cut` reports, in everyday units: the report is a border.
namespace steadyrest::trial::cut {

/// The effect of a vibrating tool on surface and loads, over all the time in the cut.
struct VibrationFigures {
  double rms_um = 0.0;           ///< of the displacement about its mean, both axes together
  double peak_um = 0.0;          ///< largest displacement from rest
  double unforced_rms_um = 0.0;  ///< of what does not repeat from tooth to tooth: chatter
  double force_peak_n = 0.0;     ///< on the tool, in the plane
  double power_peak_w = 0.0;     ///< at the spindle
  double chip_peak_um = 0.0;
  /// The finished wall (in milling with one): mean place, > 0: too much is cut off …
  std::optional<double> surface_error_um;
  std::optional<double> surface_range_um;  ///< … and its highest minus lowest place
};

/// One stretch of the vibration's course.
struct VibrationPoint {
  double time_s = 0.0;
  double peak_um = 0.0;
  double unforced_um = 0.0;  ///< RMS
  double speed_rpm = 0.0;    ///< of the spindle, mean
};

/// Figures of one run over every control cycle. Errors count only in cutting motion (G1–G3): a
/// rapid leaves no surface.
struct Figures {
  double cycle_time_s = 0.0;
  double cutting_time_s = 0.0;
  double contour_error_max_mm = 0.0;  ///< magnitude
  double contour_error_rms_mm = 0.0;
  double tracking_error_max_mm = 0.0;
  double over_limit_s = 0.0;
  std::size_t samples = 0;  ///< in the cut
  std::size_t samples_over_limit = 0;
  std::size_t override_changes = 0;
};

/// One sample of the thinned trace; in order of time.
struct TracePoint {
  double time_s = 0.0;
  double path_mm = 0.0;  ///< commanded path length since the program's start
  kernel::signal::Point position_mm{};
  double contour_error_um = 0.0;   ///< signed
  double tracking_error_um = 0.0;  ///< distance from the commanded to the true point
  double override_percent = 100.0;
  double feed_mm_min = 0.0;
  std::uint32_t line = 0;
  bool cutting = false;  ///< G1–G3; only then does an error count
};

/// How long one reason determined the override.
struct ReasonTime {
  kernel::outcome::Reason reason = kernel::outcome::Reason::none;
  double seconds = 0.0;
};

/// How far the velocity and acceleration of one axis, estimated from its encoder, are from the
/// truth, alongside the backward difference of the same counts. Rotary axes: rad, not mm.
struct MotionFigures {
  std::string axis;
  double velocity_rms_mm_s = 0.0;
  double acceleration_rms_mm_s2 = 0.0;
  double difference_velocity_rms_mm_s = 0.0;
  double difference_acceleration_rms_mm_s2 = 0.0;
  double velocity_coverage_ratio = 1.0;  ///< share of cycles in which the bound held; NaN: no bound
  double acceleration_coverage_ratio = 1.0;
};

/// A probe reading, and what the thermal room made of it.
struct ProbeFigures {
  double time_s = 0.0;
  std::uint32_t line = 0;
  std::string axis;
  double displacement_um = 0.0;  ///< of the axis from its proper place
  double innovation_um = 0.0;    ///< the part that the forecast missed
  double band_um = 0.0;          ///< acceptance band
  kernel::outcome::Reason reason = kernel::outcome::Reason::none;
};

struct Run {
  Figures figures;
  std::vector<TracePoint> trace;
  std::vector<ReasonTime> reasons;
  // Designated initialisers may leave these out.
  // NOLINTBEGIN(readability-redundant-member-init)
  std::optional<VibrationFigures> vibration = {};  ///< if the cutting process was simulated
  std::vector<VibrationPoint> vibration_course = {};
  // NOLINTEND(readability-redundant-member-init)
};

/// Why a feed is expected to hold the limit on a line.
enum class HeldBy : std::uint8_t {
  closed_form,  ///< radius and servo, contour/offline/closed_form.hpp
  record,       ///< the recorded error, scaled with the square of the feed
  driven        ///< the line kept the limit at that feed
};

/// One line of the program with its largest error (signed) and the feed there; NaN where a run has
/// none.
struct WorstLine {
  std::uint32_t line = 0;
  std::string text;
  double without_um = 0.0;
  double with_um = 0.0;
  double feed_without_mm_min = std::numeric_limits<double>::quiet_NaN();
  double feed_with_mm_min = std::numeric_limits<double>::quiet_NaN();
  double radius_mm = std::numeric_limits<double>::quiet_NaN();         ///< NaN: straight
  double hold_feed_mm_min = std::numeric_limits<double>::quiet_NaN();  ///< NaN: any feed holds
  HeldBy held_by = HeldBy::driven;
};

struct OverrideStep {
  std::uint32_t code = 0;
  double percent = 100.0;
};

/// A way to cut the part.
enum class Way : std::uint8_t {
  alone,          ///< the program, or the original of a changed one, without the layer
  setting,        ///< the same on the machine with one setting of its control changed
  text,           ///< corrected in its text, in the same time
  text_held,      ///< … with lower feeds where that does not hold the limit
  text_feeds,     ///< lower feeds in its text alone
  feed_override,  ///< the program with the layer, which has the feed override alone
  path_offsets,   ///< the same with the layer, which has offsets of the axes too
  changed,        ///< the changed program without the layer …
  changed_feed_override,
  changed_path_offsets
};

struct WayFigures {
  Way way = Way::alone;
  Figures figures;
  // Designated initialisers may leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::string get = {};  ///< the command or the setting that gives it; empty: nothing to do
};

/// The best of the ways, and what is left of it.
struct BestWays {
  std::optional<WayFigures> same_time;  ///< in the program's own time; empty: as programmed
  std::optional<WayFigures> any_time;   ///< where more time holds the limit better
  std::optional<WayFigures> setting;    ///< the cheapest cure
};

/// A line that stays over the limit in the best way, and what would cure it.
struct OverLimitLine {
  std::uint32_t line = 0;
  double error_um = 0.0;
  std::string reason;
  std::string cure;  ///< with its price; empty: none was found
};

/// The feed override alone, told to keep another limit. Samples over the limit are those over the
/// report's limit.
struct CurvePoint {
  double limit_um = 10.0;
  Figures figures;
};

/// Everything in the report except its provenance (provenance.hpp).
struct ReportData {
  std::string program;
  std::string machine;
  std::string strategy;  ///< as plain text
  double limit_um = 10.0;
  std::vector<OverrideStep> override_table;
  Run without;
  Run with;
  std::vector<WorstLine> worst_lines;  ///< the worst with and without the layer
  std::vector<MotionFigures> motion;   ///< of the run with the layer; only axes with counts
  std::vector<ProbeFigures> probes;    ///< of the run with the layer
  std::string against;                 ///< the original of a changed program; empty: none
  std::vector<WayFigures> ways;        ///< empty: not compared
  std::vector<CurvePoint> curve;       ///< by rising limit; empty: not asked for
  BestWays best;
  Run best_run;                           ///< in the program's own time; no trace: as programmed
  std::vector<OverLimitLine> over_limit;  ///< of that run, the worst first
};

}  // namespace steadyrest::trial::cut
