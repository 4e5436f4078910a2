// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/uncertainty.hpp>

namespace steadyrest::contour::offline {
namespace {

ServoModels gains(double x, double y, double z) {
  return {online::AxisModel{.gain_1_s = x}, online::AxisModel{.gain_1_s = y},
          online::AxisModel{.gain_1_s = z}};
}

double spread(const ServoModels& model) {
  const auto [low, high] = std::ranges::minmax(model, {}, &online::AxisModel::gain_1_s);
  return high.gain_1_s - low.gain_1_s;
}

TEST(UncertainGains, HasTheEightCornersOfTheBox) {
  const ServoModels model = gains(40.0, 50.0, 60.0);
  const auto corners = uncertain(model, 0.1);
  ASSERT_EQ(corners.size(), 8U);
  std::set<std::vector<double>> different;
  for (const ServoModels& corner : corners) {
    std::vector<double> gain;
    for (std::size_t i = 0; i < 3; ++i) {
      gain.push_back(corner[i].gain_1_s);
      EXPECT_NEAR(std::abs(corner[i].gain_1_s / model[i].gain_1_s - 1.0), 0.1, 1e-12);
    }
    different.insert(gain);
  }
  EXPECT_EQ(different.size(), 8U);
  EXPECT_TRUE(uncertain(model, 0.0).empty());
}

// 48 and 52 within 5 % have 49.4 … 50.4 in common: equal gains, no bent lines.
TEST(UncertainGains, GainsThatMayBeEqualAreTakenAsEqual) {
  const ServoModels model = cautious(gains(48.0, 52.0, 50.0), 0.05);
  EXPECT_DOUBLE_EQ(spread(model), 0.0);
  EXPECT_GE(model[0].gain_1_s, 52.0 * 0.95);
  EXPECT_LE(model[0].gain_1_s, 48.0 * 1.05);
}

// 40 and 60 within 5 % cannot be equal: what is left of the difference is certain.
TEST(UncertainGains, ADifferenceThatIsCertainStays) {
  const ServoModels model = cautious(gains(40.0, 60.0, 50.0), 0.05);
  EXPECT_DOUBLE_EQ(model[0].gain_1_s, 42.0);
  EXPECT_DOUBLE_EQ(model[1].gain_1_s, 57.0);
  EXPECT_GE(model[2].gain_1_s, 47.5);
  EXPECT_LE(model[2].gain_1_s, 52.5);
}

TEST(UncertainGains, WithoutAnyTheModelIsTaken) {
  const ServoModels model = cautious(gains(40.0, 60.0, 50.0), 0.0);
  EXPECT_DOUBLE_EQ(model[0].gain_1_s, 40.0);
  EXPECT_DOUBLE_EQ(model[1].gain_1_s, 60.0);
  EXPECT_DOUBLE_EQ(model[2].gain_1_s, 50.0);
}

}  // namespace
}  // namespace steadyrest::contour::offline
