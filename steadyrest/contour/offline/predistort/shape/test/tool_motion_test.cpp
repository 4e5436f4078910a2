// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/tool_motion.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::offline {
namespace {

using online::test::PathMaker;

constexpr double kGain_1_s = 50.0;

ServoInverse inverse() {
  return ServoInverse({online::AxisModel{.gain_1_s = kGain_1_s},
                       online::AxisModel{.gain_1_s = kGain_1_s},
                       online::AxisModel{.gain_1_s = kGain_1_s}});
}

nc::plan::PlannedPath planned(PathMaker maker) {
  nc::plan::PlannedPath path;
  path.segments = maker.path();
  return path;
}

CommandSpeed steady(double speed_mm_s) {
  CommandSpeed speed;
  speed.add(0.0, speed_mm_s);
  speed.add(1000.0, speed_mm_s);
  return speed;
}

// On a line the tool runs up to the command's speed with the time constant 1/k and is v/k behind.
TEST(ToolMotion, FollowsALineLikeAFirstOrderLag) {
  const auto path = planned(PathMaker({0, 0, 0}, 40.0).line_to({50, 0, 0}));
  const ToolMotion motion(inverse(), path, steady(40.0));
  ASSERT_GT(motion.states().size(), 100U);
  const ToolState late = motion.at(40.0);
  EXPECT_NEAR(late.speed_mm_s, 40.0, 1e-6);
  EXPECT_NEAR(late.progress_mm - late.position_mm, 40.0 / kGain_1_s, 1e-6);
  // After three time constants, s = v·(t − (1 − e^−kt)/k).
  const double t = 3.0 / kGain_1_s;
  const double s = 40.0 * (t - (1.0 - std::exp(-3.0)) / kGain_1_s);
  EXPECT_NEAR(motion.at(s).speed_mm_s, 40.0 * (1.0 - std::exp(-3.0)), 0.2);
}

// w = v·√(1 + q²): the command on the wider circle takes as long for a turn as the tool on its own.
TEST(ToolMotion, IsSlowerThanTheCommandOnACircle) {
  const double radius = 4.0;
  const auto path = planned(PathMaker({radius, 0, 0}, 40.0).arc({0, 0, 0}, 12.0));
  const ToolMotion motion(inverse(), path, steady(40.0));
  const double v = motion.at(40.0).speed_mm_s;
  const double q = v / (radius * kGain_1_s);
  EXPECT_NEAR(v * std::sqrt(1.0 + q * q), 40.0, 1e-4);
}

TEST(ToolMotion, GoesToTheEndAlthoughTheCommandStops) {
  const auto path = planned(PathMaker({0, 0, 0}, 40.0).line_to({5, 0, 0}));
  CommandSpeed speed;
  speed.add(0.0, 40.0);
  speed.add(4.9, 10.0);
  speed.add(5.0, 0.0);
  const ToolMotion motion(inverse(), path, speed);
  ASSERT_FALSE(motion.states().empty());
  EXPECT_GT(motion.states().back().position_mm, 4.99);
  for (std::size_t i = 1; i < motion.states().size(); ++i) {
    EXPECT_GE(motion.states()[i].progress_mm, motion.states()[i - 1].progress_mm);
    EXPECT_GT(motion.states()[i].position_mm, motion.states()[i - 1].position_mm);
  }
}

TEST(ToolMotion, FindsStatesByPlace) {
  const auto path = planned(PathMaker({0, 0, 0}, 40.0).line_to({50, 0, 0}));
  const ToolMotion motion(inverse(), path, steady(40.0));
  const std::size_t found = motion.from(20.0);
  EXPECT_GE(motion.states()[found].position_mm, 20.0);
  EXPECT_LT(motion.states()[found - 1].position_mm, 20.0);
  EXPECT_EQ(motion.from(1e6), motion.states().size());
  EXPECT_DOUBLE_EQ(motion.at(20.0).position_mm, 20.0);
}

TEST(CommandSpeed, OnlyGrows) {
  CommandSpeed speed;
  speed.add(1.0, 10.0);
  speed.add(1.0, 20.0);
  speed.add(0.5, 30.0);
  speed.add(2.0, 40.0);
  EXPECT_EQ(speed.progress_mm, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(speed.speed_mm_s, (std::vector<double>{10.0, 40.0}));
}

}  // namespace
}  // namespace steadyrest::contour::offline
