// SPDX-License-Identifier: Apache-2.0
// A path in cells is the same path: same length, same ends, same limits at the joints that it had.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/feeds/feed_cells.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Motion;
using online::test::PathMaker;

constexpr double kCellFeed_mm_s = 15.0;
constexpr double kCorner_mm_s = 3.0;

nc::plan::PlannedPath part_path() {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({0, 0, 0}, kCellFeed_mm_s)
                      .motion(Motion::rapid)
                      .line_to({5, 0, 0})
                      .motion(Motion::feed)
                      .line_to({25, 0, 0})
                      .arc({25, 10, 0}, 1.5)
                      .line_to({60, 40, 0})
                      .limited(500.0, kCorner_mm_s);
  for (const auto& segment : path.segments) {
    nc::plan::SegmentPlan plan;
    plan.length_mm = segment.length_mm;
    plan.feed_mm_s = kCellFeed_mm_s;
    plan.rapid = segment.motion == Motion::rapid;
    plan.speed_limit_mm_s = segment.speed_limit_mm_s;
    plan.exit_speed_limit_mm_s = segment.exit_speed_limit_mm_s;
    path.plans.push_back(plan);
  }
  return path;
}

PathMap own_map(const nc::plan::PlannedPath& path) {
  PathMap map;
  for (const auto& segment : path.segments) {
    map.start_mm.push_back(segment.position_mm);
    map.end_mm.push_back(segment.position_mm + segment.length_mm);
  }
  return map;
}

TEST(FeedCellsOfAPath, AreThePathInShortPieces) {
  const auto path = part_path();
  for (const double station : {0.1, 0.25, 1.0, 7.0}) {
    const FeedCells cells =
        feed_cells(path, own_map(path), {.kind = {}, .ends_mm = {}, .station_mm = station});
    double total = 0.0;
    for (std::size_t i = 0; i < cells.of.size(); ++i) {
      const auto& cell = cells.path.segments[i];
      const auto& whole = path.segments[cells.of[i]];
      EXPECT_NEAR(cell.position_mm, whole.position_mm + cells.from_mm[i], 1e-9);
      EXPECT_NEAR(cell.position_mm, total, 1e-9);
      EXPECT_NEAR(cells.map.start_mm[i], total, 1e-9);
      total += cell.length_mm;
      EXPECT_NEAR(cells.map.end_mm[i], total, 1e-9);
      EXPECT_NEAR(cells.path.plans[i].length_mm, cell.length_mm, 1e-12);
      if (cells.kind[i] == FeedKind::free) {
        EXPECT_LE(cell.length_mm, station + 1e-9);
      }
      // Each begins where the one before ended, on the segment that it is part of.
      const double u = geometry::parameter_at(whole, cells.from_mm[i]);
      EXPECT_LT(geometry::distance(geometry::point_at(cell, 0.0), geometry::point_at(whole, u)),
                1e-9);
    }
    const auto& last = path.segments.back();
    EXPECT_NEAR(total, last.position_mm + last.length_mm, 1e-9);
  }
}

TEST(FeedCellsOfAPath, KeepTheLimitsOfJointsAndAddNone) {
  const auto path = part_path();
  const FeedCells cells = feed_cells(path, own_map(path), {});
  for (std::size_t i = 0; i < cells.of.size(); ++i) {
    const bool last = i + 1 == cells.of.size() || cells.of[i + 1] != cells.of[i];
    const auto& plan = path.plans[cells.of[i]];
    const auto& cell = cells.path.plans[i];
    EXPECT_EQ(cell.exit_speed_limit_mm_s,
              last ? plan.exit_speed_limit_mm_s : plan.speed_limit_mm_s);
    EXPECT_EQ(cell.speed_limit_mm_s, plan.speed_limit_mm_s);
    EXPECT_EQ(cells.ceiling[i], plan.feed_mm_s);
  }
}

TEST(FeedCellsOfAPath, LeaveRapidsAndWholeSegmentsUndivided) {
  const auto path = part_path();
  const FeedRoom room{.kind = {FeedKind::free, FeedKind::free, FeedKind::whole, FeedKind::joined},
                      .ends_mm = {}};
  const FeedCells cells = feed_cells(path, own_map(path), room);
  EXPECT_EQ(cells.kind.front(), FeedKind::fixed);  // the rapid, whatever was asked
  for (const std::uint32_t segment : {0U, 2U, 3U}) {
    EXPECT_EQ(std::ranges::count(cells.of, segment), 1) << segment;
  }
  EXPECT_EQ(std::ranges::count(cells.of, 1U), 80);
}

TEST(FeedCellsOfAPath, AreLongerWhereTheyWouldBeTooMany) {
  const auto path = part_path();
  const FeedCells cells = feed_cells(
      path, own_map(path), {.kind = {}, .ends_mm = {}, .station_mm = 0.001, .most_cells = 200});
  EXPECT_LE(cells.of.size(), 200U + path.segments.size());
  EXPECT_GT(cells.of.size(), 150U);
}

TEST(FeedCellsOfAPath, KeepTheEndsThatABlockNeeds) {
  const auto path = part_path();
  FeedRoom room;
  room.ends_mm.assign(path.segments.size(), {2.0F, 3.0F});
  const FeedCells cells = feed_cells(path, own_map(path), room);
  const auto first = static_cast<std::size_t>(std::ranges::find(cells.of, 1U) - cells.of.begin());
  const auto count = static_cast<std::size_t>(std::ranges::count(cells.of, 1U));
  EXPECT_NEAR(cells.path.segments[first].length_mm, 2.0, 1e-6);
  EXPECT_NEAR(cells.path.segments[first + count - 1].length_mm, 3.0, 1e-6);
}

TEST(FeedCellsOfAPath, EventsStayBeforeTheirSegment) {
  auto path = part_path();
  path.events.push_back({.segment = 2});
  path.events.push_back({.segment = path.segments.size()});
  const FeedCells cells = feed_cells(path, own_map(path), {});
  ASSERT_EQ(cells.path.events.size(), 2U);
  const std::size_t at = cells.path.events[0].segment;
  EXPECT_EQ(cells.of[at], 2U);
  EXPECT_EQ(cells.of[at - 1], 1U);
  EXPECT_EQ(cells.path.events[1].segment, cells.path.segments.size());
}

}  // namespace
}  // namespace steadyrest::contour::offline
