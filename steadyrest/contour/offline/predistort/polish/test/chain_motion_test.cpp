// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/polish/test/mill.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

using std::numbers::pi;

ChainPiece piece(const Heading& start, double curvature, double length, double feed) {
  ChainPiece out;
  out.arc = {start, curvature, length};
  out.feed_mm_s = out.programmed_mm_s = feed;
  return out;
}

std::vector<ChainPiece> line_and_arc() {
  const ChainPiece line = piece({}, 0.0, 10.0, 30.0);
  return {line, piece(along(line.arc, 10.0), 0.2, 5.0 * pi / 2.0, 30.0)};
}

TEST(ChainMotion, TakesTheTimeOfTheTrapezoid) {
  const auto machine = slow_mill();
  ChainMotion motion(machine, nc::interpret::Plane::xy, 1);
  ASSERT_TRUE(motion.run(line_and_arc(), 0.0));
  // v/A for both ramps of a line; along the arc less than A is left to brake with.
  const double seconds = (10.0 + 2.5 * pi) / 30.0;
  EXPECT_GT(motion.begin_s().back(), seconds + 30.0 / 2000.0 - 0.002);
  EXPECT_LT(motion.begin_s().back(), seconds + 0.5 * 30.0 / 2000.0 + 0.5 * 30.0 / 1000.0 + 0.002);
  EXPECT_NEAR(motion.begin_s()[1], 10.0 / 30.0 + 0.5 * 30.0 / 2000.0, 0.002);
  const auto& end = motion.command().back();
  EXPECT_NEAR(end[0], 15.0, 1e-6);
  EXPECT_NEAR(end[1], 5.0, 1e-6);
}

TEST(ChainMotion, FromASpeedItGoesOnAsIfItHadBegunBefore) {
  const auto machine = slow_mill();
  const auto pieces = line_and_arc();
  ChainMotion whole(machine, nc::interpret::Plane::xy, 1);
  ChainMotion part(machine, nc::interpret::Plane::xy, 1);
  ASSERT_TRUE(whole.run(pieces, 0.0));
  const std::vector<ChainPiece> last(pieces.begin() + 1, pieces.end());
  ASSERT_TRUE(part.run(last, 0.0, 30.0));
  EXPECT_GE(part.after_s(), 0.0);
  EXPECT_LE(part.after_s(), 0.001);
  // The same places at the same times after the joint.
  for (const double t : {0.02, 0.1, 0.2}) {
    const auto at = [t](const ChainMotion& motion, double joint_s) {
      const double j = (joint_s + t) / 0.001;
      const auto k = static_cast<std::size_t>(j);
      return math::geometry::add_scaled(
          motion.command()[k],
          math::geometry::subtract(motion.command()[k + 1], motion.command()[k]),
          j - static_cast<double>(k));
    };
    EXPECT_LT(math::geometry::distance(at(whole, whole.begin_s()[1]), at(part, -part.after_s())),
              2e-4)
        << t;
  }
}

TEST(ChainMotion, GivesOutEachSecondPeriod) {
  const auto machine = slow_mill();
  ChainMotion all(machine, nc::interpret::Plane::xy, 1);
  ChainMotion half(machine, nc::interpret::Plane::xy, 2);
  ASSERT_TRUE(all.run(line_and_arc(), 0.0));
  ASSERT_TRUE(half.run(line_and_arc(), 0.0));
  ASSERT_EQ(half.command().size(), (all.command().size() + 1) / 2);
  EXPECT_EQ(half.command()[40], all.command()[80]);
  EXPECT_EQ(half.begin_s(), all.begin_s());
}

}  // namespace
}  // namespace steadyrest::contour::offline
