// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/step_search.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// Which step: the search over the table.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::machine::ContourStrategy;
using kernel::outcome::Reason;
using kernel::signal::Frame;
using kernel::signal::Point;

constexpr double kRiseRoom = 0.98;  // share of the limit that a rise may use
constexpr double kRiseRoomInPause = 0.85;
constexpr double kTieMm = 1e-4;       // errors closer than this are equal
constexpr double kTie = 1e-9;         // other objectives
constexpr double kStretchTurn = 0.1;  // rad by which an even stretch may depart from its mean
constexpr double kTraceRoom = 1.02;
constexpr double kTraceRoomMm = 2e-4;

/// Adds a forecast to what the decision took; its steps.
std::size_t count(const Forecast::Result& result, FeedGovernor::Output& output) noexcept {
  ++output.forecasts;
  output.forecast_steps += static_cast<std::uint32_t>(result.steps);
  return result.steps;
}

}  // namespace

/// Where the turning of the path departs from its mean between foot and command.
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
  const double length = here.position_mm - begin;
  const double rate = length > 0.0 ? turned / length : geometry::norm(here.curvature_1_mm);
  const double end = outset.position_mm + config_.pause_s * std::max(here.feed_mm_s, 1.0);
  for (std::size_t i = outset.command_cell; i + 1 < path.end(); ++i) {
    const Cell& cell = path.cell(i);
    const double expected = rate * (cell.position_mm - begin);
    if (!cell.cutting || std::abs(turned - expected) > kStretchTurn * (1.0 + expected)) {
      return cell.position_mm;
    }
    if (cell.position_mm > end) {
      break;
    }
    turned += turn_into(i);
  }
  return end;
}

FeedGovernor::Choice FeedGovernor::largest_admissible(const Outset& outset, std::size_t top,
                                                      Output& output) noexcept {
  const LookAhead& path = state_.last.path_known ? ahead_ : guess_;
  const double limit = limit_mm();
  const double in_force = forecast_.floor_ratio(state_.envelope_ratio);
  const double room =
      state_.time_s - state_.fallen_s < config_.pause_s ? kRiseRoomInPause : kRiseRoom;
  RatioPlan plan;
  plan.start = state_.envelope_ratio;
  plan.floor = candidate_.front();
  plan.hold_s = decision_s_;
  Choice choice;
  std::size_t spent = 0;
  const auto may_go_on = [&] { return spent < search_steps_; };
  const auto forecast = [&](const RatioPlan& of, double most_mm, const Forecast::Trace* trace) {
    const Forecast::Result result = forecast_.run(path, outset, of, most_mm, true, trace, nullptr);
    spent += count(result, output);
    return result;
  };
  const auto search = [&](const Forecast::Trace* trace) {
    const auto admissible = [&](std::size_t c) {
      plan.target = candidate_[c];
      const Forecast::Result result = forecast(plan, limit, trace);
      if (!result.kept) {
        return false;
      }
      const bool rises = candidate_[c] > in_force + kSameRatio;
      if (rises && trace == nullptr) {
        RatioPlan lasting = plan;
        lasting.hold_s = config_.pause_s;
        const Forecast::Result held = forecast(lasting, room * limit, nullptr);
        const bool lasts = held.kept || held.broken_mm >= stretch_end_mm(path, outset);
        if (std::abs(result.error_mm) > room * limit || !lasts) {
          choice.held_back = choice.held_back || lasts;
          return false;
        }
      }
      choice.forecast = result;  // the last one that is admissible is the largest
      return true;
    };
    const auto above = std::ranges::upper_bound(candidate_, in_force + kSameRatio);
    const auto start =
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - candidate_.begin() - 1, 0));
    // What the fall alone gives is no bound that slower steps keep too: all of them must be tried.
    const bool all = trace != nullptr || candidate_.size() <= config_.exhaustive_steps;
    const auto found = all ? first_admissible_below(top, admissible, may_go_on)
                           : largest_admissible_near(start, top, admissible, may_go_on);
    choice.candidate = found.value_or(0);
    return found.has_value();
  };
  if (search(nullptr)) {
    return choice;
  }
  // Not even the fall keeps the limit: what it gives at each place is what can be had.
  plan.target = candidate_.front();
  choice.candidate = 0;
  choice.floor = true;
  choice.forecast = forecast_.run(path, outset, plan, limit, false, nullptr, &trace_);
  spent += count(choice.forecast, output);
  for (std::size_t i = 0; i < trace_.count; ++i) {
    double& error = trace_.error_mm[i];
    error = error * kTraceRoom + kTraceRoomMm;
  }
  search(&trace_);
  return choice;
}

