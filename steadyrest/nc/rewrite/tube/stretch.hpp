// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/math/geometry/tube_walk.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::rewrite {

/// Machine coordinates of a point of a move.
[[nodiscard]] kernel::signal::Point machine_point(const interpret::Move& move,
                                                  const interpret::Axes& work) noexcept;

/// A stretch of replaced blocks, from one place where both programs are together to the next, and
/// the proof that the new moves stay within a tube of the original's, in order, with nothing left
/// out (tube_walk.hpp).
///
/// Moves of a block belong to its place: to the block itself and a reach of path length before and
/// after, reach = 4·tube + 0.1 s·feed. So no block lends its feed to another far away.
///
/// Arcs become chords with a slack, first 1/64 of the tube, at most 1 µm; near a place where that
/// proves nothing, 1/16 of it and again 1/16. So a path outside by 1 µm is refused, and one inside
/// by a few hundredths of a µm is proved.
class Stretch {
 public:
  explicit Stretch(double tube_mm) : tube_mm_(tube_mm) {}

  /// Why the stretch is not within the tube.
  struct Fault {
    bool of_original = false;  ///< `line` is the original's: it is left out
    std::uint32_t line = 0;
    std::string what;
  };

  /// Both programs are at these points now.
  void begin(const kernel::signal::Point& original_mm, const kernel::signal::Point& changed_mm);
  /// The original's move, in machine coordinates; its new moves follow.
  void block(const interpret::Move& move);
  void fresh(const interpret::Move& move);
  [[nodiscard]] bool open() const noexcept { return open_; }
  /// Both programs are together again: proves what was added since begin().
  [[nodiscard]] std::optional<Fault> close();

  /// Over all stretches: where a new move is farthest from the original; to the slack.
  [[nodiscard]] double farthest_mm() const noexcept { return farthest_mm_; }
  [[nodiscard]] std::uint32_t farthest_line() const noexcept { return farthest_line_; }

 private:
  /// A line or an arc that goes on from the one before.
  struct Piece {
    kernel::signal::Point end_mm{};
    std::uint32_t line = 0;
    std::uint32_t block = 0;  ///< the original's block that it replaces
    std::uint32_t arc = 0;    ///< its number from 1; 0: a line
    std::uint8_t finer = 0;   ///< how often the slack of its chords was made smaller
  };
  struct Path {
    kernel::signal::Point start_mm{};
    std::vector<Piece> pieces;
    std::vector<kernel::signal::PathSegment> arcs;

    void clear(const kernel::signal::Point& start);
    void add(const interpret::Move& move, std::uint32_t block);
    void add_line(const kernel::signal::Point& end, std::uint32_t line, std::uint32_t block);
    /// Makes the slack smaller about a piece; false when it is as small as it gets.
    bool refine(std::size_t piece, std::size_t around);
    [[nodiscard]] kernel::signal::Point end() const noexcept {
      return pieces.empty() ? start_mm : pieces.back().end_mm;
    }
  };
  /// Chords, and the piece of each.
  struct Chords {
    math::geometry::ChordPath path;
    std::vector<std::uint32_t> piece;
  };

  [[nodiscard]] static Chords chords_of(const Path& path, double slack_mm);
  [[nodiscard]] std::vector<math::geometry::ChordRange> permitted(const Chords& original,
                                                                  const Chords& changed) const;
  [[nodiscard]] bool same() const noexcept;
  [[nodiscard]] Fault fault(const Chords& original, const Chords& changed,
                            const math::geometry::TubeVerdict& verdict) const;

  double tube_mm_;
  bool open_ = false;
  Path original_;
  Path changed_;
  std::vector<double> feed_mm_s_;  ///< by block
  double farthest_mm_ = 0.0;
  std::uint32_t farthest_line_ = 0;
};

}  // namespace steadyrest::nc::rewrite
