// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/walk/schedule.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::refuse;
using kernel::outcome::Result;

Schedule::Schedule(AxisPlan plan, double window_s)
    : plan_(std::move(plan)), window_s_(window_s), near_(plan_.steps.size()) {}

// Six places per step are enough: for each kind the nearest before and the nearest after the
// planned instant. Whether one may be used depends on the previous step, known only at the end.
void Schedule::offer(const Place& place) {
  // Steps whose window has passed take no more places, so the loop below stays short.
  while (first_ < near_.size() && plan_.steps[first_].time_s + window_s_ < place.time_s) {
    ++first_;
  }
  // Site::none is 0 and is never offered.
  const auto site = static_cast<std::size_t>(place.site) - 1;
  for (std::size_t i = first_;
       i < near_.size() && plan_.steps[i].time_s - window_s_ <= place.time_s; ++i) {
    Nearest& nearest = near_[i][site];
    // Places come in order of time: the nearest are the last before the instant and the first after
    // it.
    if (place.time_s <= plan_.steps[i].time_s) {
      nearest.before = place;
    } else if (!nearest.behind) {
      nearest.behind = place;
    }
  }
}

std::optional<Place> Schedule::best(std::size_t step, std::uint32_t first_line) const {
  const double wanted_s = plan_.steps[step].time_s;
  // By kind first: rapid, clearance, feed. A shift in the cut leaves a mark.
  for (const Nearest& nearest : near_[step]) {
    std::optional<Place> found;
    for (const auto& place : {nearest.before, nearest.behind}) {
      if (place && place->line >= first_line &&
          (!found || std::abs(place->time_s - wanted_s) < std::abs(found->time_s - wanted_s))) {
        found = place;
      }
    }
    if (found) {
      return found;
    }
  }
  return {};
}

Result<std::vector<Chosen>> Schedule::choose() const {
  std::vector<Chosen> chosen;
  for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
    const PlannedStep& step = plan_.steps[i];
    // Never before the last chosen one, since the plan's steps act in order; two may share a place.
    auto place = best(i, chosen.empty() ? 0 : chosen.back().place.line);
    // The place chosen for the previous step may lie after all of this step's own: then both act
    // there, if the window allows.
    if (!place && !chosen.empty() &&
        std::abs(chosen.back().place.time_s - step.time_s) <= window_s_) {
      place = chosen.back().place;
    }
    if (!place) {
      return refuse(
          fmt::format(
              "no safe place for the correction of {} planned at {:.1f} s within {:g} s of it",
              plan_.letter, step.time_s, window_s_),
          "widen --window-s, or add a retract with an absolute G0 there");
    }
    chosen.push_back({*place, step});
  }
  return chosen;
}

}  // namespace steadyrest::nc::rewrite
