// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <ranges>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/batch/batch.hpp>

namespace steadyrest::trial::batch {
namespace {

const std::string kFolder = std::string(STEADYREST_SOURCE_DIR) + "/examples/thermal-batch";

/// Sixteen parts of the example, a pause after each, an hour's break in the middle; a cold start.
Job example() {
  static const Job kJob = [] {
    Job job;
    auto machine = passport::read(kFolder + "/machine.toml");
    EXPECT_TRUE(machine) << (machine ? "" : machine.error().what);
    job.machine = *machine;
    job.program = kFolder + "/plate.ngc";
    job.config.axes = "XYZ";
    auto timer = nc::plan::ProgramTimer::make(job.machine);
    EXPECT_TRUE(nc::interpret::run_file(job.program, job.config, *timer));
    job.cyclogram = timer->take()->cyclogram;
    job.parts = 16;
    job.pause_s = 120.0;
    job.break_s = 3600.0;
    job.break_after = 8;
    return job;
  }();
  return kJob;
}

Batch batch_of(const Job& job) {
  auto made = run(job);
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return made ? *std::move(made) : Batch{};
}

void set_errors(Job& job, std::vector<double> tau, std::vector<double> gain) {
  job.machine.simulation.thermal_tau_error_ratio = std::move(tau);
  job.machine.simulation.thermal_gain_error_ratio = std::move(gain);
}

class BatchOfSeed : public ::testing::TestWithParam<std::uint64_t> {};

// The target from the issue: a model wrong by 20 % in every time constant and gain, in any
// combination of signs, and 0.5 µm of probe noise.
TEST_P(BatchOfSeed, ErrorFallsFourTimesAndOnNoPartRisesWithAModelWrongByTwentyPercent) {
  double least_text = 1e9;
  double least_online = 1e9;
  for (const unsigned corner : kernel::testing::cases(std::views::iota(0U, 64U))) {
    Job job = example();
    job.machine.simulation.seed = GetParam();
    const auto sign = [corner](unsigned bit) { return (corner >> bit & 1U) != 0U ? 0.2 : -0.2; };
    set_errors(job, {sign(0), sign(1), sign(2)}, {sign(3), sign(4), sign(5)});
    const Batch batch = batch_of(job);
    ASSERT_EQ(batch.part.size(), 16U);
    for (const Way way : {Way::text, Way::online}) {
      EXPECT_GE(batch.improvement(way), 4.0)
          << "corner " << corner << " way " << static_cast<int>(way);
      EXPECT_EQ(batch.worse(way), 0U) << "corner " << corner << " way " << static_cast<int>(way);
    }
    least_text = std::min(least_text, batch.improvement(Way::text));
    least_online = std::min(least_online, batch.improvement(Way::online));
  }
  RecordProperty("least_text", fmt::format("{:.2f}", least_text));
  RecordProperty("least_online", fmt::format("{:.2f}", least_online));
}
INSTANTIATE_TEST_SUITE_P(Three, BatchOfSeed, ::testing::Values(1U, 2U, 3U));

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
