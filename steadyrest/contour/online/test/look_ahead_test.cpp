// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/look_ahead.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/kernel/machine/unlimited.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::machine::kUnlimited;
using kernel::signal::Motion;
using math::geometry::test::number;
using test::kTurn;
using test::PathMaker;
using test::PathSegment;

/// X 1000, Y 2000, Z 4000 mm/s².
LookAhead unequal(double path_mm_s2 = kUnlimited) {
  std::vector<kernel::machine::Axis> axes(3);
  axes[0].max_acceleration_au_s2 = 1000.0;
  axes[1].max_acceleration_au_s2 = 2000.0;
  axes[2].max_acceleration_au_s2 = 4000.0;
  return {axes, path_mm_s2};
}

std::vector<Cell> cells_of(LookAhead& ahead, const std::vector<PathSegment>& path) {
  for (int i = 0; i < 200; ++i) {
    ahead.update(path, 0, 0.0, 0.0, path.back().position_mm + path.back().length_mm + 1.0);
  }
  std::vector<Cell> cells;
  for (std::size_t i = ahead.begin(); i < ahead.end(); ++i) {
    cells.push_back(ahead.cell(i));
  }
  return cells;
}

// By brute force from the law: a limit at s applies to every place before it, plus what braking on
// the way there can take off.
RC_GTEST_PROP(LookAheadSpeed, IsTheLeastOfAllLaterLimitsSeenThroughBraking, ()) {
  LookAhead ahead = unequal();
  const auto count = *rc::gen::inRange<std::size_t>(1, 40);
  std::vector<Cell> cell(count);
  std::vector<double> limit(count);
  double position_mm = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    cell[i].position_mm = position_mm;
    cell[i].length_mm = *number(0.01, 2.0);
    cell[i].cap_mm_s = *number(1.0, 100.0);
    cell[i].acceleration_mm_s2 = *number(100.0, 3000.0);
    position_mm += cell[i].length_mm;
    const double joint = *rc::gen::element(0.0, 5.0, 50.0, kUnlimited);
    limit[i] = std::min(joint, cell[i].cap_mm_s);
    ahead.append(cell[i], joint);
  }
  for (std::size_t i = 0; i < count; ++i) {
    double truth = kUnlimited;
    double braking = 0.0;
    for (std::size_t j = i; j < count; ++j) {
      truth = std::min(truth, limit[j] * limit[j] + braking);
      braking += 2.0 * cell[j].acceleration_mm_s2 * cell[j].length_mm;
    }
    RC_ASSERT(std::abs(ahead.cell(i).square_mm2_s2 - truth) <= 1e-9 * truth);
  }
  RC_ASSERT(std::abs(ahead.known_to_mm() - position_mm) <= 1e-12 * position_mm);
}

RC_GTEST_PROP(LookAheadFind, GivesTheCellThatHoldsThePlaceFromAnyHint, ()) {
  PathMaker maker({0, 0, 0}, 30.0);
  maker.line_to({7, 0, 0}).arc({7, 3, 0}, 2.0).chords({7, 3, 0}, 1.0, 0.3);
  LookAhead ahead = unequal();
  const auto cells = cells_of(ahead, maker.path());
  const double s_mm = *number(-1.0, 20.0);
  const auto hint = *rc::gen::inRange<std::size_t>(0, 2 * cells.size());
  const std::size_t found = ahead.find(s_mm, hint);
  std::size_t truth = 0;
  while (truth + 1 < cells.size() && cells[truth].position_mm + cells[truth].length_mm <= s_mm) {
    ++truth;
  }
  RC_ASSERT(found == truth);
}

// Along (3, 4, 0)/5: X allows 1000/0.6, Y 2000/0.8; the path's own limit may be less than both.
TEST(LookAheadAcceleration, OfALineIsThatOfTheAxisThatIsFirstAtItsLimit) {
  const auto on = [](double path_mm_s2, const kernel::signal::Point& end) {
    LookAhead ahead = unequal(path_mm_s2);
    const auto cells = cells_of(ahead, PathMaker({0, 0, 0}, 30.0).line_to(end).path());
    return cells.front().acceleration_mm_s2;
  };
  EXPECT_NEAR(on(kUnlimited, {3, 4, 0}), 1000.0 / 0.6, 1e-6);
  EXPECT_NEAR(on(kUnlimited, {0, -5, 0}), 2000.0, 1e-6);
  EXPECT_NEAR(on(2500.0, {0, 0, 5}), 2500.0, 1e-6);
  EXPECT_NEAR(on(kUnlimited, {0, 0, 5}), 4000.0, 1e-6);
}

