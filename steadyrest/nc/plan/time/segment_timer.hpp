// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/time/cyclogram.hpp>

namespace steadyrest::nc::plan {

/// Times a program segment by segment in closed form, as ProgramTimer does period by period, at 100
/// % override, for callers that only need arrival times.
///
/// Law, that of interpolator.hpp with N = 1. S_k = Σ 2·a_m·ℓ_m up to the end of segment k, c_k its
/// junction limit, e the last segment within the look-ahead of i (c_e = 0):
///   exit      w_i = min over k = i…e of (c_k² + S_k) − S_i,   v_out² = min(w_i, v_in² + 2·a·ℓ)
///   peak      v_p² = min(V², (v_in² + v_out² + 2·a·ℓ)/2),   V the segment's target
///   time      t = (2·v_p − v_in − v_out)/a + (ℓ − (2·v_p² − v_in² − v_out²)/(2·a))/v_p
/// so a line from stop to stop takes L/V + V/A. The minimum slides with the segments (its cost does
/// not depend on the look-ahead); a stop, a dwell, a tool change and a wait for the spindle end
/// with a period of the interpolator, as there.
///
/// Accuracy: within 0.65 period per move of the interpolator's time, 0.1 % or less on real programs
/// (README.md). A machine with a jerk limit (N > 1) is timed by ProgramTimer itself.
class SegmentTimer final : public interpret::Sink {
 public:
  /// Refuses a machine that the interpolator refuses. `machine` must outlive the timer.
  static kernel::outcome::Result<SegmentTimer> make(const kernel::machine::Machine& machine);
  SegmentTimer(SegmentTimer&& other) noexcept;
  ~SegmentTimer() override;

  void on_move(const interpret::Move& move) override;
  void on_event(const interpret::Event& event) override;

  /// Called with a move's line when the machine reaches it, and the time since the program's start.
  using Arrival = std::function<void(std::uint32_t line, double time_s)>;
  void set_arrival(Arrival arrival);

  /// Seconds of the whole program; call once after the last move. Refuses as ProgramTimer does.
  [[nodiscard]] kernel::outcome::Result<double> take();
  /// The same, with the transitions.
  struct Timed {
    double total_s = 0.0;
    std::vector<Transition> cyclogram;
  };
  [[nodiscard]] kernel::outcome::Result<Timed> take_cyclogram();

 private:
  class Runner;
  explicit SegmentTimer(std::unique_ptr<Runner> runner);
  std::unique_ptr<Runner> runner_;
};

}  // namespace steadyrest::nc::plan
