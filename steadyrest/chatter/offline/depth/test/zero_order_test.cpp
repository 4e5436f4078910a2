// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/depth/zero_order.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

/// Two modes, 5600 N/mm each.
Process two_modes(std::size_t teeth, double immersion, Direction direction) {
  Process p;
  p.tool.teeth = teeth;
  p.cut.radial_immersion = immersion;
  p.cut.direction = direction;
  p.cut.tangential_n_mm2 = 600.0;
  p.cut.radial_n_mm2 = 42.0;
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    Mode mode;
    mode.shape = axis == 0 ? std::array{1.0, 0.0} : std::array{0.0, 1.0};
    mode.frequency_hz = axis == 0 ? 600.0 : 660.0;
    mode.damping_ratio = 0.035;
    mode.mass_kg = 5600e3 / std::pow(2.0 * std::numbers::pi * mode.frequency_hz, 2);
    p.modes.push_back(mode);
  }
  return p;
}

ZeroOrderPoint lowest(const Process& process) {
  return std::ranges::min(zero_order_lobes(process, 400.0, 1000.0, 6001, 1), {},
                          &ZeroOrderPoint::depth_mm);
}

// The commonly used set of Altintas and Budak; the figures come from an independent script.
TEST(ZeroOrder, DirectionalFactorsOfHalfImmersion) {
  const auto alpha = zero_order_alpha(two_modes(4, 0.5, Direction::up));
  EXPECT_NEAR(alpha[0], -1.1100, 0.5e-4);
  EXPECT_NEAR(alpha[1], -1.6408, 0.5e-4);
  EXPECT_NEAR(alpha[2], 1.5008, 0.5e-4);
  EXPECT_NEAR(alpha[3], 0.8900, 0.5e-4);
}

TEST(ZeroOrder, AbsoluteLimitsOfTheBenchmark) {
  struct Row {
    std::size_t teeth;
    double immersion;
    Direction direction;
    double depth_mm, hz;
  };
  for (const Row& row :
       {Row{3, 0.5, Direction::up, 1.0196, 624.9}, Row{4, 0.5, Direction::up, 0.7647, 624.9},
        Row{8, 0.5, Direction::up, 0.3824, 624.9}, Row{4, 0.5, Direction::down, 2.4228, 601.6},
        Row{4, 1.0, Direction::up, 0.5435, 618.2}}) {
    const auto found = lowest(two_modes(row.teeth, row.immersion, row.direction));
    EXPECT_NEAR(found.depth_mm, row.depth_mm, 0.6e-4) << row.teeth << " " << row.immersion;
    EXPECT_NEAR(found.chatter_hz, row.hz, 0.11) << row.teeth << " " << row.immersion;
  }
}

// The same eigenvalue from two sides: closed form along the frequency, root search at a speed. A
// lower lobe may lead at that speed, hence the inequality.
TEST(ZeroOrder, LimitAtASpeedLiesOnTheLobes) {
  const Process p = two_modes(4, 0.5, Direction::up);
  for (const auto& point : zero_order_lobes(p, 612.0, 640.0, 8, 12)) {
    if (point.depth_mm > 1.1) {
      continue;
    }
    for (const double speed : {point.speed_rev_s[3], point.speed_rev_s[8]}) {
      const auto limit = zero_order_limit_mm(p, speed);
      ASSERT_TRUE(limit.has_value());
      EXPECT_LE(*limit, point.depth_mm * (1.0 + 1e-6));
      EXPECT_GE(*limit, lowest(p).depth_mm * (1.0 - 1e-3));
    }
  }
}

/// With eight teeth two are always engaged: the mean of the cut says nearly everything.
TEST(ZeroOrder, AgreesWithTheExactBorderWhereManyTeethCut) {
  const Process p = two_modes(8, 0.5, Direction::up);
  for (double rpm = 2000.0; rpm <= 4000.0; rpm += 200.0) {
    const double exact = limit_depth_mm(p, rpm / 60.0, {}, 3.0).value().value();
    const double sketch = zero_order_limit_mm(p, rpm / 60.0).value();
    EXPECT_NEAR(sketch / exact, 1.0, 0.03) << rpm;
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
