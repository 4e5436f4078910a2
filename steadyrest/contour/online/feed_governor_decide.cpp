// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/search/step_search.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Which step to take: the search over the table.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::machine::ContourStrategy;
using kernel::outcome::Reason;
using kernel::signal::Frame;
using kernel::signal::Point;

// Effect on the rib pocket of halving and doubling them: README, "What the constants do".
constexpr double kRiseRoom = 0.98;  // share of the limit that a rise may use
constexpr double kRiseRoomInPause = 0.85;
// In 1/k of the softest axis. Held until the next decision alone, a step is as good as the fall by
// kTraceRoom on any slow servo, and the fall would be put off again and again.
constexpr double kTraceHold = 1.0;
constexpr double kStretchTurn = 0.1;   // rad by which an even stretch may deviate from its mean
constexpr double kTraceRoom = 1.02;    // over the fall's own error: twenty times what a forecast …
constexpr double kTraceRoomMm = 2e-4;  // … is off by, and twice (0.1 % + 0.1 µm, forecast.hpp)
constexpr double kUnsettled = 0.75;    // of the settling time: e⁻³ of the last step's error is left
constexpr double kTieMm = 1e-4;        // errors closer than this are equal: a forecast's 0.1 µm
constexpr double kOffsetSight_s = 0.25;
constexpr double kFollowAgain = 0.9;  // of the other error², so that it does not go to and fro
constexpr double kTie = 1e-9;         // other objectives: their rounding

/// Adds a forecast to the decision's count; returns its steps.
std::size_t count(std::size_t steps, FeedGovernor::Output& output) noexcept {
  ++output.forecasts;
  output.forecast_steps += static_cast<std::uint32_t>(steps);
  return steps;
}

}  // namespace

/// Where the path's turning deviates from its mean between foot and command. Even means that the
/// path turns at a constant rate, as on an arc, a line or the CAM chords of either. A rise held for
/// long must not break the limit on this stretch; beyond it the fall comes in time, as
/// admissibility ensures.
double FeedGovernor::stretch_end_mm(const LookAhead& path, const Outset& outset) const noexcept {
  const auto turn_into = [&path](std::size_t i) {
    return geometry::distance(path.cell(i).tangent, path.cell(i + 1).tangent);
  };
  double turned = 0.0;
  for (std::size_t i = outset.foot_cell; i < outset.command_cell; ++i) {
    turned += turn_into(i);
  }
  const double begin = path.cell(outset.foot_cell).position_mm;
  const Cell& here = path.cell(outset.command_cell);
  // The foot lags behind the command, so the turning between the two is the curvature that causes
  // the present error.
  const double length = here.position_mm - begin;
  const double rate = length > 0.0 ? turned / length : geometry::norm(here.curvature_1_mm);
  const double end = outset.position_mm + config_.pause_s * std::max(here.feed_mm_s, 1.0);
  for (std::size_t i = outset.command_cell; i + 1 < path.end(); ++i) {
    const Cell& cell = path.cell(i);
    const double expected = rate * (cell.position_mm - begin);
    if (!cell.cutting || cell.by_text ||
        std::abs(turned - expected) > kStretchTurn * (1.0 + expected)) {
      return cell.position_mm;
    }
    if (cell.position_mm > end) {
      break;
    }
    turned += turn_into(i);
  }
  return end;
}

/// The search for the largest admissible step, with the forecasts spent so far.
struct FeedGovernor::Search {
  Search(const FeedGovernor& governor, const Outset& from, Output& into) noexcept
      : of(governor),
        path(governor.state_.last.path_known ? governor.ahead_ : governor.guess_),
        outset(from),
        output(into),
        limit_mm(governor.reserve_.limit_mm()),
        in_force(governor.forecast_.floor_ratio(governor.state_.in_force_ratio)) {
    plan.start = of.state_.in_force_ratio;
    plan.floor = of.candidate_.front();
    plan.hold_s = of.next_in_s();
  }

  Forecast::Result forecast(const RatioPlan& tried, double most_mm,
                            const Forecast::Trace* trace) noexcept {
    // Stops at the first place above the limit: most candidates that fail do so at once.
    const Forecast::Result result =
        of.forecast_.run(path, outset, tried, most_mm, true, trace, nullptr);
    spent += count(result.steps, output);
    return result;
  }

  /// Tells whether the step may be taken and, where it is a rise, held.
  bool admissible(std::size_t c, const Forecast::Trace* trace) noexcept {
    plan.target = of.candidate_[c];
    plan.hold_s = trace == nullptr ? of.next_in_s()
                                   : std::max(of.next_in_s(), kTraceHold / of.softest_gain_1_s_);
    const Forecast::Result result = forecast(plan, limit_mm, trace);
    if (!result.kept) {
      return false;
    }
    const bool rises = of.candidate_[c] > in_force + kSameRatio;
    // Along a trace the limit is broken anyway; a rise there need not last.
    if (rises && trace == nullptr) {
      const bool pauses = of.course_s() - of.state_.fallen_s < of.config_.pause_s;
      const double room_mm = (pauses ? kRiseRoomInPause : kRiseRoom) * limit_mm;
      RatioPlan lasting = plan;
      lasting.hold_s = of.config_.pause_s;
      const Forecast::Result held = forecast(lasting, room_mm, nullptr);
      const bool lasts = held.kept || held.broken_mm >= of.stretch_end_mm(path, outset);
      if (std::abs(result.error_mm) > room_mm || !lasts) {
        choice.held_back = choice.held_back || lasts;
        return false;
      }
    }
    choice.forecast = result;  // the last one that is admissible is the largest
    choice.hold_s = plan.hold_s;
    return true;
  }

