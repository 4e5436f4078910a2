// SPDX-License-Identifier: Apache-2.0
// What the run makes of axes that differ, of feed-forward, backlash and what records have shown.
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/contour/offline/predict/test/axes_run.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::AxesRun;

// (v/2)·sin 2θ·|1/kx − 1/ky|; the softer Y lags, so the tool is to the right of the line upwards.
TEST(ModelRunAxes, UnequalGainsRunBesideALine) {
  AxesRun run("G1 X60 Y60 F3000\n");
  run.model[1].gain_1_s = 40.0;
  for (const ModelSample& sample : run.on_line(2, 0.4)) {
    if (sample.command_mm_s > 49.999) {
      EXPECT_NEAR(sample.error_mm, -0.5 * 50.0 * (1.0 / 40.0 - 1.0 / 50.0), 1e-4);
    }
  }
}

TEST(ModelRunAxes, FeedForwardAndVelocityLagAreThoseOfTheClosedForm) {
  AxesRun run("G0 X10 Y0\nG4 P0.5\nG3 X10 Y0 I-10 J0 P4 F4000\n");
  for (const Servo& servo : {Servo{50.0, 0.5, 0.0}, Servo{50.0, 0.0, 0.005}}) {
    run.model.fill({servo.gain_1_s, servo.feed_forward, servo.velocity_lag_s});
    const double error_mm = circle_errors(servo, 10.0, 4000.0 / 60.0).value().contour_error_mm;
    for (const ModelSample& sample : run.on_line(4, 0.5)) {
      if (sample.command_mm_s > 66.6) {
        EXPECT_NEAR(sample.error_mm, error_mm, 0.01 * error_mm);
      }
    }
  }
}

// X came from 0, so the tool is half of the play short of 30: left of a line upwards.
TEST(ModelRunAxes, BacklashLeavesTheToolShort) {
  AxesRun run("G1 X30 F3000\nG4 P0.5\nY40\n");
  run.backlash_mm = {0.024, 0.0, 0.0};
  for (const ModelSample& sample : run.on_line(4, 0.05)) {
    EXPECT_NEAR(sample.error_mm, 0.012, 1e-6);
    EXPECT_NEAR(sample.off_mm[0], 0.012, 1e-6);
  }
}

TEST(ModelRunAxes, WhatRecordsHaveShownIsAdded) {
  AxesRun run("G1 X60 F3000\n");
  run.unknown = [](double foot_mm) {
    return kernel::signal::Point{0.0, foot_mm > 30.0 ? 0.003 : 0.0, foot_mm > 30.0 ? 0.004 : 0.0};
  };
  for (const ModelSample& sample : run.on_line(2, 0.0)) {
    EXPECT_NEAR(std::abs(sample.error_mm), sample.foot_mm > 30.0 ? 0.005 : 0.0, 1e-6);
  }
}

// Ten samples in a time constant of 20 ms, on a control that computes every 0.5 ms.
TEST(ModelRunAxes, SamplesAreATenthOfALagApart) {
  AxesRun run("G1 X60 F3000\n");
  run.machine.control.interpolator_period_s = 0.0005;
  const auto samples_of_line = run.on_line(2, 0.0);
  for (std::size_t i = 1; i < samples_of_line.size(); ++i) {
    EXPECT_NEAR(samples_of_line[i].time_s - samples_of_line[i - 1].time_s, 0.002, 1e-9);
  }
}

TEST(ModelRunAxes, OfNoPathTakeNoTime) {
  const nc::plan::PlannedPath none;
  const PathMap map;
  const auto seconds = run_model({test::ideal_mill(), none, none, map, {}, {}},
                                 [](const ModelSample&) { FAIL() << "a sample of nothing"; });
  EXPECT_EQ(seconds.value(), 0.0);
}

}  // namespace
}  // namespace steadyrest::contour::offline
