// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/online/sensor_watch.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Temperatures;
using kernel::units::kNan;

constexpr double kHour = 3600.0;

/// A machine whose sensor 1 warms and cools by 8 K in 3 h with noise; sensor 0 is `first`; both as
/// functions of the hours since the start.
class Watched {
 public:
  explicit Watched(std::function<double(double)> first) : first_(std::move(first)) {}

  /// The first hour at which sensor 0 is not believed; NaN: never.
  double doubted_at_h(double until_h, Reason reason) {
    double at_h = kNan;
    for (; hours_ < until_h; hours_ += 10.0 / kHour) {
      step();
      const Reason fault = watch_.fault(0);
      if (fault != Reason::none && std::isnan(at_h)) {
        EXPECT_EQ(fault, reason);
        at_h = hours_;
      }
      EXPECT_EQ(watch_.fault(1), Reason::none);
    }
    return at_h;
  }
  bool believed() { return watch_.fault(0) == Reason::none; }

 private:
  void step() {
    Temperatures now = kernel::signal::unknown_temperatures();
    now[0] = first_(hours_);
    now[1] = 24.0 + 4.0 * std::sin(hours_ * 2.1) + 0.02 * normal_(random_);
    watch_.update(10.0, 2, now);
    EXPECT_EQ(std::isnan(now[0]), watch_.fault(0) != Reason::none || std::isnan(first_(hours_)));
  }

