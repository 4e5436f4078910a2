// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/servo_model.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::signal::Frame;
using math::geometry::test::number;

/// One axis of the true machine, integrated finely by the midpoint rule.
class TrueAxis {
 public:
  TrueAxis(AxisModel model, double count_mm) : model_(model), count_mm_(count_mm) {}
  /// Moves to time t along a commanded motion.
  double step(double t0, double t1, const std::function<double(double)>& command) {
    constexpr int kSub = 12;
    const double h = (t1 - t0) / kSub;
    for (int i = 0; i < kSub; ++i) {
      const double t = t0 + h * i;
      const double speed = (command(t + h) - command(t)) / h;
      const double middle = command(t + 0.5 * h);
      if (model_.velocity_lag_s == 0.0) {
        const double share = 1.0 - std::exp(-model_.gain_1_s * h);
        const double goal = middle + model_.feed_forward * speed / model_.gain_1_s;
        x_ += (goal - x_) * share;
      } else {
        const auto rate = [&](double x, double v) {
          return (model_.gain_1_s * (middle - x) + model_.feed_forward * speed - v) /
                 model_.velocity_lag_s;
        };
        const double vm = v_ + 0.5 * h * rate(x_, v_);
        const double xm = x_ + 0.5 * h * v_;
        x_ += h * vm;
        v_ += h * rate(xm, vm);
      }
    }
    return count_mm_ > 0.0 ? std::round(x_ / count_mm_) * count_mm_ : x_;
  }

 private:
  AxisModel model_;
  double count_mm_;
  double x_ = 0.0;
  double v_ = 0.0;
};

ServoModel model_with(AxisModel prior, double count_mm = 0.001) {
  ServoModel::Config config;
  config.axes = 1;
  config.prior[0] = prior;
  config.count_mm[0] = count_mm;
  return ServoModel::make(config).value();
}

void run(ServoModel& model, TrueAxis& axis, double seconds, double period,
         const std::function<double(double)>& command, double begin = 0.0) {
  const int count = static_cast<int>(std::lround(seconds / period));
  for (int i = 1; i <= count; ++i) {
    const double t = begin + i * period;
    Frame frame;
    frame.time_s = t;
    frame.axis[0].command_mm = command(t);
    frame.axis[0].actual_mm = axis.step(t - period, t, command);
    model.update(frame);
  }
}

// Constant speed shows only (1 − a)/k; with the prior's a = 0 that is k, so it must be within 1 %
// of 42 after ten windows of 40 ms.
TEST(ServoModel, AWrongPassportIsCorrectedWithinThreeTenthsOfASecond) {
  ServoModel model = model_with({50.0, 0.0, 0.0});
  TrueAxis axis({42.0, 0.0, 0.0}, 0.001);
  const auto ramp = [](double t) { return 30.0 * t; };
  run(model, axis, 0.1, 0.001, ramp);
  run(model, axis, 0.3, 0.001, ramp, 0.1);
  EXPECT_NEAR(model.axis(0).gain_1_s, 42.0, 0.42);
}

RC_GTEST_PROP(ServoModel, FindsGainAndFeedForwardWhenTheMotionExcitesBoth, ()) {
  const AxisModel truth{*number(25.0, 90.0), *number(0.0, 0.9), 0.0};
  ServoModel model = model_with(
      {truth.gain_1_s * *number(0.75, 1.3), truth.feed_forward + *number(0.0, 0.08), 0.0});
  TrueAxis axis(truth, 0.0001);
  // A circle's axis at strongly varying frequency: e and v are out of phase.
  const auto motion = [](double t) {
    return 8.0 * std::sin(9.0 * t) + 3.0 * std::sin(31.0 * t) + 20.0 * t;
  };
  run(model, axis, 2.0, 0.001, motion);
  RC_ASSERT(std::abs(model.axis(0).gain_1_s / truth.gain_1_s - 1.0) < 0.04);
  RC_ASSERT(std::abs(model.axis(0).feed_forward - truth.feed_forward) < 0.03);
}

