// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/motion/online/bounded/cell_sight.hpp>

namespace steadyrest::motion::online {
namespace {

/// Four models at these positions, all with the standard deviation `sd`.
ModelBank models_at(const Lanes& mean, double sd) {
  ModelBank bank;
  for (std::size_t j = 0; j < kModels; ++j) {
    bank.set(j, {{mean[j], 3.0, 0.0}, {sd * sd, 0.0, 0.0, 1.0, 0.0, 1.0}});
  }
  return bank;
}

// Total probability: cells side by side, each with its share, give back the whole distribution. No
// table of the normal distribution is needed for that.
TEST(CellSight, CellsSideBySideMakeUpTheWholeDistribution) {
  constexpr double kMean = 10.0;
  constexpr double kSd = 2.0;
  for (const double width : {0.02, 0.09, 0.11, 0.5, 3.0}) {  // in standard deviations
    double whole = 0.0;
    double first = 0.0;
    double second = 0.0;
    for (double low = -7.0; low < 7.0; low += width) {
      ModelBank bank = models_at(all(kMean), kSd);
      const double share = truncate(bank, kMean + kSd * low, kMean + kSd * (low + width))[2];
      const double off = bank.x[2] - kMean;
      whole += share;
      first += share * off;
      second += share * (off * off + bank.position_variance()[2]);
    }
    EXPECT_NEAR(whole, 1.0, 1e-6) << width;
    EXPECT_NEAR(first, 0.0, 1e-5) << width;
    EXPECT_NEAR(second, kSd * kSd, 1e-3) << width;
  }
}

TEST(CellSight, FarInsideItsCellAModelLearnsNothing) {
  const ModelBank bank = models_at({0.0, 0.1, -0.1, 0.2}, 0.01);
  const CellSight seen = see_cell(bank, -0.5, 0.5);
  EXPECT_FALSE(seen.any);
  EXPECT_EQ(seen.share, all(1.0));
}

TEST(CellSight, EachModelIsJudgedAlone) {
  ModelBank bank = models_at({0.0, 0.49, -0.49, 0.6}, 0.01);
  const Lanes share = truncate(bank, -0.5, 0.5);
  EXPECT_EQ(bank.x[0], 0.0) << "in the middle: nothing new";
  EXPECT_EQ(share[0], 1.0);
  // One standard deviation from a border: 84.13 % are inside.
  EXPECT_NEAR(share[1], 0.8413, 1e-4);
  EXPECT_NEAR(share[2], share[1], 1e-12);
  EXPECT_LT(bank.x[1], 0.49);
  EXPECT_NEAR(bank.x[2], -bank.x[1], 1e-12) << "the other border, mirrored";
  EXPECT_LT(share[3], 1e-9) << "ten standard deviations outside";
}

TEST(CellSight, AModelThatLostItsCellComesBackToTheNearerBorder) {
  for (const double lost : {-100.0, 100.0}) {
    ModelBank bank = models_at(all(lost), 1.0);
    const Lanes share = truncate(bank, -5.0, 5.0);
    const double border = lost < 0.0 ? -5.0 : 5.0;
    EXPECT_LE(std::abs(bank.x[0] - border), 0.01 * std::abs(lost - border)) << lost;
    EXPECT_LT(bank.position_variance()[0], 0.01) << "and is sure of it";
    EXPECT_GT(share[0], 0.0) << "so that it can win its weight back";
    EXPECT_LT(share[0], 1e-9);
  }
}

}  // namespace
}  // namespace steadyrest::motion::online
