// SPDX-License-Identifier: Apache-2.0
// The estimates of the axes' motion on a part in the cut, against the simulated machine's true
// motion.
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>
#include <steadyrest/trial/cut/motion_score.hpp>
#include <steadyrest/trial/test/examples.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::machine::Machine;
using trial::test::kExamples;
using trial::test::machine_of;

std::vector<MotionFigures> cut(const Machine& machine, const std::string& program,
                               nc::read::Dialect dialect) {
  nc::interpret::Config config;
  config.dialect = dialect;
  nc::plan::PathBuilder builder(machine);
  const auto report =
      nc::interpret::run_file(kExamples + "programs/" + program, config, builder).value();
  EXPECT_TRUE(report.refused.empty());
  const auto path = std::make_shared<const nc::plan::PlannedPath>(builder.take().value());
  return run({.machine = machine, .path = path, .with_layer = true}).value().motion();
}

void expect_bounds_hold(const std::vector<MotionFigures>& motion) {
  ASSERT_EQ(motion.size(), 3U);
  for (const MotionFigures& m : motion) {
    EXPECT_EQ(m.velocity_coverage_ratio, 1.0) << m.axis;
    EXPECT_EQ(m.acceleration_coverage_ratio, 1.0) << m.axis;
  }
}

// Counts of 1 µm at 1 kHz, as on many a retrofit.
TEST(MotionScore, OnThePocketAtOneKilohertzTheEstimatesAreFinerBySeventeenAndFiftyFive) {
  const auto motion =
      cut(machine_of("linuxcnc-mill.toml"), "rib-pocket.ngc", nc::read::Dialect::linuxcnc);
  expect_bounds_hold(motion);
  for (const MotionFigures& m : motion) {
    if (m.axis != "Z") {  // which moves only briefly
      EXPECT_GT(m.difference_velocity_rms_mm_s, 17.0 * m.velocity_rms_mm_s) << m.axis;
      EXPECT_GT(m.difference_acceleration_rms_mm_s2, 55.0 * m.acceleration_rms_mm_s2) << m.axis;
      // q/(√6·T) and q/(√2·T²): what differencing the counts can do.
      EXPECT_NEAR(m.difference_velocity_rms_mm_s, 0.408, 0.03);
      EXPECT_NEAR(m.difference_acceleration_rms_mm_s2, 707.0, 35.0);
    }
  }
}

TEST(MotionScore, OnThe840dWithFrictionAndItsCycleOfFourMillisecondsTheVelocityIsFinerBySeven) {
  const auto motion =
      cut(machine_of("vmc-840d.toml"), "rib-pocket.mpf", nc::read::Dialect::sinumerik);
  expect_bounds_hold(motion);
  for (const MotionFigures& m : motion) {
    EXPECT_GT(m.difference_velocity_rms_mm_s, (m.axis == "Z" ? 5.0 : 7.0) * m.velocity_rms_mm_s)
        << m.axis;
  }
}

TEST(MotionScore, AnIdealEncoderHasNoFigures) {
  EXPECT_TRUE(
      cut(machine_of("ideal-k50.toml"), "circle-r10.mpf", nc::read::Dialect::sinumerik).empty());
}

TEST(MotionScore, TheFiguresAreThoseOfTheErrorsPutIn) {
  Machine machine;
  machine.axes.resize(1);
  auto score = MotionScore::make(machine.axes, machine.control.interpolator_period_s).value();
  kernel::signal::Frame frame;
  for (int i = 0; i < 100; ++i) {
    auto& axis = frame.axis[0];
    const bool bounded = i % 2 == 0;
    axis.velocity_mm_s = 3.0 + (i % 4 < 2 ? 0.3 : -0.4);
    axis.acceleration_mm_s2 = -20.0;
    axis.velocity_bound_mm_s = bounded ? 0.35 : std::numeric_limits<double>::infinity();
    score.add(frame, {3.0}, {-17.0});
  }
  const MotionFigures m = score.figures().at(0);
  EXPECT_NEAR(m.velocity_rms_mm_s, std::sqrt((0.09 + 0.16) / 2.0), 1e-12);
  EXPECT_NEAR(m.acceleration_rms_mm_s2, 3.0, 1e-12);
  EXPECT_NEAR(m.difference_velocity_rms_mm_s, 3.0, 1e-12) << "the count did not change";
  EXPECT_NEAR(m.difference_acceleration_rms_mm_s2, 17.0, 1e-12);
  EXPECT_DOUBLE_EQ(m.velocity_coverage_ratio, 0.5);
  EXPECT_TRUE(std::isnan(m.acceleration_coverage_ratio));
}

}  // namespace
}  // namespace steadyrest::trial::cut
