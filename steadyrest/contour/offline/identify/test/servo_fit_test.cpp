// SPDX-License-Identifier: Apache-2.0
// Logs made from the law's own exact solution, so every gain is known.
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;
using testing::HasSubstr;

struct Servo {
  double gain_1_s = 40.0;
  double feed_forward = 0.3;
  double period_s = 0.001;
  int shift = 0;
  double count_mm = 0.0;
  double noise_mm = 0.0;
  double backlash_mm = 0.0;
  double most_mm_s2 = 1e9;  ///< of the drive
};

Axis axis_of(const Servo& servo) {
  Axis axis;
  axis.max_speed_au_s = 500.0;
  axis.min_au = -100.0;
  axis.max_au = 100.0;
  axis.encoder.count_au = servo.count_mm;
  return axis;
}

/// There and back at five speeds, corners rounded to 2000 mm/s².
double lines_mm(double t_s) {
  constexpr double kLeg_s = 0.8;
  constexpr double kRamp_s = 0.04;
  const double leg = std::floor(t_s / kLeg_s);
  const double speed = 8.0 * (1.0 + std::fmod(std::floor(leg / 2.0), 5.0));
  const double t = t_s - leg * kLeg_s;
  const double most_s = 0.6;
  const double a = speed / kRamp_s;
  const double end = most_s - kRamp_s;
  const double way = t < kRamp_s  ? 0.5 * a * t * t
                     : t < end    ? speed * (t - 0.5 * kRamp_s)
                     : t < most_s ? speed * end - 0.5 * a * (most_s - t) * (most_s - t)
                                  : speed * end;
  return std::fmod(leg, 2.0) == 0.0 ? way : speed * end - way;
}

using Command = std::function<double(double)>;

ServoLog log_of(const Servo& servo, double seconds, const Command& command = lines_mm) {
  ServoLog out;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  const double h = servo.period_s;
  const double p = std::exp(-servo.gain_1_s * h);
  const double q = (1.0 - servo.feed_forward) * (1.0 - p) / (servo.gain_1_s * h);
  double motor = command(0.0);
  double table = motor;
  double step = 0.0;
  for (std::size_t n = 0; static_cast<double>(n) * h < seconds; ++n) {
    const double now = static_cast<double>(n) * h;
    const double c = command(std::max(0.0, now - servo.shift * h));
    if (n > static_cast<std::size_t>(servo.shift)) {
      const double before = command(now - (servo.shift + 1) * h);
      const double wanted = c - (p * (before - table) + q * (c - before)) - table;
      const double most = servo.most_mm_s2 * h * h;
      step += std::clamp(wanted - step, -most, most);
      motor += step;
      table = std::clamp(table, motor - servo.backlash_mm / 2, motor + servo.backlash_mm / 2);
    }
    const double seen = table + servo.noise_mm * noise(random);
    out.time_s.push_back(now);
    out.command.push_back(command(now));
    out.actual.push_back(servo.count_mm > 0.0 ? servo.count_mm * std::round(seen / servo.count_mm)
                                              : seen);
  }
  return out;
}

kernel::outcome::Result<ServoFits> fitted(const Servo& servo, const ServoLog& log) {
  return fit_servos({log}, {axis_of(servo)});
}

std::string refusal_of(const Servo& servo, const ServoLog& log) {
  const auto fits = fitted(servo, log);
  return fits ? "accepted" : kernel::outcome::text(fits.error());
}

TEST(ServoFit, IsExactWithoutNoise) {
  for (const double f : {0.0, 0.3, 0.9, 0.99}) {
    const Servo servo{.feed_forward = f};
    const auto fits = fitted(servo, log_of(servo, 8.0));
    ASSERT_TRUE(fits) << fits.error().what;
    EXPECT_NEAR(fits->axes[0].gain_1_s, 40.0, 1e-6);
    EXPECT_NEAR(fits->axes[0].feed_forward, f, 1e-8);
    EXPECT_LT(fits->axes[0].rms, 1e-9);
    EXPECT_LT(fits->axes[0].lost_motion, 1e-9);
    EXPECT_DOUBLE_EQ(fits->period_s, 0.001);
  }
}

// Counts of 1 µm and noise of 2 µm: plain least squares would find a gain 3 % too high. Both are
// within four of the standard deviations that the fit states, and those are no excuses.
TEST(ServoFit, StatesItsOwnAccuracy) {
  for (const double k : {15.0, 40.0, 90.0}) {
    const Servo servo{.gain_1_s = k, .feed_forward = 0.5, .count_mm = 0.001, .noise_mm = 0.002};
    const auto fits = fitted(servo, log_of(servo, 16.0));
    ASSERT_TRUE(fits) << fits.error().what;
    const ServoFit& fit = fits->axes[0];
    EXPECT_NEAR(fit.gain_1_s, k, 4.0 * fit.gain_sd_1_s);
    EXPECT_NEAR(fit.feed_forward, 0.5, 4.0 * fit.feed_forward_sd);
    EXPECT_LT(fit.gain_sd_1_s, 0.005 * k);
    EXPECT_GT(fit.gain_sd_1_s, 1e-6 * k);
    EXPECT_LT(fit.feed_forward_sd, 0.005);
    EXPECT_NEAR(fit.rms, 0.00203, 0.0002);
  }
}

