// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::math::geometry {

/// A curve as chords. Traversed in step with its chord, no point of the curve is farther from it
/// than the chord's slack.
struct ChordPath {
  std::vector<kernel::signal::Point> points;  ///< one more than chords
  std::vector<double> slack_mm;               ///< by chord; 0 on a line
  [[nodiscard]] std::size_t size() const noexcept { return slack_mm.size(); }

  /// Appends a line or an arc that starts at the last point: an arc as equal chords with a slack of
  /// at most `slack_mm`, 0 < `slack_mm`.
  void add(const kernel::signal::PathSegment& segment, double slack_mm);
};

/// Chords of the original, both included.
struct ChordRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

struct TubeVerdict {
  bool inside = false;
  /// If inside: the largest distance of an end of a chord, of either path, from where the other
  /// path may be at that moment; to the slack.
  double farthest_mm = 0.0;
  std::size_t farthest_changed = 0;  ///< chord
  // If not inside: how far one comes.
  std::size_t changed = 0;   ///< chord that cannot be passed
  std::size_t original = 0;  ///< last chord reached
};

/// Whether two curves can be traversed together, from start to end and never backwards, without
/// being farther apart than the tube: their Fréchet distance is at most the tube. So every point of
/// either lies within the tube of the other, in the same order, and nothing is left out.
///
/// Law (Alt, Godau 1995): where chord P and chord Q are within ε of each other is convex in their
/// parameters. So whether one can get from one end of the pair to the next is known from its
/// borders alone, where the free parts are intervals, and the whole is decided exactly, without
/// samples. With curves, ε = tube − slack of P − slack of Q proves the tube: what is called inside
/// is inside; a pair nearer to the tube's edge than the slacks may be called outside.
///
/// `permitted`: by chord of `changed`, which of the original's may belong to it; ascending, each
/// with the last of the one before. Neither path is empty. Time: the pairs that can be reached.
/// Memory: one value a chord.
[[nodiscard]] TubeVerdict walk_tube(const ChordPath& changed, const ChordPath& original,
                                    std::span<const ChordRange> permitted, double tube_mm);

}  // namespace steadyrest::math::geometry