// In the plane of Y and Z, Y allows 2000. At 30 mm/s the turn on 2 mm takes 30²/2 = 450, which
// leaves √(2000² − 450²) along the path. At any speed half is left: √(1 − 0.866²).
TEST(LookAheadAcceleration, OfAnArcIsWhatTheTurnLeavesOver) {
  const auto on = [](double feed_mm_s, double limit_mm_s) {
    auto path = PathMaker({0, 2, 0}, feed_mm_s).arc({0, 0, 0}, 1.0, {1, 0, 0}).path();
    path.front().speed_limit_mm_s = limit_mm_s;
    LookAhead ahead = unequal();
    return cells_of(ahead, path).front().acceleration_mm_s2;
  };
  EXPECT_NEAR(on(100.0, 30.0), std::sqrt(2000.0 * 2000.0 - 450.0 * 450.0), 1e-6);
  EXPECT_NEAR(on(15.0, kUnlimited), std::sqrt(2000.0 * 2000.0 - 450.0 * 450.0), 1e-6)
      << "no override exceeds twice the feed";
  EXPECT_NEAR(on(1000.0, kUnlimited), 1000.0, 0.1);
}

std::size_t chords_of(double step_mm, double turn_rad, const auto& change) {
  PathMaker maker({0, 0, 0}, 30.0);
  for (int i = 0; i < 100; ++i) {
    change(maker, i);
    maker.line_to(math::geometry::add(
        maker.at(), {step_mm * std::cos(turn_rad * i), step_mm * std::sin(turn_rad * i), 0.0}));
  }
  LookAhead ahead = unequal();
  return cells_of(ahead, maker.path()).size() - 1;  // without the stop
}

// Lines of 5 µm: twenty make a chord of 0.1 mm, unless one of them differs in motion or feed or the
// path has turned by more than 0.02 rad since the chord began.
TEST(LookAheadChords, JoinShortLinesOfOneMotionAndFeed) {
  const auto alike = [](PathMaker&, int) {};
  EXPECT_NEAR(static_cast<double>(chords_of(0.005, 0.0, alike)), 5.0, 1.0);
  EXPECT_EQ(chords_of(0.11, 0.0, alike), 100U) << "longer than a chord may be";
  EXPECT_EQ(chords_of(0.005, 0.03, alike), 100U) << "each turns too far";
  EXPECT_EQ(chords_of(0.005, 0.009, alike), 34U) << "two turns by 0.009 are within, three are not";
  const auto feeds = [](PathMaker& maker, int i) { maker.feed(i % 2 == 0 ? 30.0 : 31.0); };
  EXPECT_EQ(chords_of(0.005, 0.0, feeds), 100U);
  const auto motions = [](PathMaker& maker, int i) {
    maker.motion(i % 2 == 0 ? Motion::feed : Motion::rapid);
  };
  EXPECT_EQ(chords_of(0.005, 0.0, motions), 100U);
}

// Of twenty lines under one chord one may be slower, and so may a joint between two.
TEST(LookAheadChords, KeepTheStrictestLimitOfTheirLines) {
  for (const bool joint : {true, false}) {
    PathMaker maker({0, 0, 0}, 30.0);
    for (int i = 1; i <= 20; ++i) {
      maker.line_to({0.004 * i, 0, 0});
    }
    auto path = maker.path();
    (joint ? path[9].exit_speed_limit_mm_s : path[9].speed_limit_mm_s) = 2.0;
    LookAhead ahead = unequal();
    EXPECT_EQ(cells_of(ahead, path).front().cap_mm_s, 2.0) << joint;
  }
}

// A square with one rounded corner: the direction breaks at the sharp ones, not at the round one.
TEST(LookAheadCorner, IsWhereTheDirectionBreaks) {
  PathMaker maker({0, 0, 0}, 30.0);
  maker.line_to({10, 0, 0}).line_to({10, 8, 0}).arc({8, 8, 0}, test::kTurn / 4);
  maker.line_to({0, 10, 0}).line_to({0, 0, 0});
  LookAhead ahead = unequal();
  std::vector<double> corners;
  for (const Cell& cell : cells_of(ahead, maker.path())) {
    if (cell.corner) {
      corners.push_back(cell.position_mm);
    }
  }
  ASSERT_EQ(corners.size(), 2U);
  EXPECT_NEAR(corners[0], 10.0, 1e-9);
  EXPECT_NEAR(corners[1], 26.0 + test::kTurn / 2, 1e-9);
}

TEST(LookAheadStop, IsTheLastCellAndHasNoLengthAndNoSpeed) {
  LookAhead ahead = unequal();
  const auto path = PathMaker({0, 0, 0}, 30.0).line_to({5, 0, 0}).arc({5, 3, 0}, 1.0).path();
  const auto cells = cells_of(ahead, path);
  EXPECT_TRUE(ahead.complete());
  EXPECT_EQ(cells.back().length_mm, 0.0);
  EXPECT_EQ(cells.back().square_mm2_s2, 0.0);
  EXPECT_FALSE(cells.back().corner);
  EXPECT_LE(math::geometry::distance(cells.back().point_mm, path.back().end_mm), 1e-4);
  const Cell& last = cells[cells.size() - 2];
  EXPECT_NEAR(last.square_mm2_s2, 2.0 * last.acceleration_mm_s2 * last.length_mm, 1e-9);
}

