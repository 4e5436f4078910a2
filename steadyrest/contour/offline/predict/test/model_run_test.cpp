// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Machine;
using nc::plan::PlannedPath;
using test::ideal_mill;

constexpr double kRadius_mm = 10.0;
constexpr double kSpeed_mm_s = 4000.0 / 60.0;

std::string circle(double radius_mm, double feed_mm_min, int turns = 4) {
  const auto number = [](double value) { return std::to_string(value); };
  return "G21 G90 G94 G17 G64\nG0 X" + number(radius_mm) + " Y0\nG3 X" + number(radius_mm) +
         " Y0 I-" + number(radius_mm) + " J0 P" + std::to_string(turns) + " F" +
         number(feed_mm_min) + "\nM2\n";
}

/// The samples between these times.
std::vector<ModelSample> samples(const ModelRun& run, double from_s, double to_s) {
  std::vector<ModelSample> out;
  EXPECT_TRUE(run_model(run, [&](const ModelSample& sample) {
                if (sample.time_s > from_s && sample.time_s < to_s) {
                  out.push_back(sample);
                }
              }).has_value());
  return out;
}

TEST(ModelRun, HasTheClosedFormsErrorOnACircle) {
  const Machine machine = ideal_mill();
  const PlannedPath path = test::planned_text(machine, circle(kRadius_mm, 4000.0));
  const auto expected = circle_errors({.gain_1_s = 50.0}, kRadius_mm, kSpeed_mm_s).value();
  const auto found = samples({.machine = machine,
                              .path = path,
                              .original = path,
                              .map = same_path(path),
                              .model = servo_models(machine.axes),
                              .others = {}},
                             1.0, 2.0);
  ASSERT_GT(found.size(), 100U);
  for (const ModelSample& sample : found) {
    EXPECT_NEAR(sample.error_mm, expected.contour_error_mm, 1e-4);
    EXPECT_TRUE(sample.cuts);
    EXPECT_EQ(sample.line, 3U);
    // The tool is behind by the angle of lag.
    EXPECT_NEAR(sample.progress_mm - sample.foot_mm,
                kRadius_mm * std::atan(kSpeed_mm_s / kRadius_mm / 50.0), 1e-3);
  }
}

TEST(ModelRun, FollowsTheOtherModelsToo) {
  const Machine machine = ideal_mill();
  const PlannedPath path = test::planned_text(machine, circle(kRadius_mm, 4000.0));
  OtherModels others;
  for (auto& axis : others.axis) {
    axis = {{.gain_1_s = 47.5}, {.gain_1_s = 52.5}};
  }
  bool seen = false;
  const auto done = run_model(
      {.machine = machine,
       .path = path,
       .original = path,
       .map = same_path(path),
       .model = servo_models(machine.axes),
       .others = others},
      [&](const ModelSample& sample) {
        if (sample.time_s < 1.0 || sample.time_s > 2.0) {
          return;
        }
        seen = true;
        ASSERT_EQ(sample.others.size(), 8U);
        for (const std::size_t i : {0U, 7U}) {
          const double k = others[i][0].gain_1_s;
          const auto expected = circle_errors({.gain_1_s = k}, kRadius_mm, kSpeed_mm_s).value();
          EXPECT_NEAR(sample.others[i].error_mm, expected.contour_error_mm, 5e-4);
        }
      });
  ASSERT_TRUE(done.has_value());
  EXPECT_TRUE(seen);
}

// The inverse of the servo on a circle: commanded with R·√(1 + q²), the tool runs on R.
TEST(ModelRun, MeasuresAgainstTheOriginalPath) {
  const Machine machine = ideal_mill();
  const PlannedPath original = test::planned_text(machine, circle(kRadius_mm, 4000.0));
  const double q = kSpeed_mm_s / (kRadius_mm * 50.0);
  const double wider = std::sqrt(1.0 + q * q);
  const PlannedPath changed =
      test::planned_text(machine, circle(kRadius_mm * wider, 4000.0 * wider));
  PathMap map = same_path(original);
  const auto found = samples({.machine = machine,
                              .path = changed,
                              .original = original,
                              .map = map,
                              .model = servo_models(machine.axes),
                              .others = {}},
                             1.0, 2.0);
  ASSERT_GT(found.size(), 100U);
  for (const ModelSample& sample : found) {
    EXPECT_NEAR(sample.error_mm, 0.0, 2e-5);
  }
}