  std::function<double(double)> first_;
  SensorWatch watch_;
  double hours_ = 0.0;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

double in_steps(double value, double step) {
  return step * std::round(value / step);
}

// A daily swing plus a small one of a few minutes, with no two values alike: a fine sensor.
double fine(double hours) {
  return 20.0 + 1.5 * std::sin(hours * 0.26) + 0.013 * std::sin(hours * 977.0);
}

TEST(SensorWatch, AFineSensorThatStopsToMoveIsStuckAfterTwoHours) {
  Watched watched([](double hours) { return fine(std::min(hours, 5.0)); });
  const double at_h = watched.doubted_at_h(12.0, Reason::thermal_sensor_stuck);
  // It stops at 5 h and must be silent for 2 h.
  EXPECT_GT(at_h, 6.99);
  EXPECT_LT(at_h, 10.0) << "two hours, and until the other has moved";
}

TEST(SensorWatch, AFineSensorThatNeverMovesIsStuckToo) {
  Watched watched([](double) { return 21.373; });
  EXPECT_NEAR(watched.doubted_at_h(8.0, Reason::thermal_sensor_stuck), 2.0, 0.1);
}

// The false alarm that matters: in a temperature-controlled room a 0.1 K sensor repeats itself for
// days, and calling it stuck would switch the correction off where it works best.
TEST(SensorWatch, ARoomThatIsHeldIsNotCalledStuckByACoarseSensor) {
  for (const double step : {0.05, 0.0625, 0.1, 0.25, 0.5, 1.0}) {
    Watched never([&](double) { return in_steps(20.2, step); });
    EXPECT_TRUE(std::isnan(never.doubted_at_h(72.0, Reason::none))) << step;
    // It crosses a step now and then, seven hours apart at most.
    Watched seldom([&](double hours) {
      return in_steps(20.0, step) + (std::fmod(hours, 12.0) > 5.0 ? step : 0.0);
    });
    EXPECT_TRUE(std::isnan(seldom.doubted_at_h(72.0, Reason::none))) << step;
  }
  Watched fahrenheit([](double) { return (68.3 - 32.0) / 1.8; });
  EXPECT_TRUE(std::isnan(fahrenheit.doubted_at_h(72.0, Reason::none)));
  Watched single([](double) { return static_cast<double>(21.3F); });
  EXPECT_TRUE(std::isnan(single.doubted_at_h(72.0, Reason::none)));
}

TEST(SensorWatch, ACoarseSensorThatMovedAndStopsIsStuckAfterEightHours) {
  Watched watched([](double hours) { return in_steps(fine(std::min(hours, 10.0)), 0.1); });
  const double at_h = watched.doubted_at_h(30.0, Reason::thermal_sensor_stuck);
  // 10 h and 8 h later, less the time that its last step had lasted.
  EXPECT_GT(at_h, 17.0);
  EXPECT_LT(at_h, 21.0);
}

TEST(SensorWatch, IsStuckAfterThreeTimesTheLongestStandThatItHasShown) {
  // It is stuck from 2 h to 3.5 h and moves again; at 5 h it stops.
  Watched watched(
      [](double hours) { return fine(hours > 2.0 && hours < 3.5 ? 2.0 : std::min(hours, 5.0)); });
  EXPECT_NEAR(watched.doubted_at_h(15.0, Reason::thermal_sensor_stuck), 5.0 + 3.0 * 1.5, 0.1);
}

TEST(SensorWatch, IsStuckOnlyBesideTwoExcursionsOfAKelvin) {
  const auto stuck_beside = [](const std::function<double(double)>& other) {
    SensorWatch watch;
    for (int i = 0; i < 8 * 360; ++i) {
      const double hours = i / 360.0;
      Temperatures now = kernel::signal::unknown_temperatures();
      now[0] = 21.373;
      now[1] = other(hours) + 0.013 * std::sin(hours * 977.0);
      watch.update(10.0, 2, now);
    }
    return watch.fault(0) == Reason::thermal_sensor_stuck;
  };
  const auto up = [](double hours) { return 24.0 + 1.5 * std::min(hours, 1.0); };
  EXPECT_FALSE(stuck_beside(up));
  EXPECT_TRUE(stuck_beside([&](double hours) { return hours < 2.0 ? up(hours) : 24.0; }));
  EXPECT_FALSE(stuck_beside([](double hours) { return 24.0 + 0.4 * std::sin(hours * 6.0); }));
}

// A closed shop over a weekend: silence is a fault only while others speak.
TEST(SensorWatch, NobodyIsStuckInAMachineThatIsAllStill) {
  SensorWatch watch;
  for (int i = 0; i < 72 * 360; ++i) {
    Temperatures now = kernel::signal::unknown_temperatures();
    now[0] = 20.137;
    now[1] = 20.211;
    watch.update(10.0, 2, now);
    ASSERT_EQ(watch.fault(0), Reason::none);
    ASSERT_EQ(watch.fault(1), Reason::none);
  }
}

TEST(SensorWatch, IsBelievedAgainWhenItMoves) {
  Watched watched([](double hours) { return hours < 9.0 ? 21.373 : 21.391; });
  EXPECT_FALSE(std::isnan(watched.doubted_at_h(9.0, Reason::thermal_sensor_stuck)));
  EXPECT_FALSE(watched.believed());
  watched.doubted_at_h(9.1, Reason::thermal_sensor_stuck);
  EXPECT_TRUE(watched.believed());
}

TEST(SensorWatch, WhatNoMachineShowsIsWild) {
  for (const double value : {-40.0, 85.0, 127.0, 1e300, -1e300}) {
    Watched watched([&](double hours) { return hours < 1.0 ? fine(hours) : value; });
    EXPECT_NEAR(watched.doubted_at_h(2.0, Reason::thermal_sensor_wild), 1.0, 0.01) << value;
  }
  Watched from_the_start([](double hours) { return hours < 1.0 ? 85.0 : fine(hours); });
  EXPECT_EQ(from_the_start.doubted_at_h(0.9, Reason::thermal_sensor_wild), 0.0);
  from_the_start.doubted_at_h(1.1, Reason::thermal_sensor_wild);
  EXPECT_TRUE(from_the_start.believed());
}

TEST(SensorWatch, ItsRangeEndsTwentyBelowAndEightyAbove) {
  const auto doubted = [](double value_c) {
    Watched watched([=](double hours) { return value_c + 0.013 * std::sin(hours * 977.0); });
    return !std::isnan(watched.doubted_at_h(0.9, Reason::thermal_sensor_wild));
  };
  EXPECT_TRUE(doubted(-25.0));
  EXPECT_FALSE(doubted(-15.0));
  EXPECT_FALSE(doubted(75.0));
  EXPECT_TRUE(doubted(85.0));
}

TEST(SensorWatch, AStepBelowThreeKelvinIsBelieved) {
  Watched watched([](double hours) { return fine(hours) + (hours < 1.0 ? 0.0 : 2.9); });
  EXPECT_TRUE(std::isnan(watched.doubted_at_h(1.4, Reason::none)));
}

TEST(SensorWatch, AStepIsWildUntilAMachineCouldHaveComeThatFar) {
  Watched watched([](double hours) { return fine(hours) + (hours < 1.0 ? 0.0 : 8.0); });
  EXPECT_NEAR(watched.doubted_at_h(1.4, Reason::thermal_sensor_wild), 1.0, 0.01);
  // The follower takes 1 K of the 8; the 4 K beyond 3 K take 0.4 h at 10 K/h.
  EXPECT_FALSE(watched.believed()) << "3 K and 10 K in an hour";
  watched.doubted_at_h(1.7, Reason::thermal_sensor_wild);
  EXPECT_TRUE(watched.believed());
}

// A follower that chased the spike would doubt the good readings after it.
TEST(SensorWatch, ASpikeIsLeftOutAndLeavesNothingBehind) {
  Watched watched(
      [](double hours) { return fine(hours) + (hours > 1.0 && hours < 1.02 ? 30.0 : 0.0); });
  EXPECT_NEAR(watched.doubted_at_h(1.01, Reason::thermal_sensor_wild), 1.0, 0.01);
  watched.doubted_at_h(1.03, Reason::thermal_sensor_wild);
  EXPECT_TRUE(watched.believed());
}

TEST(SensorWatch, WhatMachinesDoIsBelieved) {
  // A door in winter, noise of half a kelvin, a spindle that warms by 5 K in a minute, and a sensor
  // unknown for an hour of warming.
  Watched door([](double hours) { return 20.0 - 12.0 * (1.0 - std::exp(-hours / 0.1)); });
  EXPECT_TRUE(std::isnan(door.doubted_at_h(3.0, Reason::none)));
  Watched noise([](double hours) { return 20.0 + 0.5 * std::sin(hours * 1e5); });
  EXPECT_TRUE(std::isnan(noise.doubted_at_h(3.0, Reason::none)));
  Watched spindle([](double hours) { return 20.0 + std::min(30.0, 300.0 * hours); });
  EXPECT_TRUE(std::isnan(spindle.doubted_at_h(3.0, Reason::none)));
  Watched gap([](double hours) { return hours > 1.0 && hours < 2.0 ? kNan : 20.0 + 5.0 * hours; });
  EXPECT_TRUE(std::isnan(gap.doubted_at_h(3.0, Reason::none)));
}

TEST(SensorWatch, ItsStateGoesOnAfterARestart) {
  SensorWatch first;
  // One runs on, the other is saved and restored now and then; both must reach the same verdict.
  SensorWatch second;
  for (int i = 0; i < 5 * 360; ++i) {
    for (SensorWatch* const watch : {&first, &second}) {
      Temperatures now = kernel::signal::unknown_temperatures();
      now[0] = 21.373;
      now[1] = 24.0 + 4.0 * std::sin(i * 0.006);
      watch->update(10.0, 2, now);
    }
    if (i % 100 == 0) {
      const auto state = second.state();
      second.reset();
      second.restore(state);
    }
  }
  EXPECT_EQ(first.fault(0), Reason::thermal_sensor_stuck);
  EXPECT_EQ(second.fault(0), Reason::thermal_sensor_stuck);
  auto state = second.state();
  state.sensor[0].follower_c = kNan;
  second.restore(state);
  EXPECT_EQ(second.fault(0), Reason::none) << "starts over";
}

TEST(SensorWatch, DoesNotAllocate) {
  SensorWatch watch;
  Temperatures now = kernel::signal::unknown_temperatures();
  now[3] = 20.0;
  const kernel::rt::testing::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    now[0] = 20.0 + i % 7;
    watch.update(1.0, now.size(), now);
  }
  watch.restore(watch.state());
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::thermal::online
