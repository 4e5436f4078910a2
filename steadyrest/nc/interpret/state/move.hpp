// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

/// What a program makes a machine do, independent of dialect: the boundary between the interpreter
/// and everything above it.
namespace steadyrest::nc::interpret {

enum class MoveKind : std::uint8_t { rapid, linear, arc, spline, probe, thread, dwell };

enum class FeedMode : std::uint8_t { per_minute, inverse_time, per_revolution };

/// How the control passes the end point of a move.
enum class PathMode : std::uint8_t {
  exact_path,  ///< G61: on the path, stops only where it must
  exact_stop,  ///< G61.1, G9, G60: stops at every end point
  continuous   ///< G64: may round the corner within the tolerance
};

/// Axes in the order X Y Z A B C U V W; mm for linear, degrees for rotary (border units: rs274
/// prints them so).
using Axes = std::array<double, 9>;

/// A control point of a spline in the XY plane, work coordinates.
struct SplinePoint {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double weight = 1.0;
};

/// One motion or dwell. Positions are in the active work coordinates; see machine_of().
struct Move {
  MoveKind kind = MoveKind::rapid;
  std::uint32_t line = 0;  ///< 1-based line in the file
  Axes start{};
  Axes end{};
  Axes offset{};  ///< work offsets, G92/G52, tool length; machine = work + offset without rotation
  double rotation_deg = 0.0;  ///< of the work coordinates about Z, from machine to work
  unsigned machine_axes = 0;  ///< bit i: the program gave the end of axis i in machine coordinates
                              ///< (G53, SUPA)
  double feed_mm_s = 0.0;  ///< path feed; degrees/s where only rotary axes move. For inverse_time:
                           ///< moves/s; for per_revolution: mm/rev; 0 for rapids and dwells
  FeedMode feed_mode = FeedMode::per_minute;
  // arcs
  std::array<double, 3> centre_mm{};  ///< work coordinates, at the height of the start point
  std::array<double, 3> normal{};  ///< unit normal of the plane: +Z for G17, +Y for G18, +X for G19
  int turns = 0;  ///< > 0 counter-clockwise seen against `normal`, < 0 clockwise; |turns| = full
                  ///< turns begun
  // splines: the control points of a rational B-spline of order `spline_order` (degree + 1) over
  // the clamped uniform knots; valid during the call only
  std::span<const SplinePoint> spline;
  int spline_order = 0;
  // modal state needed for timing and simulation
  PathMode path_mode = PathMode::continuous;
  double path_tolerance_mm = 0.0;    ///< G64 P; 0 = none given
  double merge_tolerance_mm = -1.0;  ///< G64 Q, for lines in a row; < 0 = P
  double spindle_rev_s = 0.0;        ///< signed: > 0 clockwise (M3); 0 under G96
  double surface_speed_mm_s = 0.0;   ///< G96: cutting speed, signed as above; 0 = G97
  double spindle_limit_rev_s = 0.0;  ///< G96: the spindle's upper limit; 0 = none given
  bool override_locked = false;      ///< thread, tap, M49: the feed override has no effect
  double dwell_s = 0.0;
  bool speed_modulation = false;  ///< the spindle's speed is to be modulated (M38)
  bool in_spline = false;         ///< one of the lines that a spline is planned as
  bool after_rest = false;        ///< the control lets the axes come to rest before it
  bool from_start = false;        ///< its place follows from where the axes stood at the start
  bool opaque = false;  ///< its place or its modes follow from a block that is not understood
};

/// What the program permits lines that become one.
[[nodiscard]] inline double merge_tolerance_mm(const Move& move) noexcept {
  return move.merge_tolerance_mm < 0.0 ? move.path_tolerance_mm : move.merge_tolerance_mm;
}

/// Machine coordinates of a point of the move: turned about Z by `rotation_deg`, then shifted.
[[nodiscard]] Axes machine_of(const Move& move, const Axes& work) noexcept;

enum class EventKind : std::uint8_t {
  spindle,      ///< value = rev/s, signed; 0 = stop
  coolant,      ///< value = 0 off, 1 mist, 2 flood, 3 both
  tool_change,  ///< value = tool number
  stop,         ///< M0, M1 (value = 1 for M1)
  end           ///< M2, M30, closing %
};

struct Event {
  EventKind kind = EventKind::spindle;
  std::uint32_t line = 0;
  double value = 0.0;
  // Lets designated initialisers leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::string_view tool_name{};  ///< tool_change by name (T="DRILL"); valid during the call only
};

/// Receives a program's moves and events in order. Implementations must not keep references.
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;
  virtual void on_move(const Move& move) = 0;
  virtual void on_event(const Event& event) = 0;
};

/// For whoever wants only the report of a run.
class NoMoves final : public Sink {
 public:
  void on_move(const Move& /*move*/) override {}
  void on_event(const Event& /*event*/) override {}
};

}  // namespace steadyrest::nc::interpret
