// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::online {

/// A short piece of the path ahead: p(s₀ + δ) = point + δ·tangent + ½δ²·curvature, 0 ≤ δ ≤ length.
struct Cell {
  kernel::signal::Point point_mm{};
  kernel::signal::Point tangent{};
  kernel::signal::Point curvature_1_mm{};
  double position_mm = 0.0;
  double length_mm = 0.0;
  double square_mm2_s2 = 0.0;  ///< largest v² at its start from which all later limits can be kept
  /// The same of the point that the tool is kept on (tool_point.hpp): it slows for corners only.
  double tool_square_mm2_s2 = 0.0;
  double cap_mm_s = 0.0;            ///< the control's limit inside
  double feed_mm_s = 0.0;           ///< at 100 %
  double acceleration_mm_s2 = 0.0;  ///< along the path
  bool corner = false;              ///< the direction breaks at its start
  bool cutting = false;             ///< Motion::feed: the feed override acts, the contour counts
  bool rapid = false;               ///< the rapid override acts
  bool by_text = false;             ///< the text corrects the path: its error is not judged here
};

/// The path around the commanded point as cells, made once and kept in a ring while the command
/// moves along it.
///
/// Lines are one cell; arcs are divided so that the third-order term stays below 2·10⁻⁵ mm; runs of
/// short CAM lines are joined to chords that turn by at most 0.02 rad. A backward pass sets the
/// speed limits as the control's look-ahead does:
///   square_i = min(cap_i², limit at the joint², square_{i+1} + 2·a_i·length_i).
/// A second pass does the same for the tool point with the joints' limits alone: `tool_turn_mm_s`
/// over the change of direction.
/// The path beyond the last cell is unknown and does not limit. Work per cycle is bounded by
/// `kCellsPerCycle`; the ring's memory is allocated once.
class LookAhead {
 public:
  static constexpr std::size_t kCells = 2048;
  static constexpr int kCellsPerCycle = 48;
  static constexpr int kSegmentsPerCycle = 256;

  struct State {
    std::vector<Cell> cell;  ///< those from `first` to `last`
    std::size_t first = 0;
    std::size_t last = 0;
    const kernel::signal::PathSegment* path = nullptr;  ///< compared, never read
    std::size_t next_segment = 0;                       ///< where the next cell begins
    double next_offset_mm = 0.0;
    double joint_mm_s = 0.0;  ///< speed limit at the next cell's start
    double made_to_mm = 0.0;
    bool complete = false;
  };

  /// What the control plans with: the axes, and its own limit along the path. `tool_turn_mm_s`:
  /// largest change of the tool point's velocity at a joint of a cut.
  LookAhead(std::span<const kernel::machine::Axis> axes, double max_path_acceleration_mm_s2,
            double tool_turn_mm_s = std::numeric_limits<double>::infinity());
  ~LookAhead();
  LookAhead(LookAhead&&) noexcept;
  LookAhead& operator=(LookAhead&&) noexcept;
  LookAhead(const LookAhead&) = delete;
  LookAhead& operator=(const LookAhead&) = delete;

  /// Forgets everything; the next update starts from scratch.
  void reset() noexcept;
  /// Keeps the cells from `from_mm` on and adds cells up to `to_mm`, within one cycle's work.
  /// `index` is the segment of the commanded point, which is at `command_mm`. The path's storage
  /// must stay where it is: another address counts as another path, and all cells are rebuilt.
  void update(kernel::signal::PathView path, std::size_t index, double from_mm, double command_mm,
              double to_mm) noexcept;

  [[nodiscard]] std::size_t begin() const noexcept { return first_; }
  [[nodiscard]] std::size_t end() const noexcept { return last_; }
  [[nodiscard]] bool empty() const noexcept { return first_ == last_; }
  [[nodiscard]] const Cell& cell(std::size_t i) const noexcept { return (*ring_)[i % kCells]; }
  /// The cell that contains s, searched forward from `hint` (backward if it lies before).
  [[nodiscard]] std::size_t find(double s_mm, std::size_t hint) const noexcept;
  /// Path length up to which cells are known.
  [[nodiscard]] double known_to_mm() const noexcept;
  /// The path ends within the known cells.
  [[nodiscard]] bool complete() const noexcept { return complete_; }

  [[nodiscard]] State state() const;
  /// More cells than the ring holds start over.
  void restore(const State& state) noexcept;

  /// Adds one cell by hand (for extrapolated paths).
  void append(Cell cell, double joint_limit_mm_s) noexcept;

 private:
  [[nodiscard]] Cell& at(std::size_t i) noexcept;
  /// `segments`: how many this cycle may still read. False at the path's end.
  bool add_next(kernel::signal::PathView path, int& segments) noexcept;
  void append_stop() noexcept;
  void take_from_arc(const kernel::signal::PathSegment& segment, Cell& cell) noexcept;
  void take_lines(kernel::signal::PathView path, Cell& cell, int& segments) noexcept;
  [[nodiscard]] double tool_limit_mm_s(const Cell& next) const noexcept;
  void lower_before(double Cell::* square) noexcept;
  [[nodiscard]] double line_acceleration(const kernel::signal::Point& direction) const noexcept;
  [[nodiscard]] double arc_acceleration(const kernel::signal::PathSegment& segment) const noexcept;
  void describe(Cell& cell, const kernel::signal::PathSegment& segment) const noexcept;

  std::array<double, 3> axis_mm_s2_{};
  double path_mm_s2_ = 0.0;
  double tool_turn_mm_s_ = 0.0;
  std::unique_ptr<std::array<Cell, kCells>> ring_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  const kernel::signal::PathSegment* path_data_ = nullptr;
  std::size_t next_segment_ = 0;  ///< where the next cell begins
  double next_offset_mm_ = 0.0;
  double joint_mm_s_ = 0.0;  ///< speed limit at the next cell's start
  double made_to_mm_ = 0.0;
  bool complete_ = false;
};

}  // namespace steadyrest::contour::online
