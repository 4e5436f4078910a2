// SPDX-License-Identifier: Apache-2.0
// A probing move in the program, from its NC text to the axis: the probe's reading corrects the
// thermal model while the part is being made.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::machine::Machine;
using kernel::outcome::Reason;

/// The mill with a warm head that warms within minutes; the true one is a fifth faster than its
/// passport says, and grows by `larger` more.
Machine wrong_mill(double larger) {
  Machine machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/thermal-batch/machine.toml").value();
  auto& z = machine.thermal.axis.at(0);
  z.mode[0].tau_s = 60.0;
  z.mode[1].tau_s = 240.0;
  z.drift_mm = 0.004;
  z.drift_tau_s = 1200.0;
  machine.thermal.slope_mm_s = 0.020 / 60.0;
  machine.simulation.thermal_tau_error_ratio = {-0.2};
  machine.simulation.thermal_gain_error_ratio = {larger};
  machine.contour.enabled = false;
  return machine;
}

/// Passes along X for `minutes`; 20 s each.
std::string passes(double minutes) {
  std::string text;
  for (int i = 0; i < static_cast<int>(std::lround(3.0 * minutes)); ++i) {
    text += i % 2 == 0 ? "G1 X200 F600\n" : "G1 X0 F600\n";
  }
  return text;
}

Job job_of(const Machine& machine, const std::string& text) {
  nc::plan::PathBuilder builder(machine);
  const auto report = nc::interpret::run_text(text, {}, builder).value();
  EXPECT_TRUE(report.refused.empty());
  return {.machine = machine,
          .path = std::make_shared<const nc::plan::PlannedPath>(builder.take().value()),
          .with_layer = true};
}

std::string program_with(const std::string& touch) {
  return "G21 G90 G61\nS6000 M3\nG1 Z0 F600\n" + passes(4.0) + "G0 Z5\n" + touch +
         "\nG0 Z5\nG1 Z0 F600\n" + passes(2.0) + "M2\n";
}

/// RMS of the tool's distance from the path in feed moves between two times.
double error_um(const Recorder& record, double from_s, double to_s) {
  double squares = 0.0;
  double count = 0.0;
  for (const Sample& sample : record.trace()) {
    if (sample.motion == kernel::signal::Motion::feed && sample.time_s >= from_s &&
        sample.time_s < to_s) {
      squares += sample.contour_error_mm * sample.contour_error_mm;
      count += 1.0;
    }
  }
  EXPECT_GT(count, 100.0);
  return 1e3 * std::sqrt(squares / count);
}

TEST(ProbeInTheProgram, SetsTheModelRightWhileThePartIsMade) {
  const Machine machine = wrong_mill(0.2);
  const auto probed = run(job_of(machine, program_with("G38.2 Z0 F300"))).value();
  const auto blind = run(job_of(machine, program_with("G1 Z0 F300"))).value();
  Job bare = job_of(machine, program_with("G1 Z0 F300"));
  bare.with_layer = false;
  const auto nobody = run(bare).value();
  ASSERT_EQ(probed.probes().size(), 1U) << "one reading, taken once";
  EXPECT_TRUE(blind.probes().empty());
  const ProbeFigures& reading = probed.probes().front();
  EXPECT_EQ(reading.axis, "Z");
  EXPECT_EQ(reading.line, 17U);
  EXPECT_EQ(reading.reason, Reason::thermal_reading_taken);
  const double at_s = reading.time_s;
  // The same machine up to here: the probe finds the remainder, within its noise.
  const double before_um = error_um(probed, at_s - 25.0, at_s - 5.0);
  EXPECT_NEAR(before_um, error_um(blind, at_s - 25.0, at_s - 5.0), 1e-6);
  EXPECT_NEAR(std::abs(reading.displacement_um), before_um, 2.5);
  // At its slope the offset gets there within half a minute.
  const double after_um = error_um(probed, at_s + 40.0, at_s + 100.0);
  const double otherwise_um = error_um(blind, at_s + 40.0, at_s + 100.0);
  EXPECT_LT(after_um, 0.15 * otherwise_um);
  EXPECT_LT(after_um, 0.15 * before_um);
  EXPECT_LT(otherwise_um, error_um(nobody, at_s + 40.0, at_s + 100.0));
}

// One second above the part is enough; without a retract slope it takes half a minute of the next
// cut.
TEST(ProbeInTheProgram, WithARetractSlopeTheNextCutIsRightFromItsBeginning) {
  const auto first_cut_um = [](double retract_um_min) {
    Machine machine = wrong_mill(0.2);
    machine.thermal.retract_slope_mm_s = retract_um_min * 1e-3 / 60.0;
    const auto cut = run(job_of(machine, program_with("G38.2 Z0 F300\nG0 Z5\nG4 P1"))).value();
    const double at_s = cut.probes().at(0).time_s;
    return error_um(cut, at_s + 3.0, at_s + 8.0);
  };
  const double slow_um = first_cut_um(0.0);
  const double fast_um = first_cut_um(900.0);
  EXPECT_GT(slow_um, 8.0);
  EXPECT_LT(fast_um, 0.25 * slow_um);
}

TEST(ProbeInTheProgram, AReadingBeyondBeliefIsShownAndChangesNothing) {
  const Machine machine = wrong_mill(0.5);
  const auto probed = run(job_of(machine, program_with("G38.2 Z0 F300"))).value();
  const auto blind = run(job_of(machine, program_with("G1 Z0 F300"))).value();
  ASSERT_EQ(probed.probes().size(), 1U);
  const ProbeFigures& reading = probed.probes().front();
  EXPECT_EQ(reading.reason, Reason::thermal_reading_outlier);
  EXPECT_GT(std::abs(reading.innovation_um), reading.band_um);
  EXPECT_NEAR(error_um(probed, reading.time_s + 40.0, reading.time_s + 100.0),
              error_um(blind, reading.time_s + 40.0, reading.time_s + 100.0), 0.01);
}

}  // namespace
}  // namespace steadyrest::trial::cut
