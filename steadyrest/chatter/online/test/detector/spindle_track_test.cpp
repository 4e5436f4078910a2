// SPDX-License-Identifier: Apache-2.0
// What the orders in a signal say of the spindle's speed, against the speed that made it.
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kRateHz = 8e3;

struct Turning {
  double told_rev_s = 50.0;
  std::function<double(double t)> true_rev_s;
  double cuts_from_s = 0.0;
  double chatter_hz = 0.0;  ///< from 1 s on
  double chatter = 0.7;     ///< the largest order has 0.7
  bool side_lines = false;  ///< of the chatter, a tooth frequency apart
  double forced = 1.0;      ///< of what the orders have otherwise
  std::size_t teeth = 4;
  double told_sd = 0.003;
};

struct Found {
  double speed_rev_s = 0.0;
  double sd = 0.0;
  double chatters_s = 0.0;  ///< for so long
};

/// After `seconds`.
Found found(const Turning& turning, double seconds) {
  auto detector = Detector::make(
      {.sample_rate_hz = kRateHz, .teeth = turning.teeth, .speed_sd = turning.told_sd});
  EXPECT_TRUE(detector);
  std::mt19937_64 rng(3);
  std::normal_distribution<double> noise(0.0, 0.05);
  double turns = 0.0;
  Found out;
  for (int i = 0; i < static_cast<int>(seconds * kRateHz); ++i) {
    const double t = i / kRateHz;
    turns += turning.true_rev_s(t) / kRateHz;
    double value = noise(rng);
    for (int k = 1; k <= 40 && t >= turning.cuts_from_s; ++k) {
      const double size = (k % static_cast<int>(turning.teeth) == 0 ? 1.0 : 0.1) / (1.0 + 0.1 * k);
      value += turning.forced * size * std::cos(kernel::units::kTurn * (k * turns) + k * k);
    }
    if (turning.chatter_hz > 0.0 && t >= 1.0) {
      const double tooth_hz = static_cast<double>(turning.teeth) * turning.true_rev_s(t);
      for (int side = turning.side_lines ? -2 : 0; side <= (turning.side_lines ? 2 : 0); ++side) {
        value += turning.chatter / (1.0 + std::abs(side)) *
                 std::cos(kernel::units::kTurn * (turning.chatter_hz + side * tooth_hz) * t);
      }
    }
    const auto& heard = detector->update({.value = value, .speed_rev_s = turning.told_rev_s});
    out = {.speed_rev_s = heard.speed_rev_s,
           .sd = heard.speed_sd,
           .chatters_s = out.chatters_s + (heard.chatter ? 1.0 / kRateHz : 0.0)};
  }
  return out;
}

TEST(SpindleTrack, FindsASpeedThatIsUpToTwoPercentOff) {
  for (const double off : {-0.02, -0.005, 0.0, 0.001, 0.01, 0.02}) {
    const double speed = 50.0 * (1.0 + off);
    const Found at = found({.true_rev_s = [&](double) { return speed; }}, 2.0);
    EXPECT_NEAR(at.speed_rev_s / speed, 1.0, 1e-4) << off;
    EXPECT_LT(at.sd, 4e-4) << off;
    EXPECT_LT(std::abs(at.speed_rev_s / speed - 1.0), 3.0 * at.sd) << off;
  }
}

// A spindle that loses a hundredth of its speed as the tool enters, in a fifth of a second.
TEST(SpindleTrack, FollowsASpindleThatDroopsUnderLoad) {
  const auto droops = [](double t) {
    return 60.0 * (1.0 - 0.01 * std::clamp((t - 1.0) / 0.2, 0.0, 1.0));
  };
  for (const double after_s : {0.5, 1.0}) {
    const Found at =
        found({.told_rev_s = 60.0, .true_rev_s = droops, .cuts_from_s = 1.0}, 1.2 + after_s);
    EXPECT_NEAR(at.speed_rev_s / 59.4, 1.0, 3e-4) << after_s;
  }
}

// 1.5 Hz beside an order it would turn that order's phase by a tenth of a turn a block.
TEST(SpindleTrack, IsNotMovedByChatterBesideAnOrder) {
  for (const double beside_hz : {1.5, 6.0, 20.0}) {
    const Found at =
        found({.true_rev_s = [](double) { return 50.0; }, .chatter_hz = 600.0 + beside_hz}, 3.0);
    EXPECT_NEAR(at.speed_rev_s / 50.0, 1.0, 5e-4) << beside_hz;
  }
}

// Loud chatter has a line beside each tooth order, 8 and 13 Hz off: a speed 0.8 or 1.3 % higher
// would have orders there.
TEST(SpindleTrack, IsNotMovedByChatterBesideAllOrders) {
  for (const double beside_hz : {8.0, 13.0}) {
    const Found at = found({.told_rev_s = 100.0,
                            .true_rev_s = [](double) { return 100.0; },
                            .chatter_hz = 1000.0 + beside_hz,
                            .chatter = 2.0,
                            .side_lines = true,
                            .teeth = 2},
                           4.0);
    const double off = std::abs(at.speed_rev_s / 100.0 - 1.0);
    EXPECT_LT(off, 0.003) << beside_hz;
    EXPECT_LT(off, 3.0 * at.sd) << beside_hz;
    EXPECT_GT(at.chatters_s, 2.5) << beside_hz;
  }
}

// Too loud for the orders to be seen: at 0.3 % the speed could put order 22 there. At order 22
// itself it may be runout.
TEST(SpindleTrack, WithoutOrdersALoudLineIsChatterBesideAnOrderNotAtIt) {
  const auto heard = [](double hz) {
    return found({.true_rev_s = [](double) { return 50.0; },
                  .chatter_hz = hz,
                  .chatter = 2.0,
                  .forced = 0.03},
                 3.0)
        .chatters_s;
  };
  EXPECT_GT(heard(1103.5), 1.0);
  EXPECT_EQ(heard(1100.0), 0.0);
}

TEST(SpindleTrack, KnowsInAirThatItKnowsLess) {
  const auto steady = [](double) { return 50.0; };
  const Found air = found({.true_rev_s = steady, .cuts_from_s = 100.0}, 4.0);
  EXPECT_EQ(air.speed_rev_s, 50.0);
  EXPECT_GT(air.sd, 0.00303);  // 0.003² + 4·0.0003²
  EXPECT_LE(air.sd, 0.005);
}

TEST(SpindleTrack, LeavesASpeedThatIsExactAsItIs) {
  const Found at = found({.true_rev_s = [](double) { return 50.4; }, .told_sd = 0.0}, 1.0);
  EXPECT_EQ(at.speed_rev_s, 50.0);
  EXPECT_EQ(at.sd, 0.0);
}

}  // namespace
}  // namespace steadyrest::chatter::online
