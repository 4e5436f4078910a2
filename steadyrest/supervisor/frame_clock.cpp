// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/supervisor/frame_clock.hpp>

// Good time: a stamp is believed when the calls since the last good one explain how far it is
// ahead. Anything else is in doubt, and only a second stamp that follows the first proves that the
// clock was set or has jumped. One wrong stamp therefore moves nothing, and credit (step_s, what
// slews may use) never exceeds the time that has really passed.
namespace steadyrest::supervisor {
namespace {

using kernel::outcome::Reason;

// In usual steps: only 1/√31 of the stamps' jitter gets into it, less than a fifth. Test
// TheUsualStepFollowsByASixteenth.
constexpr double kMemorySteps = 16.0;
// The most that one call counts: all that can have passed in it. A fast clock thus carries the
// usual step along by 0.1/16 per call at most. Property CreditNeverPassesTheRealTime….
constexpr double kMostSteps = 1.1;
// As long as the memory. Test ASlowSourceCountsFromItsSeventeenthFrame.
constexpr std::uint32_t kSlowerRun = 16;
constexpr double kFarthestS = 1e10;     // beyond it a double cannot resolve a cycle
constexpr double kLongestStepS = 10.0;  // no source delivers more slowly

}  // namespace

kernel::outcome::Result<FrameClock> FrameClock::make(const Config& config) {
  if (!(std::isfinite(config.usual_s) && config.usual_s > 0.0)) {
    return kernel::outcome::refuse("the interpolator's period is not above 0",
                                   "correct interpolator_period_ms");
  }
  return FrameClock(config);
}

// If time had begun before, shift carries it on: good time never runs backwards, whatever the clock
// is set to.
FrameClock::Tick FrameClock::begin(double stamp_s) noexcept {
  const double time_s = this->time_s();
  state_ = {.stamp_s = stamp_s,
            .shift_s = state_.started ? time_s - stamp_s : 0.0,
            .usual_s = state_.usual_s,
            .started = true};
  return {.time_s = this->time_s(), .stamped_s = this->time_s(), .good = true, .set = true};
}

// Repeated stamps (step 0) tell nothing about the usual step and do not enter its mean.
FrameClock::Tick FrameClock::accept(double stamp_s, double step_s) noexcept {
  if (step_s > 0.0) {
    state_.usual_s += (step_s - state_.usual_s) / kMemorySteps;
  }
  state_.stamp_s = stamp_s;
  state_.doubts = 0;
  state_.run = 0;
  state_.in_doubt = false;
  return {.time_s = time_s(), .stamped_s = time_s(), .step_s = step_s, .good = true};
}

// A stamp in doubt is kept as the candidate. Once confirmed, a step forwards is a gap (time has
// passed but earns no credit: nobody saw what happened in it), and a step back is a clock that was
// set (time continues from where it was).
FrameClock::Tick FrameClock::doubt(double stamp_s) noexcept {
  const bool earlier = stamp_s < state_.stamp_s;
  if (state_.in_doubt && stamp_s > state_.candidate_s) {
    const double step_s = stamp_s - state_.candidate_s;
    // As in update(): one step and the slack. Or sixteen ascending stamps in a row, for a source
    // slower than the machine file says; their mean then becomes its usual step.
    const bool follows = step_s <= (1.0 + kSlackSteps) * state_.usual_s;
    state_.run = step_s <= kLongestStepS ? state_.run + 1 : 0;
    state_.run_from_s = state_.run == 0 ? stamp_s : state_.run_from_s;
    const bool slower = state_.run >= kSlowerRun;
    if (follows || slower) {
      if (!follows) {
        state_.usual_s = (stamp_s - state_.run_from_s) / static_cast<double>(state_.run);
      }
      // The step from candidate to stamp is good time; the gap before the candidate is not.
      const double credit_s = follows ? std::min(step_s, state_.usual_s) : 0.0;
      if (earlier) {
        const double time_s = this->time_s() + credit_s;
        state_.shift_s = time_s - stamp_s;
      }
      Tick tick = accept(stamp_s, credit_s);
      tick.set = earlier;
      tick.jumped = !earlier;
      return tick;
    }
  } else if (!state_.in_doubt || stamp_s < state_.candidate_s) {
    // Below the candidate: the candidate was the wrong stamp, and a run starts over here.
    state_.run = 0;
    state_.run_from_s = stamp_s;
  }
  state_.candidate_s = stamp_s;
  state_.in_doubt = true;
  // Ahead, the frame may still be right (a gap); earlier, its age is unknown and it is unfit.
  return {.time_s = time_s(),
          .stamped_s = stamp_s + state_.shift_s,
          .fault = earlier ? Reason::input_out_of_range : Reason::none};
}

FrameClock::Tick FrameClock::update(double stamp_s) noexcept {
  if (!(std::abs(stamp_s) <= kFarthestS)) {
    state_.doubts += state_.doubts < std::numeric_limits<std::uint32_t>::max() ? 1U : 0U;
    return {
        .time_s = time_s(),
        .stamped_s = time_s(),
        .fault = std::isfinite(stamp_s) ? Reason::input_out_of_range : Reason::input_not_finite};
  }
  if (!state_.started) {
    return begin(stamp_s);
  }
  // Calls without a good stamp explain as many steps: after three doubted frames a stamp four steps
  // on is expected. The credit is one call's share of it.
  const double calls = static_cast<double>(state_.doubts) + 1.0;
  const double passed_s = stamp_s - state_.stamp_s;
  if (passed_s >= 0.0 && passed_s <= (calls + kSlackSteps) * state_.usual_s) {
    const double step_s = (stamp_s + state_.shift_s - time_s()) / calls;
    return accept(stamp_s, std::min(step_s, kMostSteps * state_.usual_s));
  }
  state_.doubts += state_.doubts < std::numeric_limits<std::uint32_t>::max() ? 1U : 0U;
  return doubt(stamp_s);
}

// A NaN from a file would put every later stamp in doubt.
void FrameClock::restore(const State& state) noexcept {
  const bool fit = std::isfinite(state.stamp_s) && std::isfinite(state.shift_s) &&
                   std::isfinite(state.candidate_s) && std::isfinite(state.run_from_s) &&
                   std::isfinite(state.usual_s) && state.usual_s > 0.0;
  state_ = fit ? state : State{.usual_s = config_.usual_s};
}

}  // namespace steadyrest::supervisor
