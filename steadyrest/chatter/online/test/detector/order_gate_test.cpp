// SPDX-License-Identifier: Apache-2.0
// Lines of known frequency against the orders of a spindle of known speed.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/orders/order_gate.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kHop_s = 0.0125;

struct Scene {
  OrderGate::Config config{.sample_rate_hz = 8e3, .bin_hz = 10.0, .teeth = 4};
  double speed_rev_s = 50.0;
  double speed_sd = 0.0;
  bool clipped = false;
};

/// A line at `hz`, as a spectrum without noise sees it for `seconds`.
OrderGate::Output after(double hz, double seconds, const Scene& scene) {
  OrderGate gate(scene.config);
  OrderGate::Output out;
  const int hops = static_cast<int>(std::lround(seconds / kHop_s));
  for (int i = 0; i <= hops; ++i) {
    out = gate.look({.frequency_hz = hz,
                     .advance_turns = std::remainder(hz * kHop_s, 1.0),
                     .seconds = i == 0 ? 0.0 : kHop_s,
                     .energy = 1.0},
                    {.orders = {}, .learning = true, .clipped = scene.clipped}, scene.speed_rev_s,
                    scene.speed_sd);
  }
  return out;
}

TEST(OrderGate, ALineAtAnOrderIsForcedHoweverLongItIsFollowed) {
  for (const double seconds : {0.0, 0.1, 0.5, 3.0}) {
    const auto out = after(650.0, seconds, {});
    EXPECT_TRUE(out.forced) << seconds;
    EXPECT_EQ(out.order, 13.0);
    EXPECT_NEAR(out.off_hz, 0.0, 1e-9);
  }
}

// 0.2 of a bin is 2 Hz; then its phase says more: 0.2 turns at 1 Hz take 0.2 s.
TEST(OrderGate, ALineBesideAnOrderIsToldApartByItsPhase) {
  EXPECT_FALSE(after(653.0, 0.0, {}).forced);
  EXPECT_TRUE(after(651.0, 0.0, {}).forced);
  EXPECT_TRUE(after(651.0, 0.15, {}).forced);
  const auto out = after(651.0, 0.25, {});
  EXPECT_FALSE(out.forced);
  EXPECT_NEAR(out.off_hz, 1.0, 1e-6);
  EXPECT_TRUE(after(650.3, 0.5, {}).forced);
  EXPECT_FALSE(after(650.5, 0.5, {}).forced);
}

// Order 13 is 13 times as uncertain as the speed: 13·3·0.002·50 = 3.9 Hz.
TEST(OrderGate, AnUncertainSpeedWidensWhatIsForced) {
  EXPECT_TRUE(after(654.0, 0.5, {.speed_sd = 0.002}).forced);
  EXPECT_FALSE(after(655.0, 0.5, {.speed_sd = 0.002}).forced);
  EXPECT_FALSE(after(654.0, 0.5, {.speed_sd = 0.0005}).forced);
}

// 24 tooth orders of 4 teeth: order 96 at 4800 Hz is heard at 1651 − 1497.. of 1651: |4800 −
// 3·1651|.
TEST(OrderGate, AFoldIsForcedWhereTheSensorHasNoFilter) {
  Scene scene{.config = {.sample_rate_hz = 1651.0, .bin_hz = 12.9, .teeth = 4, .folds = true}};
  for (const double order : {20.0, 24.0, 40.0, 60.0, 96.0}) {
    const double hz = order * 50.0;
    const double heard = std::abs(hz - 1651.0 * std::round(hz / 1651.0));
    const auto out = after(heard, 0.5, scene);
    EXPECT_TRUE(out.forced) << order;
    scene.config.folds = false;
    const bool at_order = std::abs(heard - 50.0 * std::round(heard / 50.0)) < 0.4;
    EXPECT_EQ(after(heard, 0.5, scene).forced, at_order) << order;
    scene.config.folds = true;
  }
}

// A mode of the sensor shows the 67th and the 68th order; 3375 Hz lies between them.
TEST(OrderGate, HighOrdersAreForcedToo) {
  EXPECT_TRUE(after(3400.0, 0.3, {}).forced);
  EXPECT_TRUE(after(3350.0, 0.3, {}).forced);
  EXPECT_FALSE(after(3375.0, 0.3, {}).forced);
}

TEST(OrderGate, ALineThatBecomesAnotherIsFollowedAnew) {
  OrderGate gate({.sample_rate_hz = 8e3, .bin_hz = 10.0, .teeth = 4});
  for (const double hz : {670.0, 670.0, 670.0, 670.0, 1250.0}) {
    const auto& out = gate.look(
        {.frequency_hz = hz, .advance_turns = std::remainder(hz * kHop_s, 1.0), .seconds = kHop_s},
        {}, 50.0, 0.0);
    EXPECT_EQ(out.forced, hz == 1250.0);
  }
}

}  // namespace
}  // namespace steadyrest::chatter::online
