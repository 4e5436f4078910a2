// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/motion/online/bounded/model_bank.hpp>
#include <steadyrest/motion/online/bounded/motion_bound.hpp>

/// Fixed lag: the estimate for L ticks ago, using everything seen since.
///
/// The same models run backwards in time from now to then (x, −v, a over −t), without prior
/// knowledge, through the observations since; at t − L they are joined with the forward filters'
/// estimates (two-filter smoother, Fraser and Potter 1969). Cost: one more filter step per
/// observation within the lag, at every tick. The most that a lag can gain (guaranteed errors, jerk
/// limit): 3.0 times in velocity and 2.0 in acceleration, reached near ∛(192·ε/J). Lengths are
/// counts.
///
/// Two rings: of *observations* (edges, as position z with variance r, since the oldest tick that
/// may be requested), and of *looks*, one per tick: what the forward filters knew when they saw the
/// axis' cell.
namespace steadyrest::motion::online {

class LagSmoother {
 public:
  static constexpr std::size_t kMostTicks = 32;

  /// What the forward filters knew at one tick.
  struct Look {
    double t_s = 0.0;
    ModelBank bank;            ///< the moving models: means and covariances
    Lanes weight{};            ///< of each of them
    double weight_rest = 0.0;  ///< of standstill; all weights together are 1
    double rest_x = 0.0;       ///< where the axis is, if at rest
    MotionIntervals sure;      ///< guaranteed at that tick
    double low_mm = 0.0;       ///< the cell
    double high_mm = 0.0;
  };
  struct State {
    double x = 0.0;
    double v = 0.0;
    double a = 0.0;
  };

  explicit LagSmoother(std::size_t ticks = 0) noexcept
      : ticks_(ticks < kMostTicks ? ticks : kMostTicks) {}
  [[nodiscard]] bool active() const noexcept { return ticks_ > 0; }

  void observed(double t_s, const Lanes& z, const Lanes& r) noexcept;
  void looked(const Look& look) noexcept;
  void forget() noexcept;
  /// The look of `ticks` ago, or the oldest one.
  [[nodiscard]] const Look& then() const noexcept;
  /// The state then, given everything until now.
  [[nodiscard]] State smooth(const Lanes& jerk_density, double cycle_s) const noexcept;

 private:
  struct Seen {
    double t_s = 0.0;
    Lanes z{};
    Lanes r{};
  };
  static constexpr std::size_t kSeen = 512;  ///< EdgeGroup gives at most 16 per cycle

  std::size_t ticks_;
  std::array<Look, kMostTicks + 1> looks_{};
  std::size_t next_look_ = 0;
  std::size_t look_count_ = 0;
  std::array<Seen, kSeen> seen_{};
  std::size_t next_seen_ = 0;
  std::size_t seen_count_ = 0;
};

}  // namespace steadyrest::motion::online
