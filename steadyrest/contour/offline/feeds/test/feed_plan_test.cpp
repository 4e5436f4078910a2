// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/contour/offline/feeds/feed_plan.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>
#include <steadyrest/math/geometry/segment.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Machine;
using nc::plan::PlannedPath;
using test::ideal_mill;
using test::planned_moves;

constexpr double kFastFeed_mm_s = 4000.0 / 60.0;

/// A plan, and a run of the path with its feeds.
struct PlannedFeeds {
  FeedPlan plan;
  std::vector<FeedPart> parts;
};
PlannedFeeds feed_plan_of(const Machine& machine, const PlannedPath& path, double limit_mm,
                          FeedRoom room = {}) {
  const PathMap map = same_path(path);
  auto plan = FeedPlan::make({.machine = machine,
                              .path = path,
                              .original = path,
                              .map = map,
                              .model = servo_models(machine.axes),
                              .room = std::move(room),
                              .limit_mm = limit_mm,
                              .start = {}})
                  .value();
  auto parts = plan.parts();
  return {std::move(plan), std::move(parts)};
}

/// The path with the feeds of the parts, each a segment; the largest error of a cut on it.
double error_at_feeds(const Machine& machine, const PlannedPath& path,
                      const std::vector<FeedPart>& parts) {
  PlannedPath slower;
  auto part = parts.begin();
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    for (const auto& event : path.events) {
      if (event.segment == i) {
        slower.events.push_back(event);
        slower.events.back().segment = slower.segments.size();
      }
    }
    double from = 0.0;
    do {
      const bool open = part != parts.end() && part->segment == i;
      const double to = open ? part->to_mm : path.segments[i].length_mm;
      slower.segments.push_back(math::geometry::part_of(path.segments[i], from, to));
      slower.plans.push_back(path.plans[i]);
      nc::plan::SegmentPlan& plan = slower.plans.back();
      plan.length_mm = to - from;
      plan.feed_mm_s *= open ? part->ratio : 1.0;
      if (to < path.segments[i].length_mm) {
        plan.exit_speed_limit_mm_s = plan.speed_limit_mm_s;
      }
      part += open ? 1 : 0;
      from = to;
    } while (from < path.segments[i].length_mm);
  }
  double worst = 0.0;
  const PathMap map = same_path(slower);
  const auto run = run_model({machine, slower, slower, map, servo_models(machine.axes), {}},
                             [&](const ModelSample& s) {
                               worst = s.cuts ? std::max(worst, std::abs(s.error_mm)) : worst;
                             });
  EXPECT_TRUE(run.has_value());
  return worst;
}

// Inside the arc, where it no longer feels its beginning.
TEST(FeedPlan, TakesTheSpeedOfTheClosedFormOnACircle) {
  for (const double radius : {3.0, 10.0, 40.0}) {
    for (const double limit : {0.005, 0.02}) {
      const Machine machine = ideal_mill();
      const std::string r = std::to_string(radius);
      const PlannedPath path =
          planned_moves(machine, "G0 X" + r + " Y0\nG3 X" + r + " Y0 I-" + r + " J0 P5 F4000\n");
      const PlannedFeeds found = feed_plan_of(machine, path, limit);
      const double most = circle_limit({.gain_1_s = 50.0}, radius, limit).value().speed_mm_s;
      const auto longest = std::ranges::max_element(
          found.parts, {}, [](const FeedPart& p) { return p.to_mm - p.from_mm; });
      EXPECT_NEAR(longest->ratio * kFastFeed_mm_s, std::min(most, kFastFeed_mm_s),
                  0.01 * std::min(most, kFastFeed_mm_s))
          << "R " << radius << " limit " << limit;
      // Few feeds: the arc, its beginning, its end.
      EXPECT_LE(found.parts.size(), 6U);
    }
  }
}

TEST(FeedPlan, KeepsTheLimitWhereLinesMeetArcs) {
  const Machine machine = ideal_mill();
  const PlannedPath path = planned_moves(
      machine, "G0 X0 Y0\nG1 X40 F4000\nG3 X43 Y3 I0 J3\nG1 Y20\nG2 X53 Y30 I10 J0\nG1 X90\n");
  constexpr double kLimit_mm = 0.010;
  const PlannedFeeds found = feed_plan_of(machine, path, kLimit_mm);
  EXPECT_LE(error_at_feeds(machine, path, found.parts), 1.01 * kLimit_mm);
  // Long lines run at the programmed feed, and the arcs at no more than their closed form.
  EXPECT_TRUE(std::ranges::any_of(found.parts, [](const FeedPart& p) { return p.ratio == 1.0; }));
  const double all_slow = path.plans.back().length_mm;
  EXPECT_GT(all_slow, 0.0);
  const double most = circle_limit({.gain_1_s = 50.0}, 3.0, kLimit_mm).value().speed_mm_s;
  // Slower than everywhere as slow as the tightest arc would be a poor plan.
  const double length = path.segments.back().position_mm + path.segments.back().length_mm;
  EXPECT_LT(found.plan.seconds(), 0.7 * length / most);
  EXPECT_GT(found.plan.seconds(), found.plan.seconds_before());
}

TEST(FeedPlan, IsTheProgramWhereItKeepsTheLimit) {
  const Machine machine = ideal_mill();
  const PlannedPath path = planned_moves(machine, "G0 X0 Y0\nG1 X40 F4000\nX80\n");
  const PlannedFeeds found = feed_plan_of(machine, path, 0.010);
  EXPECT_TRUE(found.plan.unchanged());
  EXPECT_TRUE(std::ranges::all_of(found.parts, [](const FeedPart& p) { return p.ratio == 1.0; }));
}

