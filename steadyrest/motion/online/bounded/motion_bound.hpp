// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

/// Intervals that must contain velocity and acceleration (set membership).
///
/// Inputs are the passages of lines, x(tᵢ) = xᵢ ± εᵢ with ε = |v|·clock/2 + line error, the cell at
/// each tick (its middle ± half a count), and the limits |v| ≤ V, |a| ≤ A, |jerk| ≤ J. For three
/// instants t₁ > t₂ > t₃, none after T, the parabola p through the three positions errs at T by at
/// most
///   |ẋ(T) − ṗ(T)| ≤ Σ|ℓ̇ᵢ(T)|·εᵢ + J·ω̇(T)/6,   |ẍ(T) − p̈(T)| ≤ Σ|ℓ̈ᵢ(T)|·εᵢ + J·ω̈(T)/6,
/// ℓᵢ Lagrange's polynomials, ω = Π(t − tᵢ) (the remainder of interpolation outside the nodes).
/// With t₃ a span q back and t₂ half-way this is 3.30·ε^⅔·J^⅓ and 3.00·ε^⅓·J^⅔ at the best spans (q
/// = 3.63·∛(ε/J), 4.00·∛(ε/J)): 6 % and 4 % above what any estimator can guarantee
/// (Landau–Kolmogorov on the half line, 3.12 and 2.88). The result intersects the intervals of
/// several such triples, of the last tick's intervals propagated under J and A, and of the limits
/// themselves; it holds as long as the limits do. Unit of length: mm.
namespace steadyrest::motion::online {

struct Interval {
  double low = -kNoBound;
  double high = kNoBound;

  [[nodiscard]] bool empty() const noexcept { return low > high; }
  [[nodiscard]] double magnitude() const noexcept {
    return std::max(std::abs(low), std::abs(high));
  }
  void cut(double centre, double radius) noexcept {
    low = std::max(low, centre - radius);
    high = std::min(high, centre + radius);
  }
};

struct MotionIntervals {
  Interval velocity;      ///< mm/s
  Interval acceleration;  ///< mm/s²
};

class MotionBound {
 public:
  struct Config {
    double cycle_s = 0.001;  ///< 1e-6 … 1
    double clock_s = 0.0;    ///< period of the edges' time stamps, 0 … cycle
    double max_speed_mm_s = kNoBound;
    double max_acceleration_mm_s2 = kNoBound;
    double max_jerk_mm_s3 = kNoBound;
  };
  static kernel::outcome::Result<MotionBound> make(const Config& config);

  /// A line was passed; `line_error_mm` bounds the error of its position.
  void edge(double t_s, double position_mm, double line_error_mm) noexcept;
  /// The axis is in [low, high] at the tick.
  MotionIntervals tick(double t_s, double low_mm, double high_mm) noexcept;
  /// Forgets all observations: the record has a gap.
  void forget() noexcept;

  /// Ticks at which no motion within the limits explains the record: the limits or the line error
  /// are wrong.
  [[nodiscard]] std::uint64_t contradictions() const noexcept { return contradictions_; }

 private:
  struct Node {
    double t_s = 0.0;
    double position_mm = 0.0;
    double error_mm = 0.0;
  };
  static constexpr std::size_t kNodes = 256;
  static constexpr double kNodesPerCycle = 8.0;
  static constexpr std::size_t kSpans = 4;
  static constexpr std::size_t kRestTicks = 32;

  explicit MotionBound(const Config& config) noexcept;
  /// Where a search ended at the last tick; ages change little between ticks.
  struct Hints {
    std::array<std::size_t, kSpans> third{};
    std::array<std::size_t, kSpans> second{};
  };
  [[nodiscard]] const Node& back(std::size_t age) const noexcept {
    return nodes_[(next_ + kNodes - 1 - age) % kNodes];
  }
  [[nodiscard]] std::size_t age_at(double t_s, std::size_t guess) const noexcept;
  [[nodiscard]] double speed_now(double t_s) const noexcept;
  void keep(const Node& node) noexcept;
  void advance(double t_s) noexcept;
  void triple(double t_s, const Node& first, const Node& second, const Node& third) noexcept;
  void triples(double t_s, const Node& first, Hints& hints) noexcept;
  void pairs(double t_s) noexcept;
  void rest_begins(double half_cell_mm) noexcept;
  void standstill(const Node& cell) noexcept;
  void standstill(const Node& cell, std::size_t steps) noexcept;

  Config config_;
  double span_of_jerk_ = 0.0;          ///< ∛(48/J)
  double span_of_acceleration_ = 0.0;  ///< 2/√A
  std::array<Node, kNodes> nodes_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  Node waiting_{};  ///< the latest passage; becomes a node when far enough from the last
  bool has_waiting_ = false;
  std::array<double, kRestTicks> rest_s_{};  ///< ticks that showed this cell, every rest_step_-th
  std::size_t rest_next_ = 0;
  std::size_t rest_count_ = 0;
  std::size_t rest_step_ = 1;
  std::size_t rest_wait_ = 0;       ///< ticks until the next is kept
  double rest_half_cell_mm_ = 0.0;  ///< for which the spans below apply
  std::size_t rest_steps_v_ = 0;    ///< spans in kept ticks
  std::size_t rest_steps_a_ = 0;
  Hints passage_hints_;
  Hints cell_hints_;
  std::size_t pair_hint_ = 0;
  double cell_mm_ = 0.0;  ///< middle of the cell at the last tick
  bool passed_ = false;   ///< an edge came since the last tick
  bool started_ = false;
  bool sampled_ = true;  ///< no edge so far: only the ticks' cells are known
  double t_s_ = 0.0;
  MotionIntervals now_;
  MotionIntervals fresh_;  ///< of this tick only
  std::uint64_t contradictions_ = 0;
};

}  // namespace steadyrest::motion::online