// A tenth of the samples is lost, in gaps of 1 to 300 ms.
TEST(ServoFit, PassesOverLostSamples) {
  const Servo servo{.count_mm = 0.001};
  const ServoLog whole = log_of(servo, 16.0);
  ServoLog log;
  for (std::size_t n = 0; n < whole.time_s.size(); ++n) {
    const std::size_t in_second = n % 2000;
    if ((in_second > 500 && in_second < 700) || in_second == 900 || in_second == 901) {
      continue;
    }
    log.time_s.push_back(whole.time_s[n]);
    log.command.push_back(whole.command[n]);
    log.actual.push_back(whole.actual[n]);
  }
  const auto fits = fitted(servo, log);
  ASSERT_TRUE(fits) << fits.error().what;
  EXPECT_NEAR(fits->axes[0].gain_1_s, 40.0, 0.1);
  EXPECT_NEAR(fits->axes[0].feed_forward, 0.3, 0.003);
}

TEST(ServoFit, FindsTheCommandOneCycleAhead) {
  for (const int shift : {0, 1}) {
    for (const double f : {0.0, 0.6}) {
      const Servo servo{.feed_forward = f, .shift = shift, .count_mm = 0.001};
      const auto fits = fitted(servo, log_of(servo, 16.0));
      ASSERT_TRUE(fits) << fits.error().what;
      EXPECT_EQ(fits->axes[0].shift_cycles, shift) << f;
      EXPECT_NEAR(fits->axes[0].gain_1_s, 40.0, 0.2);
      EXPECT_NEAR(fits->axes[0].feed_forward, f, 0.005);
    }
  }
}

// x⁺ = x + h·k·(c − x) + f·d, as LinuxCNC's pid does.
TEST(ServoFit, TakesASampledLoopToTheOrderOfACycle) {
  Servo servo{.gain_1_s = 20.0};
  ServoLog log = log_of(servo, 16.0);
  double x = 0.0;
  for (std::size_t n = 1; n < log.time_s.size(); ++n) {
    log.actual[n - 1] = x;
    x += 0.001 * 20.0 * (log.command[n - 1] - x) +
         0.5 * (log.command[n - 1] - log.command[n > 1 ? n - 2 : 0]);
  }
  log.actual.back() = x;
  const auto fits = fitted(servo, log);
  ASSERT_TRUE(fits) << fits.error().what;
  EXPECT_NEAR(fits->axes[0].gain_1_s, 20.0, 0.4);
  EXPECT_NEAR(fits->axes[0].feed_forward, 0.5, 0.02);
}

TEST(ServoFit, ShowsBacklashAsLostMotion) {
  const Servo servo{.feed_forward = 0.0, .backlash_mm = 0.02};
  const auto fits = fitted(servo, log_of(servo, 16.0));
  ASSERT_TRUE(fits) << fits.error().what;
  EXPECT_NEAR(fits->axes[0].lost_motion, 0.02, 0.005);
  EXPECT_GT(fits->axes[0].lost_motion, 3.0 * fits->axes[0].lost_motion_sd);
  EXPECT_GE(fits->axes[0].reversals, 10U);
}

RC_GTEST_PROP(ServoFit, FindsAnyServo, ()) {
  const Servo servo{.gain_1_s = 0.1 * *rc::gen::inRange(60, 1500),
                    .feed_forward = 0.01 * *rc::gen::inRange(0, 90),
                    .period_s = *rc::gen::element(0.0005, 0.001, 0.002, 0.004),
                    .shift = *rc::gen::inRange(0, 2),
                    .count_mm = *rc::gen::element(0.0, 0.0001, 0.001)};
  const auto fits = fitted(servo, log_of(servo, 16.0));
  RC_ASSERT(fits.has_value());
  const ServoFit& fit = fits->axes[0];
  RC_ASSERT(std::abs(fit.gain_1_s - servo.gain_1_s) <
            0.01 * servo.gain_1_s + 5.0 * fit.gain_sd_1_s);
  // Where the shift leaves no trace, a cycle of it counts as so much feed-forward.
  const double cycle = fit.shift_cycles == servo.shift ? 0.0 : servo.gain_1_s * servo.period_s;
  RC_ASSERT(std::abs(fit.feed_forward - servo.feed_forward) < 0.01 + cycle);
}

