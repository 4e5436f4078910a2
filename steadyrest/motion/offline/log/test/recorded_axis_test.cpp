// SPDX-License-Identifier: Apache-2.0
// The fine counts are polynomials with whole coefficients, so edges and derivatives are known by
// hand. A coarse count of 1 µm has 64 fine ones; rows are a millisecond apart.
#include <functional>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/log/recorded_axis.hpp>

namespace steadyrest::motion::offline {
namespace {

constexpr double kFine_mm = 0.001 / 64.0;

EdgeLog fine_log(int rows, const std::function<std::int64_t(int)>& count) {
  EdgeLog log;
  log.file = "axis.csv.gz";
  for (int k = 0; k < rows; ++k) {
    log.rows.push_back({1e-3 * k, count(k)});
  }
  return log;
}

// Fine count c lies in the middle of c − ½ … c + ½, so line L is passed at 64·L − ½.
TEST(RecordedAxisByHand, AnEdgeIsWhereTheLineIsCrossed) {
  const RecordedAxis axis = recorded_axis(fine_log(100, [](int k) { return 10 * k - 300; }));
  const auto& edges = axis.record.edges;
  ASSERT_EQ(edges.size(), 15U);  // from −300 to 690: lines −4 to 10
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto line = static_cast<double>(i) - 4.0;
    EXPECT_EQ(edges[i].line, static_cast<std::int64_t>(i) - 4);
    EXPECT_EQ(edges[i].direction, 1);
    EXPECT_NEAR(edges[i].t_s, (64.0 * line - 0.5 + 300.0) / 10.0 * 1e-3, 1e-12) << line;
    EXPECT_NEAR(edges[i].position_mm, 1e-3 * line, 1e-15);
  }
  EXPECT_EQ(axis.record.name, "axis");
  EXPECT_EQ(axis.record.ticks[0].count, -5) << "−300 is in the cell from −320 to −257";
  EXPECT_EQ(axis.record.ticks[30].count, 0);
}

TEST(RecordedAxisByHand, AReversalCrossesTheSameLineTwice) {
  const RecordedAxis axis =
      recorded_axis(fine_log(41, [](int k) { return k <= 20 ? 5 * k : 5 * (40 - k); }));
  ASSERT_EQ(axis.record.edges.size(), 2U);
  EXPECT_EQ(axis.record.edges[0].line, 1);
  EXPECT_EQ(axis.record.edges[1].line, 1);
  EXPECT_EQ(axis.record.edges[1].direction, -1);
  EXPECT_NEAR(axis.record.edges[0].t_s + axis.record.edges[1].t_s, 0.040, 1e-12);
}

TEST(RecordedAxisByHand, TruthOfACubicIsExact) {
  const RecordedAxis axis =
      recorded_axis(fine_log(60, [](int k) { return (std::int64_t{2} * k - 90) * k * k; }));
  for (int k = 0; k < 60; ++k) {
    const MotionState& truth = axis.record.truth[static_cast<std::size_t>(k)];
    EXPECT_NEAR(truth.position_mm, (2.0 * k * k * k - 90.0 * k * k + 0.5) * kFine_mm, 1e-12) << k;
    EXPECT_NEAR(truth.velocity_mm_s, (6.0 * k * k - 180.0 * k) * kFine_mm * 1e3, 1e-7) << k;
    EXPECT_NEAR(truth.acceleration_mm_s2, (12.0 * k - 180.0) * kFine_mm * 1e6, 1e-5) << k;
  }
}

TEST(RecordedAxisByHand, AcrossAGapNoEdgeIsInventedAndTheNextReportsTheLoss) {
  EdgeLog log = fine_log(100, [](int k) { return 10 * k; });
  for (std::size_t i = 50; i < log.rows.size(); ++i) {
    log.rows[i].t_s += 0.2;
    log.rows[i].count += 6400;
  }
  const auto edges = recorded_axis(log).record.edges;
  ASSERT_EQ(edges.size(), 15U);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_EQ(edges[i].lost, edges[i].line == 108 ? 1 : 0) << edges[i].line;
    EXPECT_EQ(edges[i].line, static_cast<std::int64_t>(i) + (i < 7 ? 1 : 101));
  }
}

TEST(RecordedAxisByHand, NothingIsScoredNearACounterErrorOrBeforeTheRunIn) {
  const RecordedAxis axis =
      recorded_axis(fine_log(200, [](int k) { return 10 * k + (k >= 100 ? 640 : 0); }));
  for (std::size_t i = 0; i < 200; ++i) {
    const bool near = i > 84 && i < 116;
    const bool far = i < 75 || i > 125;  // the fit reaches four rows further
    if (i < 20 || near) {
      EXPECT_EQ(axis.scored[i], 0) << i;
    } else if (far) {
      EXPECT_EQ(axis.scored[i], 1) << i;
    }
  }
}

}  // namespace
}  // namespace steadyrest::motion::offline
