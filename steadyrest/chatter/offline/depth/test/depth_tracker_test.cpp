// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/chatter/offline/depth/depth_tracker.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

/// First crossing of |μ| = 1. Slot at 12 000 rpm: 2.14931, where first-order semi-discretization,
/// extrapolated from 1600 and 3200 steps, has ln|μ| = −3e-9 (a table gives 2.1494: +2.5e-5).
TEST(DepthTracker, BordersOfTheBenchmark) {
  const std::vector<double> rpm{5000, 6000, 8000, 10000, 12000, 15000, 18000, 20000, 25000};
  struct Row {
    double immersion;
    Direction direction;
    std::vector<double> depth;
  };
  const std::vector<Row> rows{
      {1.0, Direction::up, {.4086, .3532, .6764, .3224, 2.1493, .3866, .6895, 1.4175, 3.9399}},
      {0.5, Direction::down, {.8472, 1.1388, .7979, 2.1047, .6131, 2.5962, 1.6197, .7196, 1.0377}},
      {.05,
       Direction::down,
       {2.2069, 3.0713, 2.1632, 4.0907, 1.6805, 8.2125, 1.2951, 2.2987, 2.9117}},
      {.05, Direction::up, {2.1462, 1.8317, 3.4956, 1.6577, 6.2332, 1.8880, 4.4319, 3.7740, 99.0}},
  };
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < rpm.size(); ++i) {
      DepthTracker tracker(benchmark_cut(row.immersion, row.direction), rpm[i] / 60.0, 20.0);
      const auto border = tracker.border_mm(80);
      if (row.depth[i] > 20.0) {
        EXPECT_FALSE(border.has_value());
      } else {
        ASSERT_TRUE(border.has_value());
        EXPECT_NEAR(*border, row.depth[i], 0.51e-4) << row.immersion << " " << rpm[i];
      }
    }
  }
}

// Two ways to one number: zeros of a determinant here, eigenvalues of the period's map there. A
// zero that the tracker lost between two depths would show as a jump.
TEST(DepthTracker, AgreesWithArnoldiAtEveryDepth) {
  const Process slot = benchmark_cut(1.0, Direction::up);
  for (const double rpm : {5100.0, 9000.0, 13300.0, 19070.0, 24000.0}) {
    DepthTracker tracker(slot, rpm / 60.0, 5.0);
    DelayCycle::Config config;
    config.speed_rev_s = rpm / 60.0;
    config.most_depth_mm = 5.0;
    DelayCycle cycle = DelayCycle::make(slot, config).value();
    for (int i = 1; i <= 50; ++i) {
      const double depth = 0.1 * i;
      cycle.set_depth(depth);
      EXPECT_NEAR(std::abs(tracker.dominant(depth)), std::exp(multipliers(cycle, 1).log_modulus[0]),
                  1e-8 * std::exp(multipliers(cycle, 1).log_modulus[0]))
          << rpm << " " << depth;
    }
  }
}

// Many waves and much damping crowd the multipliers: the count of zeros must not overlook them.
// ln ρ at twice and at five times the safe depth, by Arnoldi's method on the whole map.
TEST(DepthTracker, OverlooksNoneWhereMultipliersCrowd) {
  struct Row {
    double damping_ratio, kr, waves, depth;
  };
  for (const auto& [z, kr, waves, depth] : {Row{0.05, 400.0, 50.0, 5.0},
                                            {0.1, 400.0, 30.0, 2.0},
                                            {0.3, 400.0, 10.0, 5.0},
                                            {0.3, 400.0, 20.5, 5.0},
                                            {0.5, -400.0, 10.0, 2.0},
                                            {0.5, -400.0, 20.5, 1.2},
                                            {0.75, -400.0, 30.0, 1.01},
                                            {0.75, -400.0, 30.0, 1.2},
                                            {0.9, -400.0, 50.0, 1.2},
                                            {0.99, -400.0, 10.0, 1.05}}) {
    const Process p = turned(z, kr);
    const double speed = kTurned_hz / waves;
    const double depth_mm = depth * safe_depth_mm(p);
    DelayCycle cycle =
        DelayCycle::make(
            p, {.speed_rev_s = speed, .modulation = {}, .course = {}, .most_depth_mm = depth_mm})
            .value();
    cycle.set_depth(depth_mm);
    DepthTracker tracker(p, speed, 1.1 * depth_mm);
    EXPECT_NEAR(std::log(std::abs(tracker.dominant(depth_mm))),
                multipliers(cycle, 1).log_modulus[0], 1e-4)
        << z << " " << kr << " " << waves << " " << depth;
  }
}

/// Modes along x, y and between them; the deep end has multipliers of some thousands.
TEST(DepthTracker, AgreesWithArnoldiForSeveralModes) {
  Process two = benchmark_cut(0.3, Direction::down);
  two.tool.teeth = 4;
  Mode y = two.modes[0];
  y.shape = {0.0, 1.0};
  y.frequency_hz = 1100.0;
  y.damping_ratio = 0.02;
  two.modes.push_back(y);
  Process three = benchmark_cut(1.0, Direction::up);
  three.tool.teeth = 3;
  Mode oblique = three.modes[0];
  oblique.shape = {0.8, 0.6};
  oblique.frequency_hz = 1890.0;
  three.modes.push_back(y);
  three.modes.push_back(oblique);
  for (const Process& cut : {two, three}) {
    for (const double rpm : {6200.0, 8589.74358974359, 21000.0}) {
      DepthTracker tracker(cut, rpm / 60.0, 10.0);
      DelayCycle::Config config;
      config.speed_rev_s = rpm / 60.0;
      config.most_depth_mm = 10.0;
      DelayCycle cycle = DelayCycle::make(cut, config).value();
      for (int i = 1; i <= 99; ++i) {
        const double depth = 10.0 * i / 99.0;
        const double log_modulus = std::log(std::abs(tracker.dominant(depth)));
        if (i % 7 == 1) {
          cycle.set_depth(depth);
          EXPECT_NEAR(log_modulus, multipliers(cycle, 1).log_modulus[0], 1e-8)
              << cut.modes.size() << " modes, " << rpm << " " << depth;
        }
      }
    }
  }
}

/// With helix each depth has its own angles of entry and exit; the long edge winds round the tool.
TEST(DepthTracker, AgreesWithArnoldiForHelicalTeeth) {
  for (const double immersion : {0.05, 0.5, 1.0}) {
    Process cut = benchmark_cut(immersion, Direction::down);
    cut.tool.diameter_mm = 8.0;
    cut.tool.helix_rad = 0.7;
    if (immersion == 0.5) {
      Mode y = cut.modes[0];
      y.shape = {0.0, 1.0};
      y.frequency_hz = 1100.0;
      cut.modes.push_back(y);
    }
    for (const double rpm : {5100.0, 18209.0}) {
      DepthTracker tracker(cut, rpm / 60.0, 12.0);
      for (int i = 1; i <= 24; ++i) {
        const double depth = 0.5 * i;
        DelayCycle::Config config;
        config.speed_rev_s = rpm / 60.0;
        config.most_depth_mm = depth;
        DelayCycle cycle = DelayCycle::make(cut, config).value();
        cycle.set_depth(depth);
        EXPECT_NEAR(std::log(std::abs(tracker.dominant(depth))),
                    multipliers(cycle, 1).log_modulus[0], 1e-8)
            << immersion << " " << rpm << " " << depth;
      }
    }
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
