// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

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

using kernel::testing::cases;

/// k·G at every frequency from 0 to ten times the mode's, the largest of what `of` makes of it.
template <class Of>
double largest_answer(double damping_ratio, const Of& of) {
  double most = -1e300;
  for (int i = 0; i <= 100000; ++i) {
    const double r = 1e-4 * i;
    most = std::max(most, of(1.0 / std::complex(1.0 - r * r, 2.0 * damping_ratio * r)));
  }
  return most;
}

constexpr double kRatios[] = {0.01, 0.3, 0.5, 0.7, 0.71, 0.9, 0.999};

TEST(LimitDepth, FindsAnIslandThatIsNarrowerThanItsSteps) {
  auto line = DepthLine::make(helical(), kEnd_rev_s, {}, 5.0).value();
  // Unstable for a few hundredths of a millimetre and stable on both sides: steps of 6 % skip it.
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

TEST(SafeDepth, IsThatOfTheLargestAnswerOfTheModeAtAnyDamping) {
  for (const double z : kRatios) {
    const Process p = turned(z, 400.0);
    const double most = largest_answer(z, [](std::complex<double> g) { return std::abs(g); });
    const double want = kTurned_N_mm / (2.0 * std::hypot(1.0, 400.0) * most);
    EXPECT_NEAR(safe_depth_mm(p), want, 1e-5 * want) << z;
  }
}

/// By Arnoldi's method on the whole map.
double log_radius(const Process& process, double waves, double depth_mm) {
  DelayCycle cycle = DelayCycle::make(process, {.speed_rev_s = kTurned_hz / waves,
                                                .modulation = {},
                                                .course = {},
                                                .most_depth_mm = depth_mm})
                         .value();
  cycle.set_depth(depth_mm);
  return multipliers(cycle, 1).log_modulus[0];
}

// A tool that digs in is unstable where −Kr·Re G is largest, (1 − e^{−iωT})/2 being 1 at best: far
// below the mode where damping leaves no peak, and there hardly deeper than what small gain allows.
TEST(SafeDepth, NothingIsUnstableBelowAndADiggingToolIsJustAbove) {
  for (const double z : cases({0.75, 0.99})) {
    const Process p = turned(z, -400.0);
    const double safe = safe_depth_mm(p);
    for (const double waves : {10.0, 20.5}) {
      EXPECT_LT(log_radius(p, waves, 0.999 * safe), 0.0) << z << " " << waves;
    }
    EXPECT_GT(log_radius(p, 30.0, 1.01 * safe), 0.0) << z;
  }
}

// min Re G = −1/(4ζ(1+ζ)k) at ω·√(1+2ζ), which has no bound on ζ: turning's absolute limit
// 2ζ(1+ζ)k/Kr keeps its form up to ζ = 1.
TEST(LimitDepth, AtAnyDampingTheWorstSpeedIsThatOfTheLeastRealPart) {
  for (const double z : cases({0.3, 0.72, 0.95})) {
    const Process p = turned(z, 400.0);
    const double least = -largest_answer(z, [](std::complex<double> g) { return -g.real(); });
    const double absolute = -kTurned_N_mm / (2.0 * 400.0 * least);
    EXPECT_NEAR(absolute, 2.0 * z * (1.0 + z) * kTurned_N_mm / 400.0, 1e-6 * absolute) << z;
    double worst = -1e300;
    for (double waves = 2.0; waves < 3.0; waves += 0.1) {
      EXPECT_LT(log_radius(p, waves, 0.999 * absolute), 0.0) << z << " " << waves;
      worst = std::max(worst, log_radius(p, waves, 1.01 * absolute));
    }
    EXPECT_GT(worst, 0.0) << z;
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
