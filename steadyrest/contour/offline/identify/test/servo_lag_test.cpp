// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_lag.hpp>

namespace steadyrest::contour::offline {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Lagging {
  double gain_1_s = 20.0;
  double feed_forward = 0.0;
  double lag_s = 0.015;
  double count_mm = 0.001;
};

/// T·x" + x' = k·(c − x) + f·c', in steps of a twentieth of the cycle; lines and circles at several
/// feeds.
ServoLog log_of(const Lagging& axis) {
  constexpr double kPeriod_s = 0.001;
  constexpr int kSteps = 20;
  constexpr double kStep_s = kPeriod_s / kSteps;
  const auto command = [](double t) {
    return 8.0 * std::sin(2.0 * t) + 3.0 * std::sin(9.0 * t) + 0.4 * std::sin(31.0 * t);
  };
  ServoLog out;
  double x = 0.0;
  double v = 0.0;
  for (int n = 0; n < 8000; ++n) {
    const double t = n * kPeriod_s;
    out.time_s.push_back(t);
    out.command.push_back(command(t));
    out.actual.push_back(axis.count_mm * std::round(x / axis.count_mm));
    for (int i = 0; i < kSteps; ++i) {
      const double now = t + i * kStep_s;
      const double asked = axis.gain_1_s * (command(now) - x) +
                           axis.feed_forward * (command(now + kStep_s) - command(now)) / kStep_s;
      v += kStep_s / axis.lag_s * (asked - v);
      x += kStep_s * v;
    }
  }
  return out;
}

kernel::machine::Axis x_axis(double count_mm) {
  kernel::machine::Axis out;
  out.max_speed_au_s = 500.0;
  out.min_au = -100.0;
  out.max_au = 100.0;
  out.encoder.count_au = count_mm;
  return out;
}

TEST(ServoLag, IsFoundWithItsGain) {
  for (const Lagging& axis :
       {Lagging{}, Lagging{.lag_s = 0.005}, Lagging{.lag_s = 0.04},
        Lagging{.gain_1_s = 50.0, .lag_s = 0.005}, Lagging{.feed_forward = 0.8}}) {
    const ServoLog log = log_of(axis);
    const ServoRun all{0, log.time_s.size()};
    const auto seen = velocity_lag(log, std::span(&all, 1), 0.001, 0);
    ASSERT_TRUE(seen) << axis.lag_s;
    EXPECT_NEAR(seen->lag_s, axis.lag_s, 0.1 * axis.lag_s + 0.0005);
    EXPECT_NEAR(seen->gain_1_s, axis.gain_1_s, 0.1 * axis.gain_1_s);
  }
}

TEST(ServoLag, IsNamedWhereTheFitKnowsNone) {
  for (const double lag_s : {0.005, 0.015, 0.03}) {
    const Lagging axis{.lag_s = lag_s};
    const auto fit = fit_servos({log_of(axis)}, {x_axis(axis.count_mm)});
    if (fit) {  // short lags pass for a lower gain
      EXPECT_LT(lag_s, 0.01);
      continue;
    }
    EXPECT_THAT(fit.error().what, HasSubstr("its velocity loop lags by about"));
    EXPECT_THAT(fit.error().to_do, Not(HasSubstr("swapped")));
  }
  const Lagging axis{.lag_s = 0.015};
  EXPECT_THAT(fit_servos({log_of(axis)}, {x_axis(axis.count_mm)}).error().what,
              AllOf(HasSubstr("about 15 ms"), HasSubstr("gain about 20 1/s")));
}

TEST(ServoLag, OnlyALeadingPositionMayBeSwapped) {
  ServoLog log = log_of({.lag_s = 0.001});
  const ServoRun all{0, log.time_s.size()};
  EXPECT_THAT(to_check(log, std::span(&all, 1), 0.001),
              AllOf(HasSubstr("behind the command"), Not(HasSubstr("swapped"))));
  std::swap(log.command, log.actual);
  EXPECT_THAT(to_check(log, std::span(&all, 1), 0.001), HasSubstr("leads the command"));
  EXPECT_FALSE(velocity_lag(log, std::span(&all, 1), 0.001, 0));
}

}  // namespace
}  // namespace steadyrest::contour::offline
