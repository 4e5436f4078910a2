// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace steadyrest::chatter::online {

/// How much a revolution differs from the previous one: a Poincaré section in the angle domain, at
/// kPoints angles of the spindle.
///
/// Law: D = Σ (xᵢ − xᵢ₋₁)²/2 over one revolution, xᵢ the signal at the same angle in revolution i,
/// between samples on a straight line; X = Σ x². D/X is 0 for a cut that repeats and
/// 1 − cos 2πν, over many revolutions, for a line of order ν. Works with any speed law. A line of
/// whole order (period doubling of a two-tooth cutter) does not show. Needs kLeastSamples samples
/// per revolution; with fewer the answer is not `known`. O(1) per sample.
class RevolutionSpread {
 public:
  static constexpr std::size_t kPoints = 64;
  static constexpr double kLeastSamples = 64.0;

  struct Output {
    bool known = false;
    double changed_energy = 0.0;  ///< D over kPoints, unit²
    double energy = 0.0;          ///< X over kPoints
  };

  /// `angle_rev` rises; a step above 1/kLeastSamples makes the answer unknown.
  const Output& update(double value, double angle_rev) noexcept;
  void reset() noexcept { *this = {}; }

 private:
  std::array<double, kPoints> last_{};
  Output out_;
  double value_ = 0.0;
  double angle_rev_ = 0.0;
  bool started_ = false;
  std::size_t seen_ = 0;  ///< points since the start, up to 2·kPoints
  std::size_t points_ = 0;
  double sum_change_ = 0.0, sum_ = 0.0;
};

}  // namespace steadyrest::chatter::online
