// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/plan/time/look_ahead.hpp>
#include <steadyrest/nc/plan/time/setpoint.hpp>

/// The control's interpolator: one setpoint for each interpolator period from the planned path.
///
/// Law. The path parameter s runs ahead as s_r with an acceleration-limited speed; the setpoint is
/// the moving average s(t) = 1/N Σ s_r(t − jT) over the jerk time N·T = max A_i/J_i, so the
/// geometry is exact and |d³s/dt³| ≤ A/(N·T) ≤ J. Without a jerk limit N = 1: the trapezoid.
///   look-ahead  w_k = largest v² at the end of segment k: backwards over the window,
///               w_{k−1} = min(c²_{k−1}, w_k + 2·a_k·(ℓ_k − h_k)), 0 at the window's end; done
///               again when an override changes. c = min(junction limit, targets of both segments).
///   smearing    a limit c at s_k binds s_r over c·N·T/2 before s_k (h) and until the averaged s
///               has passed s_k: the averaged speed then meets c at s_k and exceeds it nowhere.
///   reversal    at least N periods of constant speed separate rising from falling v_r; otherwise
///               the average would see 2A in one window. The result on a line is the textbook
///               S-curve: t = L/V + V/A + A/J.
///   one cycle   largest v' ≤ v + aT with v'² ≤ w + 2a·(d − (v + v')·T/2), d = distance left to
///               the limit.
/// Override: target = feed · ratio, clipped to the segment's limit; 0 holds; locked segments ignore
/// it.
///
/// make() allocates all memory; update() never allocates, and the look-ahead bounds its work.
namespace steadyrest::nc::plan {

class Interpolator {
 public:
  /// The arrays behind `path` must outlive the interpolator. Refuses a machine whose control has no
  /// positive period, no look-ahead, or a jerk time above 10 000 periods.
  static kernel::outcome::Result<Interpolator> make(const kernel::machine::Machine& machine,
                                                    const PathWindow& path);

  /// The setpoint at the end of the next interpolator period. Who samples seldom saves most of the
  /// time with `placed` false: in motion, position and velocity are then not worked out.
  Setpoint update(const Overrides& overrides, bool placed = true) noexcept;

  /// Passes the periods that further updates with the last one's overrides would make like it: the
  /// same event waited for, or the same speed on the same segment. Returns how many; 0 where it
  /// ends soon. What is passed costs nothing, however long it is.
  std::size_t pass_alike() noexcept;

  /// Tells the interpolator that more of a long program is in the window now.
  void extend(std::size_t end, std::size_t event_end, bool complete) noexcept;
  /// The program goes on, but the window is shorter than the look-ahead.
  [[nodiscard]] bool wants_more() const noexcept;
  /// The last update had nothing to do: the rest of the program is not in the window yet.
  [[nodiscard]] bool starved() const noexcept { return starved_; }
  /// Segments and events below these are not read again.
  [[nodiscard]] std::size_t first_segment_in_use() const noexcept { return index_; }
  [[nodiscard]] std::size_t first_event_in_use() const noexcept { return event_; }

  [[nodiscard]] bool finished() const noexcept { return phase_ == Phase::finished; }

 private:
  enum class Phase : std::uint8_t { standstill, run, flush, finished };
  struct Lag {
    std::size_t index = 0;
    double cap_mm_s = 0.0;
  };

  Interpolator(const kernel::machine::Machine& machine, const PathWindow& path, std::size_t taps,
               std::size_t look_ahead);

  [[nodiscard]] bool stops_after(std::size_t i) const noexcept;

  [[nodiscard]] std::size_t alike_at_event() const noexcept;
  [[nodiscard]] std::size_t alike_in_motion() const noexcept;
  void take(const Overrides& overrides) noexcept;
  [[nodiscard]] double next_speed() noexcept;
  [[nodiscard]] double lag_cap_mm_s() const noexcept;
  void push_lag(std::size_t index) noexcept;
  void run() noexcept;
  void average() noexcept;
  void locate() noexcept;
  void settle() noexcept;
  [[nodiscard]] bool at_event() noexcept;
  [[nodiscard]] bool event_passed(const PathEvent& event) noexcept;
  [[nodiscard]] Setpoint setpoint(bool placed) noexcept;

  PathWindow window_;
  double period_s_;
  double jerk_time_s_;
  double tool_change_s_;
  double max_spindle_rev_s_;
  double max_feed_ratio_;
  double max_rapid_ratio_;
  LookAhead look_ahead_;

  // the leading, acceleration-limited state
  Lead lead_;
  std::size_t since_rise_;
  std::size_t since_fall_;

  // the moving average
  std::size_t taps_;
  std::vector<double> position_ring_;
  std::vector<double> speed_ring_;
  std::size_t ring_at_ = 0;
  double position_sum_ = 0.0;
  double speed_sum_ = 0.0;
  std::size_t flush_ = 0;
  std::vector<Lag> lag_;
  std::size_t lag_head_ = 0;
  std::size_t lag_tail_ = 0;

  // the setpoint's state
  Phase phase_ = Phase::standstill;
  std::size_t index_ = 0;
  std::size_t event_ = 0;
  double event_time_s_ = 0.0;
  bool event_active_ = false;
  bool starved_ = false;
  double distance_mm_ = 0.0;
  double speed_mm_s_ = 0.0;
  double spindle_rev_s_ = 0.0;
  bool coolant_ = false;
  kernel::signal::AxisValues position_{};
  double path_position_mm_ = 0.0;
  std::uint32_t line_ = 0;
  Overrides overrides_;
};

}  // namespace steadyrest::nc::plan
