// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::nc::plan {

inline constexpr double kShortest_mm = 1e-9;  ///< nothing shorter is a move

/// One move as a segment of the path, before its neighbours are known.
struct Piece {
  kernel::signal::PathSegment segment;
  SegmentPlan plan;
  interpret::PathMode mode = interpret::PathMode::continuous;
  double tolerance_mm = 0.0;
  double program_tolerance_mm = 0.0;
  double merge_tolerance_mm = 0.0;
  double kink = 0.0;          ///< share of the acceleration that the kinks at its ends take
  bool beside_blend = false;  ///< next to a corner that could not be rounded, or before a stop
  bool in_arc = false;        ///< what is left of the line belongs to the corner arc after it
  bool in_spline = false;     ///< a chord of a spline, which is one block
  double ramp_share = 1.0;    ///< already applied to the acceleration
  double nominal_mm = 0.0;    ///< length before its corners were rounded
  kernel::signal::AxisValues start_direction{};
  kernel::signal::AxisValues end_direction{};
};

[[nodiscard]] inline kernel::signal::Point xyz_of(const kernel::signal::AxisValues& v) {
  return {v[0], v[1], v[2]};
}

[[nodiscard]] inline bool others_move(const kernel::signal::PathSegment& s) {
  return s.other_start != s.other_end;
}

/// The arc of a move through the segment's start and end, which must be set.
void set_arc(kernel::signal::PathSegment& segment, const interpret::Move& move);

/// What becomes of an arc's speed when there is less acceleration.
enum class Turn : std::uint8_t {
  slower,
  as_before  ///< LinuxCNC settles a piece when the next one is known; the last keeps its speed
};

/// Moves → pieces: machine coordinates, geometry and length, feed, the limits of machine and
/// control.
class PieceMaker {
 public:
  /// `machine` must outlive it.
  explicit PieceMaker(const kernel::machine::Machine& machine);

  /// Makes `out` of the move; false for a move of no length. Refused: a coordinate that is not
  /// finite, a feed move without a feed, a feed per revolution without a spindle, axes without
  /// limits.
  [[nodiscard]] kernel::outcome::Result<bool> make(const interpret::Move& move, Piece& out) const;
  /// Updates the limits and a line's direction after a change of the segment.
  void limit(Piece& out) const;
  /// The same with given limits.
  void limit(Piece& out, const SpeedLimits& limits) const;
  /// How long the axes take to come near an exact stop after it (Control::exact_stop_mm).
  [[nodiscard]] double settle_s(const Piece& piece) const;
  /// The acceleration of a piece that turns nowhere.
  [[nodiscard]] double ramp_mm_s2(const Piece& piece) const;
  /// Applies what its kinks and blends leave of the acceleration: an arc turns more slowly too.
  void slow_ramps(Piece& out, Turn turn = Turn::slower) const;
  /// LinuxCNC: what is left between its corners takes a block's time too.
  void limit_rest(Piece& out) const;
  /// The control's law for an F that the axes cannot reach (Control::clips_programmed_feed); its
  /// own limit along the path does not count. Of a finished piece: pieces of one F merge.
  void clip_feed(Piece& out) const;
  /// An arc between two pieces has the larger of their feeds (LinuxCNC 2.9, measured).
  void clip_corner_feed(Piece& arc, const Piece& before, const Piece& after) const;
  [[nodiscard]] const PathLimits& limits() const noexcept { return limits_; }

 private:
  [[nodiscard]] bool clips(const Piece& piece) const;
  [[nodiscard]] double clipped_feed(const Piece& piece) const;
  [[nodiscard]] double fastest_arc(const kernel::signal::PathSegment& s) const;
  [[nodiscard]] kernel::signal::AxisValues machine_position(const interpret::Move& move,
                                                            const interpret::Axes& work) const;
  [[nodiscard]] double spindle_of(const kernel::signal::PathSegment& s,
                                  const interpret::Move& move) const;
  void set_speed(Piece& out, const interpret::Move& move) const;

  const kernel::machine::Machine& machine_;
  PathLimits limits_;
  bool others_ = false;                   ///< the machine has axes beyond X Y Z
  std::array<std::size_t, 9> axis_of_{};  ///< index of the machine's axis for X Y Z A B C U V W
  std::array<bool, kernel::signal::kMaxAxes> rotary_{};
};

}  // namespace steadyrest::nc::plan
