// SPDX-License-Identifier: Apache-2.0
// NC text → interpreter → planner → simulated machine → true contour error, against the closed form
// of a circle. The published figures have four digits of a millimetre; run-in and the
// interpolator's chords may cost 1 %.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

namespace steadyrest::trial::cut {
namespace {

using contour::offline::Servo;
using kernel::machine::Machine;

constexpr double kShare = 0.01;
constexpr double kFigure_mm = 5e-5;  ///< half of the last published digit

struct Circle {
  double radius_mm = 10.0;
  double feed_mm_min = 4000.0;
  int turns = 3;
};

struct Measured {
  double least_mm = 1e9;
  double most_mm = -1e9;
  double tracking_mm = 0.0;
  double speed_mm_s = 0.0;
  int samples = 0;
};

// The example's machine with other servos: no friction, no backlash, ideal encoders.
Machine ideal(const Servo& x, const Servo& y) {
  auto machine = passport::read(STEADYREST_SOURCE_DIR "/examples/machines/ideal-k50.toml").value();
  const std::array<Servo, 3> servos = {x, y, x};
  for (std::size_t i = 0; i < servos.size(); ++i) {
    machine.axes[i].servo_gain_1_s = servos[i].gain_1_s;
    machine.axes[i].feed_forward = servos[i].feed_forward;
    machine.axes[i].velocity_lag_s = servos[i].velocity_lag_s;
  }
  return machine;
}

Machine ideal(const Servo& servo) {
  return ideal(servo, servo);
}

std::shared_ptr<const nc::plan::PlannedPath> plan(const Circle& circle, const Machine& machine) {
  const std::string program =
      fmt::format("G17 G21 G90 G94 G61\nG1 X{0} Y0 F{1}\nG3 X{0} Y0 I-{0} J0 P{2}\nM2\n",
                  circle.radius_mm, circle.feed_mm_min, circle.turns);
  nc::plan::PathBuilder builder(machine);
  const auto report = nc::interpret::run_text(program, {}, builder).value();
  EXPECT_TRUE(report.refused.empty());
  return std::make_shared<const nc::plan::PlannedPath>(builder.take().value());
}

/// The errors over whole turns in the middle of the circle, without start and end.
Measured measure(const Circle& circle, const Machine& machine) {
  const auto path = plan(circle, machine);
  const double turn_mm = 2.0 * std::numbers::pi * circle.radius_mm;
  const double from_mm = circle.radius_mm + turn_mm;
  const double to_mm = circle.radius_mm + (circle.turns - 1) * turn_mm;
  Measured out;
  const auto look = [&](const Sample& sample) {
    if (sample.path_position_mm < from_mm || sample.path_position_mm > to_mm) {
      return;
    }
    ++out.samples;
    out.least_mm = std::min(out.least_mm, sample.contour_error_mm);
    out.most_mm = std::max(out.most_mm, sample.contour_error_mm);
    out.tracking_mm = std::max(out.tracking_mm, sample.tracking_error_mm);
    out.speed_mm_s = sample.path_speed_mm_s;
  };
  const auto done = run({.machine = machine, .path = path}, nullptr, look);
  EXPECT_TRUE(done);
  return out;
}

/// Both ends of the error's range: with equal axes it is one value all around.
void expect_error(const Measured& measured, double published_mm) {
  const double allowed_mm = kShare * published_mm + kFigure_mm;
  EXPECT_NEAR(measured.least_mm, published_mm, allowed_mm);
  EXPECT_NEAR(measured.most_mm, published_mm, allowed_mm);
}

// q = 66.7/(10·50) = 0.133: ε = 0.0877 mm, Ed = 1.3216 mm.
TEST(CircleFromText, HasThePublishedErrorsAtF4000) {
  const Measured measured = measure({}, ideal(Servo{}));
  ASSERT_GT(measured.samples, 800);
  expect_error(measured, 0.0877);
  EXPECT_NEAR(measured.tracking_mm, 1.3216, kShare * 1.3216);
}

TEST(CircleFromText, HasThePublishedErrorOfEachGain) {
  expect_error(measure({}, ideal({.gain_1_s = 1000.0 / 60.0})), 0.7152);
  expect_error(measure({}, ideal({.gain_1_s = 2000.0 / 60.0})), 0.1942);
  expect_error(measure({}, ideal({.gain_1_s = 5000.0 / 60.0})), 0.0319);
}

// Gains of 50 and 55 1/s: an ellipse turned by 45°, published from another simulation.
TEST(CircleFromText, BecomesThePublishedEllipseWhereTheGainsDiffer) {
  const Measured measured = measure({}, ideal({.gain_1_s = 50.0}, {.gain_1_s = 55.0}));
  EXPECT_NEAR(measured.least_mm, 0.0206, kShare * 0.0206 + kFigure_mm);
  EXPECT_NEAR(measured.most_mm, 0.1399, kShare * 0.1399 + kFigure_mm);
}

TEST(CircleFromText, HasThePublishedErrorWithHalfTheFeedForward) {
  expect_error(measure({}, ideal({.feed_forward = 0.5})), 0.0656);
}

TEST(CircleFromText, HasThePublishedErrorWithALaggingVelocityLoop) {
  expect_error(measure({}, ideal({.velocity_lag_s = 0.005})), 0.0443);
}

// Through the whole chain: a fault in the parser, the planner or the measurement shows as well as
// one in the servo.
RC_GTEST_PROP(CircleFromText, AgreesWithTheClosedFormAtAnyRadiusFeedAndServo, ()) {
  const Circle circle{.radius_mm = 0.5 * *rc::gen::inRange(4, 100),
                      .feed_mm_min = 100.0 * *rc::gen::inRange(5, 60)};
  const Servo servo{.gain_1_s = 1.0 * *rc::gen::inRange(20, 120),
                    .feed_forward = 0.1 * *rc::gen::inRange(0, 8),
                    .velocity_lag_s = 0.0};
  const Measured measured = measure(circle, ideal(servo));
  const double speed_mm_s = circle.feed_mm_min / 60.0;
  // Beyond this the circle is slower than its F: the axes' acceleration limits it.
  RC_PRE(std::abs(measured.speed_mm_s - speed_mm_s) < 1e-6 * speed_mm_s);
  const auto exact = contour::offline::circle_errors(servo, circle.radius_mm, speed_mm_s).value();
  // 0.02 µm: the chord of one interpolator period.
  const double allowed_mm = kShare * exact.contour_error_mm + 2e-5;
  RC_ASSERT(std::abs(measured.least_mm - exact.contour_error_mm) < allowed_mm);
  RC_ASSERT(std::abs(measured.most_mm - exact.contour_error_mm) < allowed_mm);
  RC_ASSERT(std::abs(measured.tracking_mm - exact.tracking_error_mm) <
            kShare * exact.tracking_error_mm);
}

}  // namespace
}  // namespace steadyrest::trial::cut
