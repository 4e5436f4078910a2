// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::online {

/// Least squares through the last edges with their times.
///
/// Law. Takes every (s + 1)-th of the last edges, at most n and, with a window W, none older than W
/// except the p + 1 that a fit needs. With u = (t − t_0)·α, α = 1/(t_n − t_0), t_0 the oldest:
///   x̂(u) = Σ_i b_i·u^i minimises Σ (x̂(u_j) − x_j)²,   v = α·x̂′(u),   a = α²·x̂″(u)   at the tick.
/// Too few different stamps lower the degree. Then, since the count is more certain than the
/// extrapolation, the position is clipped to the tick's cell and the velocity to what the cell
/// permits since the last edge,
///   (low − e − x_n)/age ≤ v ≤ (high + e − x_n)/age,   e = line error, and where this bites a =
///   −v/age
/// (the bound's own derivative). No edge for `timeout_s`: at rest, the edges are forgotten.
///
/// Accuracy, N edges of σ² = σ_line² + (v·clock)²/12 in W, p = 2: var v = 192·σ²/(N·W²), var a =
/// 720·σ²/(N·W⁴), under a jerk J −J·W²/10 and −J·W/2. Half of the noise and no bias at 0.276·W
/// before the end for v and W/2 for a. Stale around starts, stops and reversals, where a window
/// holds too few edges. No bounds. Cost grows with n. Source: Merry, van de Molengraft, Steinbuch,
/// Mechatronics 20 (2010) 20, with their skip.
class EventFit final : public Estimator {
 public:
  static constexpr std::size_t kMaxEdges = 512;
  struct Config {
    double count_mm = 0.001;          ///< q > 0
    std::size_t degree = 2;           ///< p; 1…3
    std::size_t edges = 16;           ///< n; p + 1…512, n·(s + 1) ≤ 512
    std::size_t skip = 0;             ///< s; 3 takes edges of one phase only
    double window_s = 0.0;            ///< W; 0 = by number alone
    double line_error_counts = 0.25;  ///< e/q ≥ 0; slack of the clip of v
    double timeout_s = 0.5;           ///< > 0
  };

  static kernel::outcome::Result<EventFit> make(const Config& config);

  void edge(const Edge& edge) noexcept override;
  Estimate tick(const Tick& tick) noexcept override;

 private:
  struct Event {
    double t_s = 0.0;
    double x_mm = 0.0;
  };
  explicit EventFit(const Config& config) noexcept : config_(config) {}
  [[nodiscard]] const Event& back(std::size_t events) const noexcept {
    return events_[(newest_ + events_.size() - events) % events_.size()];
  }
  [[nodiscard]] std::size_t chosen(double now_s) const noexcept;
  template <int kTerms>
  bool fit(std::size_t count, double now_s, Estimate& out) const noexcept;
  void extrapolate(double now_s, Estimate& out) const noexcept;
  void clip(const Tick& tick, Estimate& out) const noexcept;

  Config config_;
  std::array<Event, kMaxEdges> events_{};  ///< a ring
  std::size_t newest_ = 0;
  std::size_t known_ = 0;
};

}  // namespace steadyrest::motion::online