  /// Searches the candidates up to `top`; false where none is admissible, not even the lowest. From
  /// the highest down while the table is small; otherwise from the step in force, where the answer
  /// nearly always lies.
  bool find(std::size_t top, const Forecast::Trace* trace) noexcept {
    const auto may_go_on = [&] { return spent < of.search_steps_; };
    const auto is_admissible = [&](std::size_t c) { return admissible(c, trace); };
    const auto& candidate = of.candidate_;
    const auto above = std::ranges::upper_bound(candidate, in_force + kSameRatio);
    const auto start =
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - candidate.begin() - 1, 0));
    // Slower steps need not keep within what the fall alone gives, so all steps must be tried.
    const bool all = trace != nullptr || candidate.size() <= of.config_.exhaustive_steps;
    const auto found = all ? first_admissible_below(top, is_admissible, may_go_on)
                           : largest_admissible_near(start, top, is_admissible, may_go_on);
    choice.candidate = found.value_or(0);
    return found.has_value();
  }

  /// Chooses the fall; the trace receives the error it gives at each place, with a little room.
  /// Recorded without a limit: with that room on top, it is the limit of the second search, so that
  /// a step as good as the fall at each place may be taken.
  void fall(Forecast::Trace& trace) noexcept {
    plan.target = of.candidate_.front();
    choice.candidate = 0;
    choice.floor = true;
    choice.hold_s = plan.hold_s;
    choice.forecast = of.forecast_.run(path, outset, plan, limit_mm, false, nullptr, &trace);
    spent += count(choice.forecast.steps, output);
    for (std::size_t i = 0; i < trace.count; ++i) {
      double& error = trace.error_mm[i];
      error = error * kTraceRoom + kTraceRoomMm;
    }
  }

  const FeedGovernor& of;
  const LookAhead& path;
  const Outset& outset;
  Output& output;
  double limit_mm;
  double in_force;  ///< ratio of the step in force
  RatioPlan plan;
  Choice choice;
  std::size_t spent = 0;  ///< forecast steps
};

// Bounded by search_steps_: once they are spent, the largest step known to be admissible is taken,
// and the next decision starts from it.
FeedGovernor::Choice FeedGovernor::largest_admissible(const Outset& outset, std::size_t top,
                                                      Output& output) noexcept {
  Search search(*this, outset, output);
  if (!search.find(top, nullptr)) {
    // Not even the fall keeps the limit: the error it gives at each place is the best attainable.
    search.fall(trace_);
    search.find(top, &trace_);
  }
  return search.choice;
}

/// Continues the objective's search within its share of the cycle. The objective compares steps
/// that are held, not changes: start, target and floor are the same, and what the present step
/// leaves behind does not count. From there each is held until the next search's begins. For
/// contour priority errors up to `target_mm` are equal, so that it does not creep for a gain that
/// no gauge would show.
void FeedGovernor::look_for_objective(const Outset& outset, Output& output) noexcept {
  const LookAhead& path = state_.last.path_known ? ahead_ : guess_;
  const auto& contour = config_.contour;
  const bool by_contour = contour.strategy == ContourStrategy::contour_priority;
  const Forecast::Timing& timing = forecast_.timing();
  // A very slow axis settles only beyond the longest forecast; the second half of that counts.
  const double settled_s = std::min(timing.dead_s + timing.scan_s + kUnsettled * timing.settle_s,
                                    0.5 * static_cast<double>(Forecast::kMaxSteps) * timing.step_s);
  ObjectiveSearch& search = state_.objective;
  for (std::size_t spent = 0; !search.done() && spent < search_steps_;) {
    const std::size_t c = search.next();
    RatioPlan plan;
    plan.start = plan.target = plan.floor = candidate_[c];
    plan.hold_s = config_.objective_s;
    plan.judged_from_s = settled_s;
    const Forecast::Result result =
        forecast_.run(path, outset, plan, reserve_.limit_mm(), false, nullptr, nullptr);
    spent += count(result.steps, output);
    const double error = std::abs(result.error_mm);
    const Candidate candidate{candidate_[c],      error,
                              contour.limit_mm,   candidate_.front(),
                              candidate_.back(),  contour.weight_contour,
                              contour.weight_feed};
    if (by_contour) {
      search.tell(std::max(error, contour.target_mm), kTieMm);
    } else {
      search.tell(config_.objective(candidate), kTie);
    }
    if (search.done()) {
      state_.wanted_ratio = candidate_[search.best()];
    }
  }
}

