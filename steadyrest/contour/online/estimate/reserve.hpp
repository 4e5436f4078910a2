// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace steadyrest::contour::online {

/// What the contour limit must leave for what the forecast does not know.
///
/// Law. ε_seen is the contour error of the table as encoders and backlash show it, ε_model the one
/// that the servo model gives for the same commands. The excess x = |ε_seen| − |ε_model| counts
/// where one of the two is at least kCounts of the limit, since only there can it break the limit,
/// and everywhere while offsets take ε_model away. What makes the error smaller is no risk, so σ²
/// is twice the mean square of x > 0 over kMemoryS, less the encoder's q²/12, and
///   reserve = max(0, √((3σ)² + (kDoubt·b/2)²) − margin·ε_max) ≤ kMost·ε_max,
///   limit   = ε_max·(1 − margin) − reserve,
/// with the backlash b, which nothing measures: the forecast follows it, but the machine file may
/// be off. The margin covers the first part of both; what no encoder sees is its task too.
class Reserve {
 public:
  // Effect on the rib pocket of halving and doubling them: README, "What the constants do".
  static constexpr double kSigmas = 3.0;
  static constexpr double kMemoryS = 1.0;
  static constexpr double kCounts = 0.3;
  static constexpr double kDoubt = 0.4;
  static constexpr double kMost = 0.6;  ///< all of it would always ask for the lowest step

  struct Config {
    double limit_mm = 0.010;  ///< ε_max
    double margin = 0.05;
    double half_backlash_mm = 0.0;  ///< b/2, the largest of the axes
    double count_mm = 0.0;          ///< q, the largest of the axes
  };
  /// Plain values: enough to log and to restore.
  struct State {
    double excess_mm2 = 0.0;  ///< twice the mean square of x > 0
  };
  struct Input {
    double seen_mm = 0.0;      ///< |ε_seen|
    double modelled_mm = 0.0;  ///< |ε_model|
    double step_s = 0.0;
    bool cancelled = false;  ///< offsets take the modelled error away: all of it counts
  };

  Reserve() = default;
  explicit Reserve(const Config& config) noexcept : config_(config) {}

  /// One cycle in the cut. Returns the limit.
  double update(const Input& input) noexcept;
  /// Another servo model holds: what the old one left unexplained no longer counts.
  void forget() noexcept { state_ = {}; }

  [[nodiscard]] double limit_mm() const noexcept;
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// A state that is no sum of squares starts over.
  void restore(const State& state) noexcept {
    state_ = std::isfinite(state.excess_mm2) && state.excess_mm2 >= 0.0 ? state : State{};
  }

 private:
  Config config_;
  State state_;
};

}  // namespace steadyrest::contour::online