// The split may be the prior's; the lag (1 − a)/k that the axis shows may not.
RC_GTEST_PROP(ServoModel, TheLagIsRightEvenWhereGainAndFeedForwardCannotBeSeparated, ()) {
  const AxisModel truth{*number(25.0, 90.0), *number(0.0, 0.5),
                        *rc::gen::element(0.0, 0.002, 0.005)};
  ServoModel model =
      model_with({truth.gain_1_s * *number(0.7, 1.4), truth.feed_forward, truth.velocity_lag_s});
  TrueAxis axis(truth, 0.001);
  const double speed = *number(10.0, 60.0);
  run(model, axis, 1.5, *rc::gen::element(0.001, 0.002, 0.004),
      [speed](double t) { return speed * t; });
  const double lag = (1.0 - truth.feed_forward) / truth.gain_1_s;
  const double found = (1.0 - model.axis(0).feed_forward) / model.axis(0).gain_1_s;
  RC_ASSERT(std::abs(found / lag - 1.0) < 0.015);
}

// Fifteen thousand rows without new information. Plain recursive least squares would lose all
// information across them and then jump with the first noise (wind-up).
TEST(ServoModel, TenMinutesOfConstantSpeedDoNotWindUp) {
  ServoModel model = model_with({50.0, 0.2, 0.0});
  TrueAxis axis({50.0, 0.2, 0.0}, 0.001);
  run(model, axis, 600.0, 0.01, [](double t) { return 5.0 * t; });
  EXPECT_NEAR(model.axis(0).gain_1_s, 50.0, 1.0);
  EXPECT_NEAR(model.axis(0).feed_forward, 0.2, 0.01);
  // The information about the direction that constant speed does not show stays at the prior's.
  EXPECT_LT(model.state().axis[0].l22, 1e9);
}

// The true gain is 20: had one row been taken, the model would have moved.
TEST(ServoModel, StandstillAndReversalTeachNothing) {
  ServoModel model = model_with({50.0, 0.0, 0.0});
  TrueAxis axis({20.0, 0.0, 0.0}, 0.001);
  run(model, axis, 1.0, 0.001, [](double) { return 0.0; });
  run(model, axis, 1.0, 0.001, [](double t) { return 0.1 * std::sin(200.0 * t); }, 1.0);
  EXPECT_EQ(model.state().axis[0].rows, 0u);
  EXPECT_EQ(model.axis(0).gain_1_s, 50.0);
}

// Positions of ± 800 mm at random, some NaN: the box holds whatever the rows say.
TEST(ServoModel, NeverLeavesItsBoundsWhateverItIsFed) {
  ServoModel model = model_with({50.0, 0.0, 0.0});
  std::uint32_t noise = 1;
  for (int i = 1; i < 20000; ++i) {
    noise = noise * 1664525u + 1013904223u;
    Frame frame;
    frame.time_s = i * 0.001;
    frame.axis[0].command_mm = i * 0.05;
    frame.axis[0].actual_mm =
        i % 977 == 0 ? std::numeric_limits<double>::quiet_NaN() : (noise >> 8) * 1e-4 - 800.0;
    model.update(frame);
    ASSERT_GE(model.axis(0).gain_1_s, 50.0 / 3.0);
    ASSERT_LE(model.axis(0).gain_1_s, 150.0);
    ASSERT_GE(model.axis(0).feed_forward, 0.0);
    ASSERT_LE(model.axis(0).feed_forward, 1.0);
  }
}

// 200 mm/s² demanded from a drive that has 100: the axis law does not hold.
TEST(ServoModel, ASaturatedDriveTeachesNothing) {
  ServoModel::Config config;
  config.axes = 1;
  config.drive_mm_s2[0] = 100.0;
  ServoModel model = ServoModel::make(config).value();
  TrueAxis axis({20.0, 0.0, 0.0}, 0.0);
  run(model, axis, 1.0, 0.001, [](double t) { return 100.0 * t * t; });
  EXPECT_EQ(model.state().axis[0].rows, 0u);
}

