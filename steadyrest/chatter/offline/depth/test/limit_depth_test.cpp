// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

/// Helix makes closed islands of the flip lobes (Zatarain et al. 2006; Patel et al. 2008): 8 mm,
/// 45°, immersion 0.05, at the end of one.
Process helical() {
  Process p = benchmark_cut(0.05, Direction::down);
  p.tool.diameter_mm = 8.0;
  p.tool.helix_rad = 0.25 * std::numbers::pi;
  return p;
}

constexpr double kEnd_rev_s = 18209.0 / 60.0;

TEST(LimitDepth, FindsAnIslandThatIsNarrowerThanItsSteps) {
  auto line = DepthLine::make(helical(), kEnd_rev_s, {}, 5.0).value();
  // Unstable for a few hundredths of a millimetre and stable on both sides: a march by 6 % steps
  // over it.
  EXPECT_LT(line.log_radius(1.400), 0.0);
  EXPECT_GT(line.log_radius(1.428), 0.0);
  EXPECT_LT(line.log_radius(1.460), 0.0);
  EXPECT_LT(line.log_radius(4.0), 0.0);
  for (const double most_mm : {20.0, 25.0, 30.0, 40.0}) {
    const auto limit = limit_depth_mm(helical(), kEnd_rev_s, {}, most_mm);
    ASSERT_TRUE(limit.has_value() && limit->has_value());
    EXPECT_NEAR(**limit, 1.4177, 1e-4) << most_mm;
  }
}

TEST(LimitDepth, SeesNoneBeyondTheIslandsEnd) {
  const auto limit = limit_depth_mm(helical(), 18210.0 / 60.0, {}, 20.0);
  ASSERT_TRUE(limit.has_value() && limit->has_value());
  EXPECT_GT(**limit, 4.1);
}

TEST(LimitDepth, TheBorderOfAMapFindsItToo) {
  const auto line =
      border_line(helical(), {.speed_rev_s = {kEnd_rev_s}, .most_depth_mm = 2.8, .modulation = {}});
  ASSERT_TRUE(line.has_value() && line->depth_mm[0].has_value());
  EXPECT_NEAR(*line->depth_mm[0], 1.4177, 1e-4);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