/// Goes on with the objective's search as far as its share of the cycle goes.
void FeedGovernor::look_for_objective(const Outset& outset, Output& output) noexcept {
  const LookAhead& path = state_.last.path_known ? ahead_ : guess_;
  const auto& contour = config_.machine.contour;
  const bool by_contour = contour.strategy == ContourStrategy::contour_priority;
  ObjectiveSearch& search = state_.objective;
  for (std::size_t spent = 0; !search.done() && spent < search_steps_;) {
    const std::size_t c = search.next();
    RatioPlan plan;
    plan.start = plan.target = plan.floor = candidate_[c];
    const Forecast::Result result =
        forecast_.run(path, outset, plan, limit_mm(), false, nullptr, nullptr);
    spent += count(result, output);
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

void FeedGovernor::decide(const Frame& frame, Output& output) noexcept {
  const auto& contour = config_.machine.contour;
  if (!state_.last.path_known) {
    extrapolate(frame);
    if (guess_.empty()) {
      output.request.ratio = state_.last.request.ratio;
      output.request.reason = Reason::contour_path_unknown;
      return;
    }
  }
  fill_pending(frame);
  const Outset from = outset(frame);
  std::size_t wanted = candidate_.size() - 1;
  if (contour.strategy != ContourStrategy::feed_priority) {
    if (state_.objective.done() && state_.time_s >= state_.next_objective_s) {
      state_.objective.begin(candidate_.size(), config_.exhaustive_steps);
      state_.next_objective_s = state_.time_s + config_.objective_s;
    }
    look_for_objective(from, output);
    while (wanted > 0 && candidate_[wanted] > state_.wanted_ratio + kSameRatio) {
      --wanted;
    }
  }
  const double soon =
      state_.envelope_ratio + forecast_.timing().rise_1_s * decision_s_ + kSameRatio;
  std::size_t top = 0;
  while (top < wanted && candidate_[top] <= soon) {
    ++top;
  }
  const bool no_effect = state_.idle_effect_s > 0.1;
  Choice choice = largest_admissible(from, top, output);
  const double before = state_.last.request.ratio;
  if (no_effect && !state_.last.path_known && candidate_[choice.candidate] > before) {
    // The error seen is not the override's doing; nothing may be concluded from it upwards.
    while (choice.candidate > 0 && candidate_[choice.candidate] > before + kSameRatio) {
      --choice.candidate;
    }
  }
  output.decided = true;
  output.limit_mm = limit_mm();
  output.predicted_error_mm = choice.forecast.error_mm;
  output.predicted_at_mm = choice.forecast.at_mm;
  output.step = table_step_[choice.candidate];
  const double ratio = candidate_[choice.candidate];
  const double in_force = forecast_.floor_ratio(state_.envelope_ratio);
  const bool falls = ratio < std::min(in_force, before) - kSameRatio;
  if (falls) {
    state_.fallen_s = state_.time_s;
  }
  output.request.ratio = ratio;
  if (choice.floor) {
    output.request.reason = Reason::contour_feed_floor;
  } else if (no_effect) {
    output.request.reason = Reason::contour_no_effect;
  } else if (!state_.last.path_known) {
    output.request.reason = Reason::contour_path_unknown;
  } else if (choice.held_back) {
    output.request.reason = Reason::contour_hysteresis;
  } else if (falls) {
    output.request.reason = Reason::contour_limit;
  } else if (contour.strategy != ContourStrategy::feed_priority && choice.candidate == wanted) {
    output.request.reason = Reason::contour_objective;
  } else {
    output.request.reason = Reason::contour_within_limit;
  }
}

}  // namespace steadyrest::contour::online
