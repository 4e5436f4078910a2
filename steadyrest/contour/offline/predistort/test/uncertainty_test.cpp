// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
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

/// One line that moves these axes.
std::vector<kernel::signal::PathSegment> line_to(const kernel::signal::Point& end_mm) {
  kernel::signal::PathSegment segment;
  segment.end_mm = end_mm;
  return {segment};
}
const auto kInSpace = line_to({1.0, 1.0, 1.0});

TEST(Uncertain, HasTheEightCornersOfTheBoxOfGains) {
  const ServoModels model = gains(40.0, 50.0, 60.0);
  const auto corners = uncertain(model, {.gain = 0.1}, kInSpace);
  ASSERT_EQ(corners.size(), 8U);
  std::set<std::vector<double>> different;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    std::vector<double> gain;
    for (std::size_t i = 0; i < 3; ++i) {
      gain.push_back(corners[n][i].gain_1_s);
      EXPECT_NEAR(std::abs(gain.back() / model[i].gain_1_s - 1.0), 0.1, 1e-12);
    }
    different.insert(gain);
  }
  EXPECT_EQ(different.size(), 8U);
  EXPECT_EQ(uncertain(model, {.gain = 0.0}, kInSpace).size(), 0U);
}

// Up to half of 1/k more where a lag is not known, never below none.
TEST(Uncertain, HasTheCornersOfTheLagsToo) {
  ServoModels model = gains(40.0, 50.0, 20.0);
  model[1].velocity_lag_s = 0.002;
  const auto corners = uncertain(model, {.gain = 0.05, .lag = {0.5, 0.2, 0.0}}, kInSpace);
  ASSERT_EQ(corners.size(), 4U * 4U * 2U);
  std::set<double> x;
  std::set<double> y;
  std::set<std::vector<double>> different;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const ServoModels corner = corners[n];
    x.insert(corner[0].velocity_lag_s);
    y.insert(corner[1].velocity_lag_s);
    EXPECT_EQ(corner[2].velocity_lag_s, 0.0);
    std::vector<double> all;
    for (const online::AxisModel& axis : corner) {
      all.insert(all.end(), {axis.gain_1_s, axis.velocity_lag_s});
    }
    different.insert(all);
  }
  EXPECT_EQ(different.size(), corners.size());
  EXPECT_EQ(x, (std::set<double>{0.0, 0.0125}));
  EXPECT_EQ(y, (std::set<double>{0.0, 0.006}));
}

TEST(Uncertain, LeavesOutAxesThatNeverMove) {
  const ServoModels model = gains(40.0, 50.0, 60.0);
  const ServoUncertainty by{.gain = 0.05, .lag = {0.5, 0.5, 0.5}};
  const auto flat = uncertain(model, by, line_to({1.0, 1.0, 0.0}));
  ASSERT_EQ(flat.size(), 16U);
  EXPECT_EQ(flat[15][2], model[2]);
  // A full circle in XZ ends where it begins.
  auto circle = line_to({});
  circle[0].geometry = kernel::signal::Geometry::arc;
  circle[0].axis = {0.0, 1.0, 0.0};
  EXPECT_EQ(uncertain(model, by, circle).axis[1].size(), 1U);
  EXPECT_EQ(uncertain(model, by, circle).size(), 16U);
}

TEST(Uncertain, TakesTheLagsThatTheMachineFileLacks) {
  std::vector<kernel::machine::Axis> axes(2);
  axes[1].velocity_lag_known = false;
  const auto lag = [&](std::optional<double> given) {
    return ServoUncertainty::of(axes, 0.05, given).lag;
  };
  EXPECT_EQ(lag({}), (std::array{0.0, 0.5, 0.0}));
  EXPECT_EQ(lag(0.1), (std::array{0.1, 0.1, 0.0}));
  EXPECT_EQ(lag(0.0), (std::array{0.0, 0.0, 0.0}));
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
