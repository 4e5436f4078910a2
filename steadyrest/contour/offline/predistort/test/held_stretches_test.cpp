// SPDX-License-Identifier: Apache-2.0
// Of several runs each stretch between rapids takes the command that served it best.
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/hold/held_stretches.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kStretchLimit_mm = 0.01;

/// Two cuts of 10 mm with a rapid between them.
struct TwoCuts {
  nc::plan::PlannedPath path =
      test::planned_moves(test::ideal_mill(), "G0 X1\nG1 X11 F1200\nG0 Y5\nG1 X1\n");
  std::vector<SegmentUse> use;

  TwoCuts() {
    for (const auto& segment : path.segments) {
      use.push_back({.free = segment.motion == kernel::signal::Motion::feed});
    }
  }
  /// One piece for each cut; its feed tells which run it is of.
  [[nodiscard]] std::vector<Piece> pieces(double feed_mm_s) const {
    std::vector<Piece> out;
    for (std::size_t i = 0; i < use.size(); ++i) {
      if (use[i].free) {
        Piece& piece = out.emplace_back();
        piece.segment = path.segments[i];
        piece.segment.feed_mm_s = feed_mm_s;
        piece.progress_start_mm = piece.segment.position_mm;
        piece.progress_end_mm = piece.segment.position_mm + piece.segment.length_mm;
      }
    }
    return out;
  }
  /// A run with these errors in the middle of the cuts, mm.
  [[nodiscard]] FollowedRun run(double first_mm, double second_mm, bool over = false) const {
    const CutRuns runs(path, use);
    FollowedRun out{.seconds = 2.0,
                    .figures = ErrorFigures(kStretchLimit_mm, 0),
                    .speed = {},
                    .corner_mm = {},
                    .errors = {},
                    .over = {},
                    .starts = {},
                    .runs = RunErrors(runs, 0, {})};
    const auto made = pieces(1.0);
    for (const auto& [piece, error_mm] : {std::pair(made[0], first_mm), {made[1], second_mm}}) {
      const double at_mm = 0.5 * (piece.progress_start_mm + piece.progress_end_mm);
      out.errors.push_back(
          {.valid = true, .time_s = 0.0, .foot_mm = at_mm, .off_mm = {0.0, 0.0, error_mm}});
      if (over && error_mm > kStretchLimit_mm) {
        out.over.push_back({.foot_mm = at_mm, .progress_mm = at_mm, .error_mm = error_mm});
      }
    }
    return out;
  }
};

TEST(HeldStretches, EachTakesTheRunWithItsLeastErrors) {
  const TwoCuts cuts;
  HeldStretches held(cuts.path, cuts.use, kStretchLimit_mm, HeldStretches::Price::all_errors);
  held.note(cuts.pieces(1.0), cuts.run(0.001, 0.005), {}, HeldStretches::By::feeds);
  held.note(cuts.pieces(2.0), cuts.run(0.004, 0.002), {}, HeldStretches::By::feeds);
  const auto best = held.best();
  ASSERT_EQ(best.size(), 2U);
  EXPECT_EQ(best[0].segment.feed_mm_s, 1.0);
  EXPECT_EQ(best[1].segment.feed_mm_s, 2.0);
}

// What is below the limit costs nothing where it is to be held: both runs take the same time.
TEST(HeldStretches, WhereALimitIsToBeHeldOnlyWhatIsOverItCounts) {
  const TwoCuts cuts;
  HeldStretches held(cuts.path, cuts.use, kStretchLimit_mm);
  held.note(cuts.pieces(1.0), cuts.run(0.009, 0.011, true), {}, HeldStretches::By::feeds);
  held.note(cuts.pieces(2.0), cuts.run(0.001, 0.009, true), {}, HeldStretches::By::feeds);
  const auto best = held.best();
  ASSERT_EQ(best.size(), 2U);
  EXPECT_EQ(best[0].segment.feed_mm_s, 1.0);
  EXPECT_EQ(best[1].segment.feed_mm_s, 2.0);
}

TEST(HeldStretches, ARunThatHarmsSomeMachineIsTheLastChoice) {
  const TwoCuts cuts;
  HeldStretches held(cuts.path, cuts.use, kStretchLimit_mm, HeldStretches::Price::all_errors);
  const double there_mm =
      0.5 * (cuts.pieces(1.0)[0].progress_start_mm + cuts.pieces(1.0)[0].progress_end_mm);
  held.note(cuts.pieces(1.0), cuts.run(0.001, 0.001), {there_mm}, HeldStretches::By::feeds);
  held.note(cuts.pieces(2.0), cuts.run(0.009, 0.009), {}, HeldStretches::By::feeds);
  EXPECT_EQ(held.best()[0].segment.feed_mm_s, 2.0);
  EXPECT_EQ(held.best()[1].segment.feed_mm_s, 1.0);
}

}  // namespace
}  // namespace steadyrest::contour::offline
