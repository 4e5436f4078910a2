// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::supervisor {

/// Good time: the one clock that feeds every slew, timer and wait of the layer, made only from the
/// frames' time stamps.
///
/// Law, t the stamp of this call, t₀ the last good one, n the calls since then, T the usual step:
///   good      0 ≤ t − t₀ ≤ (n + 1.5)·T. The step counts as (t − t₀)/n and no more than 1.1·T: time
///             lost to missing or late frames and calls without a good stamp is not made up. T
///             follows the counted step, by 1/16 of the difference.
///   in doubt  anything else: no credit, good time stays. t becomes a candidate, unless it is not
///             finite or beyond 10¹⁰ s.
///   set       t is later than the candidate by no more than 2.5·T: the clock continues from there,
///             and the step counts as min(t − candidate, T). Forward, the time between has passed
///             (`time_s` includes it) but nobody watched it, so it gives no credit. Backwards, good
///             time continues without a step. A stamp that returns to t₀'s time is good again: a
///             single wrong stamp moves nothing.
///   slower    sixteen steps in doubt one after another, all forward and none above 10 s: T becomes
///             their mean. A source that delivers every 75 ms counts from the 17th frame on.
/// Credit therefore never exceeds the time by the stamps, whatever they are. A clock that always
/// runs fast goes unnoticed, though: there is no other clock here. `time_s` never runs backwards;
/// as long as all stamps are good it is the stamp itself, exactly.
class FrameClock {
 public:
  /// Beyond the calls: a stamp half a step late, and one lost frame. Test AStampMayBeLate….
  static constexpr double kSlackSteps = 1.5;

  struct Config {
    double usual_s = 0.001;  ///< initial T, > 0
  };

  struct Tick {
    double time_s = 0.0;  ///< good time, for the rooms
    /// This stamp in good time, good or not; `time_s` where it is not finite.
    double stamped_s = 0.0;
    double step_s = 0.0;  ///< credit of this cycle, ≥ 0
    bool good = false;    ///< the stamp counts
    bool jumped = false;  ///< good again after doubt: `time_s` includes the time between
    bool set = false;     ///< the clock began or went back: the time that passed is unknown
    /// none; input_not_finite; input_out_of_range: the stamp is earlier than the last good one
    kernel::outcome::Reason fault = kernel::outcome::Reason::none;
  };

  struct State {
    double stamp_s = 0.0;  ///< t₀
    double shift_s = 0.0;  ///< time_s = stamp_s + shift_s
    double usual_s = 0.0;  ///< T
    double candidate_s = 0.0;
    double run_from_s = 0.0;   ///< first stamp of an ascending run in doubt
    std::uint32_t doubts = 0;  ///< calls since t₀ without a good stamp
    std::uint32_t run = 0;
    bool in_doubt = false;  ///< there is a candidate
    bool started = false;
  };

  [[nodiscard]] static kernel::outcome::Result<FrameClock> make(const Config& config);

  Tick update(double stamp_s) noexcept;

  [[nodiscard]] double time_s() const noexcept { return state_.stamp_s + state_.shift_s; }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// Rejects a state that is not finite: the clock then begins with the next stamp.
  void restore(const State& state) noexcept;

 private:
  explicit FrameClock(const Config& config) noexcept : config_(config) {
    state_.usual_s = config.usual_s;
  }
  Tick begin(double stamp_s) noexcept;
  Tick accept(double stamp_s, double step_s) noexcept;
  Tick doubt(double stamp_s) noexcept;

  Config config_;
  State state_;
};

}  // namespace steadyrest::supervisor