/// The candidate that the strategy prefers: with feed priority the fastest.
std::size_t FeedGovernor::wanted_candidate(const Outset& outset, Output& output) noexcept {
  std::size_t candidate = candidate_.size() - 1;
  if (config_.contour.strategy == ContourStrategy::feed_priority) {
    return candidate;
  }
  if (state_.objective.done() && course_s() >= state_.next_objective_s) {
    state_.objective.begin(candidate_.size(), config_.exhaustive_steps);
    state_.next_objective_s = course_s() + config_.objective_s;
  }
  look_for_objective(outset, output);
  while (candidate > 0 && candidate_[candidate] > state_.wanted_ratio + kSameRatio) {
    --candidate;
  }
  return candidate;
}

/// The highest candidate up to `wanted` that the override can rise to within one decision. A higher
/// step would not take effect before the next decision, which will know more.
std::size_t FeedGovernor::reachable_candidate(std::size_t wanted) const noexcept {
  const double soon =
      state_.in_force_ratio + forecast_.timing().rise_1_s * decision_s_ + kSameRatio;
  std::size_t top = 0;
  while (top < wanted && candidate_[top] <= soon) {
    ++top;
  }
  return top;
}

// The strongest cause first: the one the operator can do least about.
Reason FeedGovernor::reason(const Choice& choice, bool no_effect, bool falls,
                            std::size_t wanted) const noexcept {
  if (choice.floor) {
    return Reason::contour_feed_floor;
  }
  if (no_effect) {
    return Reason::contour_no_effect;
  }
  if (!state_.last.path_known) {
    return Reason::contour_path_unknown;
  }
  if (choice.held_back) {
    return Reason::contour_hysteresis;
  }
  if (falls) {
    return Reason::contour_limit;
  }
  const bool by_objective = config_.contour.strategy != ContourStrategy::feed_priority;
  return by_objective && choice.candidate == wanted ? Reason::contour_objective
                                                    : Reason::contour_within_limit;
}

/// Slow offsets follow what cancels the error only where that leaves less of it than going to 0
/// does, over what a decision sees with the present step. Both are forecast from where the offsets
/// are.
void FeedGovernor::choose_offsets(Outset& outset, Output& output) noexcept {
  Outset tried = outset;
  tried.tool = state_.shadow.on ? outset.tool : precompensator_.tool();
  const bool act = state_.offsets_act || state_.shadow.on;
  if (precompensator_.acceleration_mm_s2() <= 0.0 || !act || !tried.tool) {
    return;
  }
  const double ratio = std::min(state_.in_force_ratio, outset.panel_ratio);
  const auto error = [&](bool follows) {
    tried.follows = follows;
    const Forecast::Squares squares = forecast_.squares(ahead_, tried, ratio, kOffsetSight_s);
    count(squares.steps, output);
    return squares;
  };
  const Forecast::Squares followed = error(true);
  const Forecast::Squares none = error(false);
  const double share = state_.offsets_follow ? 1.0 : kFollowAgain;
  state_.offsets_follow = followed.mean_mm2 <= share * none.mean_mm2 &&
                          followed.largest_mm2 <= share * none.largest_mm2;
  outset.follows = state_.offsets_follow;
}

// A decision starts from what the envelope let pass, preceded by what is still under way. Without a
// path the command's present circle takes its place, and no rise is derived from a speed that the
// override does not govern.
void FeedGovernor::decide(const Frame& frame, Output& output) noexcept {
  if (!state_.last.path_known) {
    extrapolate(frame);
    if (guess_.empty()) {
      output.request.ratio = state_.last.request.ratio;
      output.request.reason = Reason::contour_path_unknown;
      return;
    }
  }
  fill_pending(frame, forecast_);
  Outset from = outset(frame);
  choose_offsets(from, output);
  const std::size_t wish = wanted_candidate(from, output);
  const bool no_effect = state_.idle_effect_s > 0.1;
  Choice choice = largest_admissible(from, reachable_candidate(wish), output);
  const double before = state_.last.request.ratio;
  if (no_effect && !state_.last.path_known && candidate_[choice.candidate] > before) {
    // The override did not cause the present error, so it justifies no rise.
    while (choice.candidate > 0 && candidate_[choice.candidate] > before + kSameRatio) {
      --choice.candidate;
    }
  }
  state_.hold_s = choice.hold_s;
  output.decided = true;
  output.limit_mm = reserve_.limit_mm();
  output.predicted_error_mm = choice.forecast.error_mm;
  output.predicted_at_mm = choice.forecast.at_mm;
  output.step = table_step_[choice.candidate];
  const double ratio = candidate_[choice.candidate];
  // A fall is judged against what is in force and what was asked before: a wish still on its way at
  // the slew is no fall.
  const double in_force = forecast_.floor_ratio(state_.in_force_ratio);
  const bool falls = ratio < std::min(in_force, before) - kSameRatio;
  if (falls) {
    state_.fallen_s = course_s();
  }
  output.request.ratio = ratio;
  output.request.reason = reason(choice, no_effect, falls, wish);
}

}  // namespace steadyrest::contour::online
