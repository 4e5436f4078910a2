// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/trial/batch/test/example_batch.hpp>

namespace steadyrest::trial::batch {
namespace {

// A correct model leaves the text's band and, on line, one second of growth.
TEST(Batch, ARightModelLeavesNoMoreThanItsBand) {
  Job job = example();
  set_errors(job, {0.0}, {0.0});
  job.machine.simulation.probe_noise_mm = 0.0;
  job.machine.simulation.room_swing_k = 0.0;
  job.machine.simulation.room_noise_k = 0.0;
  job.machine.simulation.sensor_noise_k = 0.0;
  const Batch batch = batch_of(job);
  EXPECT_NEAR(batch.band_mm, 0.0035, 1e-12);
  // A correction is written where it is safe, up to a minute from where it is due.
  EXPECT_LT(batch.error[1].largest_mm, batch.band_mm + 0.001);
  EXPECT_LT(batch.error[2].largest_mm, 5e-5);  // a second behind, at 1.4 µm/min
  // Without correction it is the steady state of the mixed speeds, 28 µm and more.
  EXPECT_GT(batch.error[0].largest_mm, 0.028);
}

TEST(Batch, WithoutCorrectionItIsTheGrowthOfTheMachine) {
  Job job = example();
  job.parts = 2;
  const Batch batch = batch_of(job);
  ASSERT_EQ(batch.part.size(), 2U);
  EXPECT_EQ(batch.part[0].start_s, 0.0);
  EXPECT_NEAR(batch.part[1].start_s, batch.program_s + job.pause_s, 1.0);
  EXPECT_GE(batch.part[0].error[0].largest_mm, batch.part[0].error[0].rms_mm);
  EXPECT_GT(batch.part[0].at_end_mm, 0.004);
  EXPECT_GT(batch.part[1].at_end_mm, batch.part[0].at_end_mm);
  EXPECT_NEAR(batch.part[1].probe_mm[0], batch.part[0].at_end_mm, 0.004);  // two minutes later
  EXPECT_GE(batch.part[1].corrections, 1U);
}

TEST(Batch, TheBreakCoolsTheMachineAndTheProbeSeesIt) {
  const Batch batch = batch_of(example());
  EXPECT_LT(batch.part[8].probe_mm[0], 0.7 * batch.part[7].at_end_mm);
  EXPECT_NEAR(batch.part[8].start_s - batch.part[7].start_s, batch.program_s + 120.0 + 3600.0, 2.0);
}

TEST(Batch, SameSeedSameBatchOtherSeedAnother) {
  Job job = example();
  job.parts = 3;
  const Batch once = batch_of(job);
  EXPECT_EQ(once.error[2].rms_mm, batch_of(job).error[2].rms_mm);
  job.machine.simulation.seed = 2;
  EXPECT_NE(once.error[2].rms_mm, batch_of(job).error[2].rms_mm);
}

TEST(Batch, RefusesAMachineWithoutAThermalAxisOfItsOwn) {
  Job job = example();
  job.machine.thermal.axis[0].name = "tilt";
  const auto made = run(job);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().what.find("no [[thermal.axis]] for any of its axes"), std::string::npos);
  job = example();
  job.program = "no such file.ngc";
  EXPECT_FALSE(run(job));
}

}  // namespace
}  // namespace steadyrest::trial::batch