TEST(ServoModel, LearnsBelowFourFifthsOfTheDrivesLimitAndNotAbove) {
  const auto rows = [](double acceleration_mm_s2) {
    ServoModel::Config config;
    config.axes = 1;
    config.drive_mm_s2[0] = 100.0;
    ServoModel model = ServoModel::make(config).value();
    TrueAxis axis({50.0, 0.0, 0.0}, 0.0);
    run(model, axis, 1.0, 0.001,
        [=](double t) { return 0.5 * acceleration_mm_s2 * (t + 1.0) * (t + 1.0); });
    return model.state().axis[0].rows;
  };
  EXPECT_GT(rows(75.0), 0U);
  EXPECT_EQ(rows(88.0), 0U);
}

TEST(ServoModel, NeedsFiftiethsOfAMillimetreOfTravelInAWindow) {
  const auto rows = [](double speed_mm_s) {
    ServoModel model = model_with({50.0, 0.0, 0.0});
    TrueAxis axis({50.0, 0.0, 0.0}, 0.0);
    run(model, axis, 1.0, 0.001, [=](double t) { return speed_mm_s * t; });
    return model.state().axis[0].rows;
  };
  EXPECT_EQ(rows(0.015 / 0.040), 0U);
  EXPECT_GT(rows(0.025 / 0.040), 0U);
}

TEST(ServoModel, AMissingSampleEndsTheWindowAndALateOneDoesNot) {
  const auto rows = [](double thirtieth_s) {
    ServoModel model = model_with({50.0, 0.0, 0.0});
    Frame frame;
    for (int i = 1; i <= 1000; ++i) {
      frame.time_s += i % 30 == 0 ? thirtieth_s : 0.001;
      frame.axis[0].command_mm = 30.0 * frame.time_s;
      frame.axis[0].actual_mm = frame.axis[0].command_mm - 0.6;
      model.update(frame);
    }
    return model.state().axis[0].rows;
  };
  EXPECT_EQ(rows(0.002), 0U);  // 29 ms are left, a window takes 40
  EXPECT_GT(rows(0.0018), 0U);
}

// The layer was stopped for 150 ms on a circle, at any place of a window.
TEST(ServoModel, APauseTeachesNothingWhereverItBegins) {
  for (int place = 0; place < 90; ++place) {
    ServoModel model = model_with({20.0, 0.0, 0.0});
    TrueAxis axis({20.0, 0.0, 0.0}, 0.0001);
    const auto circle = [](double t) { return 20.0 * std::sin(3.33 * t); };
    const double until = 0.5 + 0.001 * place;
    run(model, axis, until, 0.001, circle);
    (void)axis.step(until, until + 0.149, circle);
    double worst = 0.0;
    for (int i = 0; i < 100; ++i) {
      run(model, axis, 0.001, 0.001, circle, until + 0.149 + 0.001 * i);
      worst = std::max(worst, std::abs(model.axis(0).gain_1_s - 20.0));
    }
    EXPECT_LT(worst, 0.1) << place;
  }
}

// 1 ms, then 4 ms for good.
TEST(ServoModel, LearnsOnWithASlowerClock) {
  ServoModel model = model_with({50.0, 0.0, 0.0});
  TrueAxis axis({42.0, 0.0, 0.0}, 0.0005);
  const auto ramp = [](double t) { return 30.0 * t; };
  run(model, axis, 0.01, 0.001, ramp);
  run(model, axis, 0.8, 0.004, ramp, 0.01);
  EXPECT_NEAR(model.axis(0).gain_1_s, 42.0, 0.42);
}

TEST(ServoModel, RefusesAGainOutsideOfItsRange) {
  ServoModel::Config config;
  config.prior[1].gain_1_s = 0.0;
  EXPECT_FALSE(ServoModel::make(config).has_value());
}

}  // namespace
}  // namespace steadyrest::contour::online