TEST(ServoFit, RefusesTooLittleMotion) {
  const Servo servo;
  EXPECT_THAT(refusal_of(servo, log_of(servo, 3.0, [](double) { return 1.0; })),
              testing::AllOf(HasSubstr("axis X: 0 samples in motion; at least 500"),
                             HasSubstr("servo-test.ngc")));
  EXPECT_THAT(refusal_of(servo, {}), HasSubstr("holds no samples"));
}

// Only the cruise of a long line was recorded.
TEST(ServoFit, RefusesAConstantSpeed) {
  const Servo servo{.count_mm = 0.001};
  ServoLog log = log_of(servo, 5.0, [](double t) { return 10.0 * t; });
  for (auto* column : {&log.time_s, &log.command, &log.actual}) {
    column->erase(column->begin(), column->begin() + 1000);
  }
  EXPECT_THAT(refusal_of(servo, log), HasSubstr("cannot be told apart"));
}

TEST(ServoFit, RefusesAnAxisWithoutFollowingError) {
  const Servo servo{.count_mm = 0.001};
  for (const std::size_t behind : {0U, 1U}) {
    ServoLog log = log_of(servo, 8.0);
    for (std::size_t n = behind; n < log.time_s.size(); ++n) {
      log.actual[n] = log.command[n - behind];
    }
    EXPECT_THAT(refusal_of(servo, log), HasSubstr("follows its command")) << behind;
    EXPECT_THAT(refusal_of(servo, log),
                HasSubstr("at least 0.003 mm of following error (3 counts)"));
    EXPECT_THAT(refusal_of({}, log), HasSubstr("at least 1e-07 mm of following error are"));
  }
}

TEST(ServoFit, RefusesSwappedColumns) {
  const Servo servo{.feed_forward = 0.0, .count_mm = 0.001};
  ServoLog log = log_of(servo, 8.0);
  std::swap(log.command, log.actual);
  EXPECT_THAT(refusal_of(servo, log),
              testing::AnyOf(HasSubstr("does not follow"), HasSubstr("swapped")));
}

TEST(ServoFit, RefusesASaturatedDrive) {
  const Servo servo{.gain_1_s = 30.0, .feed_forward = 0.0, .most_mm_s2 = 350.0};
  EXPECT_THAT(refusal_of(servo, log_of(servo, 8.0)), HasSubstr("at its limit"));
}

TEST(ServoFit, RefusesAnotherAxissPosition) {
  const Servo servo;
  ServoLog log = log_of(servo, 8.0);
  for (std::size_t n = 0; n < log.time_s.size(); ++n) {
    log.actual[n] = 5.0 * std::sin(3.0 * log.time_s[n]);
  }
  EXPECT_THAT(refusal_of(servo, log),
              testing::AnyOf(HasSubstr("is not that of a position loop"),
                             HasSubstr("does not follow"), HasSubstr("told apart")));
}

TEST(ServoFit, RefusesAGainThatChanged) {
  const Servo servo;
  ServoLog log = log_of(servo, 16.0);
  const ServoLog stiff = log_of({.gain_1_s = 60.0}, 16.0);
  for (std::size_t n = 8000; n < log.time_s.size(); ++n) {
    log.actual[n] = stiff.actual[n];
  }
  EXPECT_THAT(refusal_of(servo, log), HasSubstr("halves of the record disagree"));
}

TEST(ServoFit, RefusesWhatTheMachineFileDoesNotAllow) {
  const Servo servo;
  const ServoLog log = log_of(servo, 8.0);
  Axis axis = axis_of(servo);
  axis.max_au = 5.0;
  auto fits = fit_servos({log}, {axis});
  ASSERT_FALSE(fits);
  EXPECT_THAT(fits.error().what, HasSubstr("has its travel"));
  axis = axis_of(servo);
  axis.max_speed_au_s = 10.0;
  fits = fit_servos({log}, {axis});
  ASSERT_FALSE(fits);
  EXPECT_THAT(fits.error().what, HasSubstr("moves faster"));
}

// The layer's own model ends at 1; a fit that is above it by its uncertainty is 1.
TEST(ServoFit, RefusesMoreFeedForwardThanTheLayerTakes) {
  const Servo slightly{.feed_forward = 1.02};
  const auto fits = fitted(slightly, log_of(slightly, 8.0));
  ASSERT_TRUE(fits) << fits.error().what;
  EXPECT_EQ(fits->axes[0].feed_forward, 1.0);
  const Servo far{.feed_forward = 1.2};
  EXPECT_THAT(refusal_of(far, log_of(far, 8.0)), HasSubstr("feed-forward 1.2"));
}

TEST(ServoFit, RefusesAnUnevenCycle) {
  const Servo servo;
  ServoLog log = log_of(servo, 8.0);
  for (std::size_t n = 0; n < log.time_s.size(); ++n) {
    log.time_s[n] += 0.0003 * std::sin(static_cast<double>(n * n));
  }
  EXPECT_THAT(refusal_of(servo, log), HasSubstr("not evenly spaced"));
}

}  // namespace
}  // namespace steadyrest::contour::offline
