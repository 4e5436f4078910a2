// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <steadyrest/contour/offline/predistort/followed_run.hpp>
#include <steadyrest/contour/offline/predistort/shape/piece.hpp>

namespace steadyrest::contour::offline {

/// Corners at which the control stops, led beyond along the line and back: the command runs on by
/// d, returns to the corner and goes on from there. All of it lies on the program's own line, so
/// the tool stays on it too.
///
/// Law: an axis that follows with the lag e = v/k is left with −v/k + 2·(v/k)·e^(−k·d/v) after the
/// way out and back: nothing for d = v·ln 2/k, for 2·ln 2/k of time. The ramps of the speed and a
/// velocity loop move that a little: d is found by secants on whole runs.
class CornerLegs {
 public:
  struct Config {
    double limit_mm = 0.01;
    double lag_s = 0.0;  ///< of the softest axis
    double most_mm = 2.0;
  };
  explicit CornerLegs(const Config& config) : config_(config) {}

  /// Takes up the corners where the axes are behind by more than the limit across the way that
  /// follows, and moves the ends of the legs that there are. False when nothing moved.
  bool update(std::span<const Piece> pieces, std::span<const BlockStart> starts);
  /// The pieces with the legs.
  [[nodiscard]] std::vector<Piece> with_legs(std::span<const Piece> pieces) const;

 private:
  struct Leg {
    double at_mm = 0.0;  ///< progress at the corner
    double beyond_mm = 0.0;
    double last_mm = 0.0;         ///< the one before …
    double last_behind_mm = 0.0;  ///< … and what it left
  };
  [[nodiscard]] const Leg* leg_at(double at_mm) const;

  Config config_;
  std::vector<Leg> legs_;
};

}  // namespace steadyrest::contour::offline