// 10 000 lines of 0.2 mm: each cycle adds 48 cells at most, and what lies behind is dropped.
TEST(LookAheadRing, MovesAlongWithABoundedCycle) {
  PathMaker maker({0, 0, 0}, 30.0);
  for (int i = 1; i <= 10'000; ++i) {
    maker.line_to({0.2 * i, 0, 0});
  }
  LookAhead ahead = unequal();
  for (int cycle = 0; cycle < 2000; ++cycle) {
    const double at_mm = 0.9 * cycle;
    const std::size_t before = ahead.end();
    ahead.update(maker.path(), static_cast<std::size_t>(at_mm / 0.2), at_mm - 1.0, at_mm,
                 at_mm + 20.0);
    ASSERT_LE(ahead.end() - before, static_cast<std::size_t>(LookAhead::kCellsPerCycle));
    ASSERT_LE(ahead.cell(ahead.begin()).position_mm, std::max(0.0, at_mm - 1.0));
    ASSERT_LE(ahead.end() - ahead.begin(), 110U) << "what is behind is dropped";
    if (cycle > 5) {
      ASSERT_GE(ahead.known_to_mm(), at_mm + 20.0);
      ASSERT_LE(ahead.known_to_mm(), at_mm + 20.2 + 1e-9);
    }
  }
}

// The present cells belong to the storage that they were made from.
TEST(LookAheadRing, AnotherPathIsMadeAnew) {
  const auto first = PathMaker({0, 0, 0}, 30.0).line_to({50, 0, 0}).path();
  const auto second = PathMaker({0, 0, 0}, 30.0).line_to({0, 50, 0}).path();
  LookAhead ahead = unequal();
  ahead.update(first, 0, 0.0, 10.0, 30.0);
  ASSERT_EQ(ahead.cell(ahead.begin()).tangent[0], 1.0);
  ahead.update(second, 0, 0.0, 10.0, 30.0);
  EXPECT_EQ(ahead.cell(ahead.begin()).tangent[1], 1.0);
}

// Started in the middle of a program it goes back to where the foot may be, no further.
TEST(LookAheadRing, BeginsWhereTheFootMayLie) {
  PathMaker maker({0, 0, 0}, 30.0);
  for (int i = 1; i <= 100; ++i) {
    maker.line_to({1.0 * i, 0, 0});
  }
  LookAhead ahead = unequal();
  ahead.update(maker.path(), 50, 47.5, 50.5, 60.0);
  EXPECT_EQ(ahead.cell(ahead.begin()).position_mm, 47.0);
}

TEST(LookAheadRing, AStateThatDoesNotFitItsIndicesIsDropped) {
  const auto path = PathMaker({0, 0, 0}, 30.0).line_to({50, 0, 0}).arc({50, 9, 0}, 3.0).path();
  LookAhead ahead = unequal();
  ahead.update(path, 0, 0.0, 0.0, 60.0);
  auto state = ahead.state();
  LookAhead other = unequal();
  other.restore(state);
  ASSERT_EQ(other.known_to_mm(), ahead.known_to_mm());
  state.cell.pop_back();
  other.restore(state);
  EXPECT_TRUE(other.empty());
  state.cell.assign(LookAhead::kCells + 1, {});
  state.last = state.first + state.cell.size();
  other.restore(state);
  EXPECT_TRUE(other.empty());
}

// Taken up again within a long arc (a restart, another path): 20 turns of R = 10 mm are 1257 mm, a
// cycle makes 48 cells of 0.23 mm. The cells must be there at once, not from the arc's start on.
TEST(LookAhead, BeginsWithinALongArc) {
  LookAhead ahead = unequal();
  const auto path = PathMaker({10, 0, 0}, 60.0).arc({0, 0, 0}, 20.0 * kTurn).path();
  const double command_mm = 700.0;
  ahead.update(path, 0, command_mm - 2.0, command_mm, command_mm + 5.0);
  EXPECT_LE(ahead.cell(ahead.begin()).position_mm, command_mm - 2.0);
  EXPECT_GE(ahead.known_to_mm(), command_mm + 5.0);
  const Cell& cell = ahead.cell(ahead.find(command_mm, ahead.begin()));
  EXPECT_NEAR(std::hypot(cell.point_mm[0], cell.point_mm[1]), 10.0, 1e-9);
  EXPECT_NEAR(cell.point_mm[0], 10.0 * std::cos(cell.position_mm / 10.0), 1e-6);
}

}  // namespace
}  // namespace steadyrest::contour::online
