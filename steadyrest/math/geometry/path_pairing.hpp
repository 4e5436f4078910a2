// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::math::geometry {

/// Which place of an original path a place of a changed path belongs to: both are walked from start
/// to end, never backwards, and stay within a tube.
///
/// Law: both paths become stations p₀…pₙ and q₀…qₘ, at most `step` apart and always with the ends
/// of each stretch. A walk (0,0) → (n,m) advances one path or both by one station at a time and
/// pairs only stations with |pᵢ − qⱼ| ≤ tube. Of all such walks the one with the least Σ|pᵢ − qⱼ|²
/// is taken; without one the discrete Fréchet distance of the paths exceeds the tube, and they part
/// at the first pᵢ that no walk reaches. As the walk is a walk through both paths in order, a
/// crossing, a further turn of a circle or helix, a line traced back or a spike cut short does not
/// mislead it. Between stations the place is interpolated.
///
/// Stretches: where both paths have the same number of cuts (neighbouring segments in the cut), cut
/// k belongs to cut k and is walked by itself, and what lies between two cuts is paired in
/// proportion, however different. Otherwise the paths are walked as a whole.
///
/// Accuracy: a path paired with itself gives every place itself, to rounding. Elsewhere the pair is
/// within a step of the best one; `distance_max_mm` is measured to the path, not to its stations.
/// The walk is sought within 4 tubes of path length about the best partial walk. Rotary axes do not
/// count. Time and memory: about 100 cells a station.
class PathPairing {
 public:
  struct Config {
    double tube_mm = 1.0;              ///< largest distance of paired stations; > 0
    double steps_per_tube = 10.0;      ///< stations in one tube's length
    double most_stations = 1'000'000;  ///< on longer paths they are farther apart
  };

  /// A place where the paths part.
  struct Parting {
    std::size_t changed_segment = 0;
    std::size_t original_segment = 0;  ///< where it goes on
    double distance_mm = 0.0;          ///< between the two places
    bool ended = false;  ///< the changed path ends here, or its cut does; the original goes on
  };

  /// Where the changed path is farthest from the original.
  struct Farthest {
    double distance_mm = 0.0;
    std::size_t changed_segment = 0;
    std::size_t original_segment = 0;
  };

  /// Both paths hold at least one segment.
  static std::expected<PathPairing, Parting> make(kernel::signal::PathView changed,
                                                  kernel::signal::PathView original,
                                                  const Config& config);

  /// The place on the original, as path length since its start, that belongs to a place on the
  /// changed path; never falls.
  [[nodiscard]] double original_mm(double changed_mm) const noexcept;

  [[nodiscard]] const Farthest& farthest() const noexcept { return farthest_; }
  /// Largest distance between paired stations; at least that of `farthest`, to rounding.
  [[nodiscard]] double slack_mm() const noexcept { return slack_mm_; }

 private:
  struct Knot {
    double changed_mm = 0.0;
    double original_mm = 0.0;
  };

  std::vector<Knot> knots_;  ///< ascending in both
  Farthest farthest_;
  double slack_mm_ = 0.0;
};

/// The segment that holds a place, given by path length since the start; the path is not empty.
[[nodiscard]] std::size_t segment_at(kernel::signal::PathView path, double position_mm) noexcept;

/// The nearest distance from a point to the places low … high of a path.
[[nodiscard]] double distance_to(kernel::signal::PathView path, const kernel::signal::Point& query,
                                 double low_mm, double high_mm) noexcept;

}  // namespace steadyrest::math::geometry
