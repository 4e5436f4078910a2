// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/batch/batch.hpp>

namespace steadyrest::trial::batch {

inline const std::string kFolder = std::string(STEADYREST_SOURCE_DIR) + "/examples/thermal-batch";

/// Sixteen parts of the example, a pause after each, an hour's break in the middle; a cold start.
inline Job example() {
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

inline Batch batch_of(const Job& job) {
  auto made = run(job);
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return made ? *std::move(made) : Batch{};
}

inline void set_errors(Job& job, std::vector<double> tau, std::vector<double> gain) {
  job.machine.simulation.thermal_tau_error_ratio = std::move(tau);
  job.machine.simulation.thermal_gain_error_ratio = std::move(gain);
}

}  // namespace steadyrest::trial::batch