// Truth: the planner's own account of the program's time.
TEST(ModelRun, TakesTheProgramsTime) {
  Machine machine = ideal_mill();
  machine.spindle.acceleration_rev_s2 = 50.0;
  const std::string program =
      "G21 G90 G94 G64\nG0 X0 Y0 Z5\nS3000 M3\nG4 P0.3\nG1 Z-1 F300\nG1 X30 F2000\nG2 X40 Y10 I0 "
      "J10\nG1 Y40\nG0 Z5\nM5\nM2\n";
  auto timer = nc::plan::ProgramTimer::make(machine).value();
  ASSERT_TRUE(nc::interpret::run_text(program, {}, timer).has_value());
  const double time_s = timer.take().value().total_s;
  const PlannedPath path = test::planned_text(machine, program);
  ErrorFigures figures(0.01);
  const auto run_s = run_model({.machine = machine,
                                .path = path,
                                .original = path,
                                .map = same_path(path),
                                .model = servo_models(machine.axes),
                                .others = {}},
                               [&](const ModelSample& sample) {
                                 if (sample.cuts) {
                                   figures.add(sample, sample.line);
                                 }
                               });
  ASSERT_TRUE(run_s.has_value());
  EXPECT_NEAR(*run_s, time_s, machine.control.interpolator_period_s);
  // The largest error is behind the corner at the plunge's end; on the plunge itself there is none.
  const auto& nominal = figures.nominal();
  EXPECT_NEAR(nominal.max_mm, nominal.line_mm(6), 1e-6);
  EXPECT_GT(nominal.line_mm(7), 0.01);
  EXPECT_LT(nominal.line_mm(5), 1e-6);
  EXPECT_LT(nominal.rms_mm(), nominal.max_mm);
  EXPECT_GT(figures.share_over(), 0.0);
}

// The command ends half a millimetre behind the corner, the tool then is half a millimetre before
// it.
TEST(ModelRun, FollowsTheToolUntilItHasArrived) {
  const Machine machine = ideal_mill();
  const PlannedPath path = test::planned_moves(machine, "G1 X20 F3000\nG1 Y0.2\n");
  const ModelRun run{.machine = machine,
                     .path = path,
                     .original = path,
                     .map = same_path(path),
                     .model = servo_models(machine.axes),
                     .others = {}};
  double ended_s = 0.0;
  double foot_mm = 0.0;
  double before_mm = 0.0;
  double after_mm = 0.0;
  const auto seconds = run_model(run, [&](const ModelSample& sample) {
    ended_s = sample.ended ? ended_s : sample.time_s;
    (sample.ended ? after_mm : before_mm) =
        std::max(sample.ended ? after_mm : before_mm, std::abs(sample.error_mm) + sample.more_mm);
    foot_mm = sample.foot_mm;
    EXPECT_TRUE(!sample.cuts || sample.line <= 3U) << "the line that it moves in";
  });
  ASSERT_TRUE(seconds.has_value());
  EXPECT_NEAR(*seconds, ended_s, 0.005);
  EXPECT_NEAR(foot_mm, 20.2, 1e-3);
  EXPECT_GT(after_mm, before_mm);
}

// A right angle: the peak is where the tool is as far from the one side as from the other. In
// between two samples of 2 ms it may be missed by 30 µm; whatever the period, the figure is the
// same.
TEST(ModelRun, FindsThePeakAtACornerBetweenTwoSamples) {
  std::vector<double> peak_mm;
  for (const double period_s : {0.0001, 0.0002}) {
    Machine machine = ideal_mill();
    machine.control.interpolator_period_s = period_s;
    const PlannedPath path = test::planned_moves(machine, "G1 X20 F3000\nG1 Y20\nG0 Z5\n");
    ErrorFigures figures;
    ASSERT_TRUE(run_model({.machine = machine,
                           .path = path,
                           .original = path,
                           .map = same_path(path),
                           .model = servo_models(machine.axes),
                           .others = {}},
                          [&](const ModelSample& sample) {
                            if (sample.cuts) {
                              figures.add(sample, sample.line);
                            }
                          })
                    .has_value());
    peak_mm.push_back(figures.nominal().max_mm);
  }
  EXPECT_NEAR(peak_mm[0], peak_mm[1], 0.005 * peak_mm[0]);
}

}  // namespace
}  // namespace steadyrest::contour::offline
