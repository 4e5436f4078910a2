// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>

namespace steadyrest::nc::plan {
namespace {

using kernel::signal::Geometry;
using test::mill;
using test::plan_of;
using test::Program;

TEST(PathBuilder, LinesWithinTheMergeToleranceBecomeOne) {
  auto m = mill();
  m.control.merge_share = 1.0;
  m.control.junction_deviation_mm = 0.0;
  Program p;
  p.mode = interpret::PathMode::continuous;
  p.tolerance_mm = 0.01;
  // A zigzag 5 µm high in a tolerance of 10 µm: one line. The turn into Y is not part of it.
  for (int i = 1; i <= 20; ++i) {
    p.line(i, (i % 2) * 0.005, 50);
  }
  p.line(20, 30, 50);
  const auto path = plan_of(m, p);
  ASSERT_EQ(path.segments.size(), 3U);  // line, corner, line
  EXPECT_EQ(path.segments[1].geometry, Geometry::arc);
}

TEST(PathBuilder, LinesOfDifferentSpeedModulationStayTwo) {
  auto m = mill();
  m.control.merge_share = 1.0;
  Program p;
  p.mode = interpret::PathMode::continuous;
  p.tolerance_mm = 0.01;
  p.line(10, 0, 50);
  p.line(20, 0, 50).speed_modulation = true;
  const auto path = plan_of(m, p);
  ASSERT_EQ(path.segments.size(), 2U);
  EXPECT_FALSE(path.segments[0].speed_modulation);
  EXPECT_TRUE(path.segments[1].speed_modulation);
  EXPECT_GT(path.segments[0].exit_speed_limit_mm_s, 0.0) << "the switch needs no stop";
}

/// One arc of R = 10 mm over 30° with the sagitta 0.341 mm, under G64 with a tolerance.
std::size_t pieces_of_arc(double tolerance_mm) {
  auto m = mill();
  m.control.merge_share = 1.0;
  Program p;
  p.mode = interpret::PathMode::continuous;
  p.tolerance_mm = tolerance_mm;
  p.line(10, 0, 50);
  p.arc(10 * std::cos(std::numbers::pi / 6), 5, 0, 0, 1, 50);
  const auto path = plan_of(m, p);
  return static_cast<std::size_t>(std::ranges::count_if(
      path.segments, [](const auto& s) { return s.radius_mm > 9.9 && s.radius_mm < 10.1; }));
}

TEST(PathBuilder, AnArcFlatterThanTheMergeToleranceIsNoArc) {
  // 10·(1 − cos 15°) = 0.3407 mm.
  EXPECT_EQ(pieces_of_arc(0.340), 1U);
  EXPECT_EQ(pieces_of_arc(0.342), 0U);
}

}  // namespace
}  // namespace steadyrest::nc::plan
