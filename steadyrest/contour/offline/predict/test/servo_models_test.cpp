// SPDX-License-Identifier: Apache-2.0
// The servo models of a machine file's axes.
#include <array>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;

std::vector<Axis> axes_with_gains(const std::vector<double>& gains_1_s) {
  std::vector<Axis> axes;
  for (const double gain_1_s : gains_1_s) {
    axes.emplace_back().servo_gain_1_s = gain_1_s;
  }
  return axes;
}

TEST(ServoModelsOfAxes, AreThoseOfTheMachineFile) {
  auto axes = axes_with_gains({30.0, 40.0, 50.0});
  axes[1].feed_forward = 0.6;
  axes[2].velocity_lag_s = 0.004;
  const ServoModels models = servo_models(axes);
  EXPECT_EQ(models[0].gain_1_s, 30.0);
  EXPECT_EQ(models[1].gain_1_s, 40.0);
  EXPECT_EQ(models[1].feed_forward, 0.6);
  EXPECT_EQ(models[2].gain_1_s, 50.0);
  EXPECT_EQ(models[2].velocity_lag_s, 0.004);
  EXPECT_EQ(models[0].feed_forward, 0.0);
}

// A lathe without Y: nothing moves there, so it must not be what limits X and Z.
TEST(ServoModelsOfAxes, AnAxisThatIsMissingIsAsStiffAsTheStiffest) {
  const ServoModels models = servo_models(axes_with_gains({30.0, 80.0}));
  EXPECT_EQ(models[2].gain_1_s, 80.0);
  EXPECT_EQ(softest_gain_1_s(models), 30.0);
  EXPECT_EQ(softest_gain_1_s(servo_models(axes_with_gains({30.0, 80.0, 20.0}))), 20.0);
  EXPECT_GT(softest_gain_1_s(servo_models({})), 0.0);
}

// The rotary axes behind the first three have no part in it.
TEST(ServoModelsOfAxes, TakeTheFirstThree) {
  auto axes = axes_with_gains({30.0, 30.0, 30.0, 5.0, 200.0});
  axes[3].backlash_au = 0.1;
  axes[1].backlash_au = 0.012;
  EXPECT_EQ(softest_gain_1_s(servo_models(axes)), 30.0);
  EXPECT_EQ(backlash_mm(axes), (std::array<double, 3>{0.0, 0.012, 0.0}));
  EXPECT_EQ(backlash_mm(std::span(axes).first(1)), (std::array<double, 3>{}));
}

// 1/50 s behind; with 60 % feed-forward 40 % of that; with all of it nothing.
TEST(ServoModelsOfAxes, LagByWhatTheFeedForwardLeaves) {
  auto axes = axes_with_gains({50.0, 50.0, 25.0});
  axes[1].feed_forward = 0.6;
  axes[2].feed_forward = 1.0;
  const auto lags_s = first_lags_s(servo_models(axes));
  EXPECT_NEAR(lags_s[0], 0.020, 1e-15);
  EXPECT_NEAR(lags_s[1], 0.008, 1e-15);
  EXPECT_NEAR(lags_s[2], 0.0, 1e-15);
}

TEST(PathMapOfAPath, ToItselfIsItsLength) {
  nc::plan::PlannedPath path;
  path.segments =
      online::test::PathMaker({0, 0, 0}, 10.0).line_to({3, 4, 0}).line_to({3, 4, 12}).path();
  const PathMap map = same_path(path);
  EXPECT_EQ(map.start_mm, (std::vector<double>{0.0, 5.0}));
  EXPECT_EQ(map.end_mm, (std::vector<double>{5.0, 17.0}));
}

}  // namespace
}  // namespace steadyrest::contour::offline
