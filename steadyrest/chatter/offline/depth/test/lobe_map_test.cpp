// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/depth/lobe_map.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/chatter/offline/test/runge_kutta.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using online::Law;

TEST(LobeMap, SlotMapHasTheMultipliersOfTheBenchmark) {
  LobeMapConfig config;
  config.speed_rev_s = {5000.0 / 60.0, 10000.0 / 60.0, 25000.0 / 60.0};
  config.depth_mm = {0.0, 0.2, 0.5, 1.0, 2.0};
  double last = 0.0;
  const auto map = lobe_map(benchmark_cut(1.0, Direction::up), config, [&](double share) {
    EXPECT_GT(share, last);
    last = share;
  });
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(last, 1.0);
  const std::vector<double> want{0.81974278, 1.07397559, 1.40647353, 1.76063600,
                                 0.94084672, 1.07460805, 1.23246922, 1.40351295,
                                 0.89359312, 0.84153824, 0.74339953, 0.58143833};
  for (std::size_t s = 0; s < 3; ++s) {
    // Free: e^{−ζωT}.
    EXPECT_NEAR(map->log_radius[s * 5], -0.011 * 2.0 * M_PI * 922.0 / (2.0 * config.speed_rev_s[s]),
                1e-12);
    for (std::size_t i = 1; i < 5; ++i) {
      EXPECT_NEAR(std::exp(map->log_radius[s * 5 + i]), want[s * 4 + i - 1], 1e-6);
    }
  }
}

TEST(LobeMap, DoesNotDependOnTheThreads) {
  LobeMapConfig config;
  for (double rpm = 6000.0; rpm < 20000.0; rpm += 1700.0) {
    config.speed_rev_s.push_back(rpm / 60.0);
  }
  config.depth_mm = {0.5, 1.5, 3.0};
  config.threads = 1;
  const Process cut = benchmark_cut(0.5, Direction::down);
  const auto one = lobe_map(cut, config, {});
  config.threads = 3;
  const auto three = lobe_map(cut, config, {});
  // To the last bit: speeds share nothing, so neither the order nor the number of threads may show.
  EXPECT_EQ(one->log_radius, three->log_radius);
}

TEST(LobeMap, RefusesWhatIsNoMap) {
  const Process cut = benchmark_cut(1.0, Direction::up);
  LobeMapConfig config;
  config.depth_mm = {1.0};
  EXPECT_FALSE(lobe_map(cut, config, {}).has_value());
  config.speed_rev_s = {100.0, -1.0};
  EXPECT_FALSE(lobe_map(cut, config, {}).has_value());
  config.speed_rev_s = {100.0};
  config.depth_mm = {1.0, 1.0};
  EXPECT_FALSE(lobe_map(cut, config, {}).has_value());
  config.depth_mm = {1.0, 1e9};
  EXPECT_FALSE(lobe_map(cut, config, {}).has_value());
  config.depth_mm = {1.0};
  config.speed_rev_s.assign(10'000'001, 100.0);
  EXPECT_FALSE(lobe_map(cut, config, {}).has_value());
  config.speed_rev_s = {100.0};
  config.modulation = {Law::sine, 1.5, 0.1, 1};
  EXPECT_FALSE(lobe_map(cut, config, {}).has_value());
  Process still = cut;
  still.modes.clear();
  config.modulation = {};
  EXPECT_FALSE(lobe_map(still, config, {}).has_value());
}

/// Lowest crossing of ρ = 1. Another collocation gives 1.2254 at 4500 rpm and 2.7653 at 5500, where
/// Runge–Kutta with 1600 steps per pass still has ln ρ = −1.9e-4 and 2.1e-4.
TEST(LimitDepth, AtConstantSpeed) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  for (const auto& [rpm, depth] : std::vector<std::pair<double, double>>{{3000, .6802},
                                                                         {4000, .7367},
                                                                         {4500, 1.2257},
                                                                         {5000, .4086},
                                                                         {5500, 2.7646},
                                                                         {9000, 3.0092}}) {
    const double limit = limit_depth_mm(slot, rpm / 60.0, {}, 4.0).value().value();
    EXPECT_NEAR(limit, depth, 0.51e-4) << rpm;
    EXPECT_NEAR(log_radius_by_runge_kutta(slot, rpm / 60.0, {}, limit, 1600, 1, 400), 0.0, 1e-5);
  }
}

/// The borders themselves by Runge–Kutta. Tables that interpolate between scanned depths are up to
/// 5 % off: they have 2.013 for the first row and .7655 for the third.
TEST(LimitDepth, OfTheModulatedSlot) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  struct Row {
    Law law;
    double rva, rvf, depth_mm;
  };
  for (const Row& row : std::vector<Row>{{Law::sine, .1, .2, 2.1045},
                                         {Law::sine, .1, .1, 1.4527},
                                         {Law::sine, .2, .2, .8003},
                                         {Law::triangle, .1, .2, 1.1240},
                                         {Law::triangle, .2, .2, 1.4220},
                                         {Law::triangle, .2, .1, 2.2130},
                                         {Law::square, .1, .2, 1.4790},
                                         {Law::square, .1, .1, 1.5891},
                                         {Law::square, .2, .2, .7390},
                                         {Law::square, .2, .1, .5574}}) {
    const Modulation modulation{row.law, row.rva, row.rvf, 1};
    const double limit = limit_depth_mm(slot, 5000.0 / 60.0, modulation, 3.0).value().value();
    EXPECT_NEAR(limit, row.depth_mm, 0.6e-3);
    EXPECT_NEAR(log_radius_by_runge_kutta(slot, 5000.0 / 60.0, modulation, limit, 800,
                                          static_cast<std::size_t>(std::lround(2.0 / row.rvf)), 60),
                0.0, 1e-4)
        << static_cast<int>(row.law) << " " << row.rva << " " << row.rvf;
  }
}

TEST(LimitDepth, OfHelicalTeethIsWhereTheRadiusIsOne) {
  Process cut = benchmark_cut(0.5, Direction::down);
  cut.tool.diameter_mm = 12.0;
  cut.tool.helix_rad = 0.5;
  const double limit = limit_depth_mm(cut, 100.0, {}, 4.0).value().value();
  DelayCycle::Config config;
  config.speed_rev_s = 100.0;
  config.most_depth_mm = limit;
  DelayCycle cycle = DelayCycle::make(cut, config).value();
  cycle.set_depth(limit);
  EXPECT_NEAR(stability(cycle, {}).log_radius, 0.0, 1e-9);
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
