// SPDX-License-Identifier: Apache-2.0
// A rapid ends, and the axis runs out its lag into the cut. Truth: that axis, integrated in steps
// far below its time constant.
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/feeds/rapid_lag.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kTailGain_1_s = 40.0;

ModelSample tail_sample(double time_s, double lag_mm, double error_mm) {
  ModelSample sample;
  sample.time_s = time_s;
  sample.progress_mm = 100.0;
  sample.foot_mm = 100.0 - lag_mm;
  sample.error_mm = error_mm;
  return sample;
}

// The rapid ran along X with 5 mm of lag; the cut runs along Y, so what X is behind is all of the
// contour error.
TEST(RapidLag, ChargesTheFeedNothingOfTheTail) {
  RapidLag rapid(kTailGain_1_s);
  EXPECT_EQ(rapid.of_feed_mm(tail_sample(3.0, 5.0, 0.0), false), 0.0);
  constexpr double kStep_s = 1e-6;
  double behind_mm = 5.0;
  for (int i = 1; i <= 200'000; ++i) {
    behind_mm -= kStep_s * kTailGain_1_s * behind_mm;
    if (i % 20'000 == 0) {
      const double time_s = 3.0 + kStep_s * i;
      for (const double side : {1.0, -1.0}) {
        EXPECT_NEAR(rapid.of_feed_mm(tail_sample(time_s, 1.0, side * behind_mm), true), 0.0, 1e-4);
      }
    }
  }
}

TEST(RapidLag, ChargesTheFeedWhatIsOnTopOfTheTail) {
  RapidLag rapid(kTailGain_1_s);
  EXPECT_EQ(rapid.of_feed_mm(tail_sample(1.0, 5.0, 0.0), false), 0.0);
  // Half of the lag is left after ln 2/k = 17.33 ms.
  EXPECT_NEAR(rapid.of_feed_mm(tail_sample(1.01733, 1.0, 2.53), true), 0.03, 1e-3);
  // After twelve time constants nothing is.
  EXPECT_NEAR(rapid.of_feed_mm(tail_sample(1.3, 1.0, -0.02), true), 0.02, 1e-4);
}

TEST(RapidLag, OfARapidItselfNothingIsTheFeeds) {
  RapidLag rapid(kTailGain_1_s);
  EXPECT_EQ(rapid.of_feed_mm(tail_sample(1.0, 5.0, 0.7), false), 0.0);
  EXPECT_EQ(rapid.of_feed_mm(tail_sample(1.1, 5.0, -0.7), false), 0.0);
}

TEST(RapidLag, WithoutARapidAllOfTheErrorIsTheFeeds) {
  RapidLag rapid(kTailGain_1_s);
  EXPECT_DOUBLE_EQ(rapid.of_feed_mm(tail_sample(0.0, 2.0, -0.03), true), 0.03);
  EXPECT_DOUBLE_EQ(rapid.of_feed_mm(tail_sample(0.1, 2.0, 0.04), true), 0.04);
}

// A short rapid after a long one: its own lag counts, from its own end.
TEST(RapidLag, TheLastRapidCounts) {
  RapidLag rapid(kTailGain_1_s);
  EXPECT_EQ(rapid.of_feed_mm(tail_sample(1.0, 5.0, 0.0), false), 0.0);
  EXPECT_EQ(rapid.of_feed_mm(tail_sample(1.5, 1.0, 0.0), false), 0.0);
  EXPECT_NEAR(rapid.of_feed_mm(tail_sample(1.51733, 0.0, 0.53), true), 0.03, 1e-3);
}

}  // namespace
}  // namespace steadyrest::contour::offline
