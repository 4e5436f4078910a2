// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/round_score.hpp>

namespace steadyrest::contour::offline {
namespace {

ErrorFigures::Of figures(double rms_mm, double max_mm) {
  ErrorFigures::Of of;
  of.samples = 4;
  of.sum_mm2 = 4.0 * rms_mm * rms_mm;
  of.max_mm = max_mm;
  return of;
}

TEST(RoundScore, TheLargestErrorMayNotGrow) {
  const RoundScore score(1.02, 10.0, figures(0.1, 0.5), 0.01);
  EXPECT_LT(score.of_mm(figures(0.05, 0.3), 1.0, 10.0), score.of_mm(figures(0.05, 0.4), 1.0, 10.0));
  EXPECT_LT(score.of_mm(figures(0.09, 0.5), 1.0, 10.0),
            score.of_mm(figures(0.01, 0.51), 1.0, 10.0));
}

TEST(RoundScore, ABlockHasAPrice) {
  const RoundScore score(1.02, 10.0, figures(0.1, 0.5), 0.01);
  // Two more for each one of the original are worth 0.4 µm, and any number half a micrometre.
  EXPECT_LT(score.of_mm(figures(0.0119, 0.1), 3.0, 10.0),
            score.of_mm(figures(0.0124, 0.1), 1.0, 10.0));
  EXPECT_GT(score.of_mm(figures(0.0121, 0.1), 3.0, 10.0),
            score.of_mm(figures(0.0124, 0.1), 1.0, 10.0));
  EXPECT_LT(score.of_mm(figures(0.0119, 0.1), 90.0, 10.0),
            score.of_mm(figures(0.0125, 0.1), 1.0, 10.0));
  EXPECT_EQ(score.of_mm(figures(0.01, 0.1), 0.5, 10.0), score.of_mm(figures(0.01, 0.1), 1.0, 10.0));
}

TEST(RoundScore, TimeHasAPrice) {
  const RoundScore score(1.25, 10.0, figures(0.1, 0.5), 0.01);
  // A hundredth more is worth half a micrometre, and so is any; less time is worth nothing.
  EXPECT_LT(score.of_mm(figures(0.0119, 0.1), 1.0, 10.1),
            score.of_mm(figures(0.0125, 0.1), 1.0, 10.0));
  EXPECT_GT(score.of_mm(figures(0.0121, 0.1), 1.0, 10.1),
            score.of_mm(figures(0.0125, 0.1), 1.0, 10.0));
  EXPECT_LT(score.of_mm(figures(0.0119, 0.1), 1.0, 12.0),
            score.of_mm(figures(0.0125, 0.1), 1.0, 10.0));
  EXPECT_EQ(score.of_mm(figures(0.01, 0.1), 1.0, 9.0), score.of_mm(figures(0.01, 0.1), 1.0, 10.0));
}

TEST(RoundScore, MoreTimeIsAskedFor) {
  const RoundScore usual(1.02, 10.0, figures(0.1, 0.5), 0.01);
  EXPECT_TRUE(usual.in_time(10.2, false));
  EXPECT_FALSE(usual.in_time(10.2, true));
  EXPECT_TRUE(usual.in_time(10.04, true));
  const RoundScore more(1.25, 10.0, figures(0.1, 0.5), 0.01);
  EXPECT_TRUE(more.in_time(12.5, true));
  EXPECT_FALSE(more.in_time(12.6, false));
}

TEST(RoundScore, NamesTheBestOfTheSlowOnesWhereItWinsMuch) {
  RoundScore score(1.02, 10.0, figures(0.1, 0.5), 0.01);
  EXPECT_FALSE(score.slower(figures(0.1, 0.5)));
  score.note_slower(12.0, figures(0.04, 0.3));
  score.note_slower(11.0, figures(0.05, 0.2));
  score.note_slower(20.1, figures(0.01, 0.1));
  score.note_slower(13.0, figures(0.01, 0.6));
  const auto slower = score.slower(figures(0.1, 0.5));
  ASSERT_TRUE(slower);
  EXPECT_DOUBLE_EQ(slower->seconds, 12.0);
  EXPECT_FALSE(score.slower(figures(0.05, 0.5)));
}

}  // namespace
}  // namespace steadyrest::contour::offline
