// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

/// The planned path of a program: geometry for everyone, and what else the interpolator needs.
namespace steadyrest::nc::plan {

/// A program that takes longer has a feed or a dwell in the wrong unit.
inline constexpr double kLongestProgram_s = 30.0 * 24.0 * 3600.0;

/// What the speed plan needs of one segment, in one cache line; parallel to the PathSegments.
struct SegmentPlan {
  double length_mm = 0.0;
  double acceleration_mm_s2 = 0.0;  ///< tangential, what remains after the centripetal share
  double feed_mm_s = 0.0;           ///< at 100 %; per_revolution: mm/rev
  double speed_limit_mm_s = std::numeric_limits<double>::infinity();
  double exit_speed_limit_mm_s = 0.0;
  double spindle_rev_s = 0.0;   ///< commanded from here on by G96; 0 = by the last event
  bool rapid = false;           ///< the rapid override applies
  bool locked = false;          ///< no override applies
  bool per_revolution = false;  ///< feed follows the actual spindle speed
  bool from_start = false;      ///< marked by plan_file_from_start()
};

enum class PathEventKind : std::uint8_t {
  dwell,         ///< value = seconds
  tool_change,   ///< value = tool number
  spindle,       ///< value = rev/s, signed
  spindle_wait,  ///< until the spindle has reached its speed
  coolant,
  stop,  ///< M0, M1: continues at once, the operator is not simulated
  end
};

/// Something that happens at standstill before the segment `segment` starts.
struct PathEvent {
  PathEventKind kind = PathEventKind::dwell;
  std::size_t segment = 0;
  std::uint32_t line = 0;
  double value = 0.0;
};

/// A tolerance of the control's continuous mode up to here (G64 P0.5) is there for speed: the part
/// is judged by the corners that the program writes. A larger one is a path of its own.
inline constexpr double kSmallRounding_mm = 0.5;

/// A whole program in memory. segments[i] and plans[i] belong together; events ascend by segment.
struct PlannedPath {
  std::vector<kernel::signal::PathSegment> segments;
  std::vector<SegmentPlan> plans;
  std::vector<PathEvent> events;
  std::vector<std::string> subprograms;  ///< files that it calls
  bool tolerant = false;                 ///< the program gives a tolerance for corners and chords
  /// What the part is judged by where `tolerant`, by plan_programmed(); null: the path itself.
  std::shared_ptr<const PlannedPath> programmed;
  /// The path before the text was corrected, by rewrite::hold_against_original(); null: the same.
  std::shared_ptr<const PlannedPath> original;
  std::string original_unknown;  ///< why it is not known; empty: it is
  bool heat_in_text = false;     ///< the text corrects the drift by heat
};

/// What an interpolator reads: a whole program, or a window that moves along it. Element i is at
/// index i & mask, so a ring of a power of two works as well as a whole array.
struct PathWindow {
  const kernel::signal::PathSegment* segments = nullptr;
  const SegmentPlan* plans = nullptr;
  const PathEvent* events = nullptr;
  std::size_t mask = ~std::size_t{0};
  std::size_t event_mask = ~std::size_t{0};
  std::size_t end = 0;        ///< one past the last segment known
  std::size_t event_end = 0;  ///< one past the last event known
  bool complete = true;       ///< nothing follows `end`

  [[nodiscard]] const kernel::signal::PathSegment& segment(std::size_t i) const noexcept {
    return segments[i & mask];
  }
  [[nodiscard]] const SegmentPlan& plan(std::size_t i) const noexcept { return plans[i & mask]; }
};

[[nodiscard]] inline PathWindow whole(const PlannedPath& path) noexcept {
  PathWindow w;
  w.segments = path.segments.data();
  w.plans = path.plans.data();
  w.events = path.events.data();
  w.end = path.segments.size();
  w.event_end = path.events.size();
  return w;
}

}  // namespace steadyrest::nc::plan