// A right angle passed at v misses by about v/(k·e); no feed above nothing keeps a tenth of that.
TEST(FeedPlan, TakesTheLowestFeedWhereNoneKeepsTheLimit) {
  const Machine machine = ideal_mill();
  const PlannedPath path = planned_moves(machine, "G0 X0 Y0\nG1 X40 F4000\nY40\n");
  const PlannedFeeds found = feed_plan_of(machine, path, 0.002);
  const auto slowest = std::ranges::min_element(found.parts, {}, &FeedPart::ratio);
  EXPECT_DOUBLE_EQ(slowest->ratio, 0.1);
  EXPECT_TRUE(std::ranges::all_of(
      found.parts, [](const FeedPart& p) { return p.ratio >= 0.1 && p.ratio <= 1.0; }));
  EXPECT_GT(error_at_feeds(machine, path, found.parts), 0.002);
}

TEST(FeedPlan, LeavesFixedSegmentsAndDividesNoWholeOnes) {
  const Machine machine = ideal_mill();
  const PlannedPath path = planned_moves(
      machine, "G0 X10 Y0\nG3 X-10 Y0 I-10 J0 F4000\nG3 X10 Y0 I10 J0\nG3 X-10 I-10 J0\n");
  const PlannedFeeds found = feed_plan_of(
      machine, path, 0.010,
      {.kind = {FeedKind::free, FeedKind::fixed, FeedKind::whole, FeedKind::free}, .ends_mm = {}});
  EXPECT_EQ(std::ranges::count(found.parts, 1U, &FeedPart::segment), 0);
  EXPECT_EQ(std::ranges::count(found.parts, 2U, &FeedPart::segment), 1);
  EXPECT_GE(std::ranges::count(found.parts, 3U, &FeedPart::segment), 1);
}

// The plunge begins while the tool still comes from the rapid; a slower plunge is no remedy.
TEST(FeedPlan, DoesNotSlowACutForWhatARapidLeaves) {
  const Machine machine = ideal_mill(20.0);
  const PlannedPath path = planned_moves(machine, "G0 X50 Y0 Z1\nG1 Z-2 F300\n");
  const PlannedFeeds found = feed_plan_of(machine, path, 0.010);
  EXPECT_TRUE(std::ranges::all_of(found.parts, [](const FeedPart& p) { return p.ratio == 1.0; }));
}

TEST(FeedPlan, SearchesAgainWithATighterLimit) {
  const Machine machine = ideal_mill();
  const PlannedPath path =
      planned_moves(machine, "G0 X10 Y-20\nG4 P0.5\nG1 Y0 F4000\nG3 X10 Y0 I-10 J0 P3\nG1 Y20\n");
  PlannedFeeds found = feed_plan_of(machine, path, 0.010);
  const double before = found.plan.seconds();
  ASSERT_TRUE(found.plan.tighten({{1, 0.005}, {2, 0.005}, {3, 0.005}}).has_value());
  EXPECT_GT(found.plan.seconds(), 1.2 * before);
  EXPECT_LE(error_at_feeds(machine, path, found.plan.parts()), 1.01 * 0.005);
}

TEST(FeedPlan, RefusesLimitsOutOfRange) {
  const Machine machine = ideal_mill();
  const PlannedPath path = planned_moves(machine, "G0 X0 Y0\nG1 X40 F4000\n");
  const PathMap map = same_path(path);
  const auto refused = [&](double limit_mm, double floor_ratio) {
    return !FeedPlan::make({.machine = machine,
                            .path = path,
                            .original = path,
                            .map = map,
                            .model = servo_models(machine.axes),
                            .room = {},
                            .limit_mm = limit_mm,
                            .start = {},
                            .floor_ratio = floor_ratio})
                .has_value();
  };
  EXPECT_TRUE(refused(0.0, 0.1));
  EXPECT_TRUE(refused(std::nan(""), 0.1));
  EXPECT_TRUE(refused(0.01, 0.0));
  EXPECT_TRUE(refused(0.01, 1.1));
  EXPECT_FALSE(refused(0.01, 1.0));
}

TEST(FeedCells, AreThePathInPieces) {
  const Machine machine = ideal_mill();
  const PlannedPath path =
      planned_moves(machine, "G0 X10 Y0\nG3 X0 Y10 Z4 I-10 J0 F4000\nG1 X-30\nG0 X0\n");
  const FeedCells cells = feed_cells(path, same_path(path), {.kind = {}, .ends_mm = {}});
  ASSERT_EQ(cells.of.size(), cells.path.segments.size());
  for (std::size_t i = 1; i < cells.of.size(); ++i) {
    const auto& before = cells.path.segments[i - 1];
    const auto& here = cells.path.segments[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(here.start_mm[axis], before.end_mm[axis], 1e-9);
    }
    EXPECT_NEAR(here.position_mm, before.position_mm + before.length_mm, 1e-9);
    EXPECT_LE(cells.kind[i] == FeedKind::free ? here.length_mm : 0.0, 0.25 + 1e-9);
  }
  EXPECT_NEAR(cells.path.segments.back().position_mm, path.segments.back().position_mm, 1e-9);
}

TEST(FeedCells, AreLongerWhereThereWouldBeTooMany) {
  const Machine machine = ideal_mill();
  const PlannedPath path = planned_moves(machine, "G0 X0 Y0\nG1 X400 F4000\n");
  const FeedCells cells =
      feed_cells(path, same_path(path), {.kind = {}, .ends_mm = {}, .most_cells = 100});
  EXPECT_LE(cells.of.size(), 102U);
  EXPECT_GE(cells.of.size(), 80U);
}

}  // namespace
}  // namespace steadyrest::contour::offline
