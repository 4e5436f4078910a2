// SPDX-License-Identifier: Apache-2.0
// The choice from six places per step, against the choice from all of them.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/walk/schedule.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr double kWindow_s = 60.0;

/// Places of every kind in program order, some seconds apart.
std::vector<Place> random_places(double until_s) {
  std::vector<Place> places;
  double time_s = 0.0;
  for (std::uint32_t line = 1; time_s < until_s; ++line) {
    time_s += *rc::gen::inRange(1, 40);
    places.push_back({.line = line,
                      .site = *rc::gen::element(Site::rapid, Site::clearance, Site::feed),
                      .time_s = time_s});
  }
  return places;
}

/// Steps at least `gap_s` apart; `.5`, so that no two places are equally near.
AxisPlan random_plan(double until_s, int gap_s) {
  AxisPlan plan;
  for (double time_s = *rc::gen::inRange(0, 100); time_s < until_s;
       time_s += gap_s + *rc::gen::inRange(0, 200)) {
    plan.steps.push_back({.time_s = time_s + 0.25, .displacement_um = time_s});
  }
  return plan;
}

kernel::outcome::Result<std::vector<Chosen>> chosen(const AxisPlan& plan,
                                                    const std::vector<Place>& places) {
  Schedule schedule(plan, kWindow_s);
  for (const Place& place : places) {
    schedule.offer(place);
  }
  return schedule.choose();
}

bool in_window(const Place& place, const PlannedStep& step) {
  return std::abs(place.time_s - step.time_s) <= kWindow_s;
}

// With a place in every window a choice in order always exists: the earliest of each would do.
RC_GTEST_PROP(Schedule, RefusesOnlyWhereAWindowHoldsNoPlace, ()) {
  const auto places = random_places(600.0);
  const auto plan = random_plan(600.0, 5);
  const auto made = chosen(plan, places);
  const bool possible = std::ranges::all_of(plan.steps, [&](const PlannedStep& step) {
    return std::ranges::any_of(places, [&](const Place& p) { return in_window(p, step); });
  });
  RC_ASSERT(made.has_value() == possible);
}

// Each of the plan's steps once, in its window, none before its predecessor.
RC_GTEST_PROP(Schedule, KeepsTheWindowAndTheOrder, ()) {
  const auto plan = random_plan(600.0, 5);
  const auto made = chosen(plan, random_places(600.0));
  RC_PRE(made.has_value());
  RC_ASSERT(made->size() == plan.steps.size());
  std::uint32_t line = 0;
  for (std::size_t i = 0; i < made->size(); ++i) {
    RC_ASSERT((*made)[i].step.time_s == plan.steps[i].time_s);
    RC_ASSERT(in_window((*made)[i].place, plan.steps[i]));
    RC_ASSERT((*made)[i].place.line >= line);
    line = (*made)[i].place.line;
  }
}

// Steps more than two windows apart are independent: each takes the best kind, and of that the
// nearest.
RC_GTEST_PROP(Schedule, TakesTheBestKindAndOfItTheNearest, ()) {
  const auto places = random_places(1500.0);
  const auto plan = random_plan(1500.0, 130);
  const auto made = chosen(plan, places);
  RC_PRE(made.has_value());
  for (const Chosen& one : *made) {
    const auto better = [&](const Place& a, const Place& b) {
      return a.site != b.site
                 ? a.site < b.site
                 : std::abs(a.time_s - one.step.time_s) < std::abs(b.time_s - one.step.time_s);
    };
    std::optional<Place> best;
    for (const Place& place : places) {
      if (in_window(place, one.step) && (!best || better(place, *best))) {
        best = place;
      }
    }
    RC_ASSERT(best.has_value());
    RC_ASSERT(one.place.site == best->site);
    RC_ASSERT(one.place.time_s == best->time_s);
  }
}

// Both ends belong to the window.
TEST(Schedule, AWindowHoldsItsEnds) {
  AxisPlan plan;
  plan.steps = {{.time_s = 100.0, .displacement_um = 5.0}};
  const auto at = [&](double time_s) {
    return chosen(plan, {{.line = 1, .site = Site::feed, .time_s = time_s}}).has_value();
  };
  EXPECT_TRUE(at(40.0));
  EXPECT_TRUE(at(160.0));
  EXPECT_FALSE(at(39.9));
  EXPECT_FALSE(at(160.1));
  const auto refused = chosen(plan, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what,
            "no safe place for the correction of Z planned at 100.0 s within 60 s of it");
}

// The first step's best place lies after all of the second's: both act there.
TEST(Schedule, TwoStepsMayShareAPlace) {
  AxisPlan plan;
  plan.steps = {{.time_s = 100.0, .displacement_um = 5.0},
                {.time_s = 110.0, .displacement_um = 9.0}};
  const auto made = chosen(plan, {{.line = 4, .site = Site::feed, .time_s = 105.0},
                                  {.line = 9, .site = Site::rapid, .time_s = 150.0}});
  ASSERT_TRUE(made);
  EXPECT_EQ((*made)[0].place.line, 9U);
  EXPECT_EQ((*made)[1].place.line, 9U);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
