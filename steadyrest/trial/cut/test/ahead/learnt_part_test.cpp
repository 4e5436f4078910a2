// SPDX-License-Identifier: Apache-2.0
// Learning from the part before: the simulated machine is not as its file says, a part is cut and
// recorded by its encoders, and the next one is judged by the true tool against the original path.
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>
#include <steadyrest/trial/test/examples.hpp>

namespace steadyrest::trial::cut {
namespace {

using contour::offline::CutPart;
using contour::offline::PartRecord;
using contour::offline::Predistorted;
using kernel::machine::Machine;
using nc::plan::PlannedPath;
using trial::test::kExamples;
using trial::test::machine_of;
using PathOf = std::shared_ptr<const PlannedPath>;

nc::interpret::Config config_of(const Machine& machine) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  return config;
}

PathOf path_of(const std::string& file, const Machine& machine) {
  nc::plan::PathBuilder builder(machine);
  const auto report = nc::interpret::run_file(file, config_of(machine), builder).value();
  EXPECT_TRUE(report.refused.empty());
  return std::make_shared<const PlannedPath>(builder.take().value());
}

/// A part on a machine: its figures by the true tool against the original, and its record by the
/// encoders.
struct Part {
  Figures figures;
  PartRecord record;
};
Part cut_part(const std::string& file, const std::string& original, const Machine& machine) {
  const PathOf path = path_of(file, machine);
  Job job{.machine = machine, .path = path};
  if (file != original) {
    job.against = std::make_shared<const Original>(
        Original::make(*path, path_of(original, machine), 2.0).value());
  }
  Part out;
  Recorder recorder(
      {.limit_mm = machine.contour.limit_mm, .cycle_s = machine.control.interpolator_period_s});
  const auto layer = [&](kernel::signal::Frame& frame) {
    out.record.time_s.push_back(frame.time_s);
    out.record.command_mm.push_back(
        {frame.axis[0].command_mm, frame.axis[1].command_mm, frame.axis[2].command_mm});
    out.record.actual_mm.push_back(
        {frame.axis[0].actual_mm, frame.axis[1].actual_mm, frame.axis[2].actual_mm});
    return kernel::signal::Command{};
  };
  EXPECT_TRUE(run(job, layer, [&](const Sample& sample) { recorder.add(sample); }));
  out.record.period_s = machine.control.interpolator_period_s;
  out.figures = recorder.figures();
  return out;
}

/// Cuts one part after another, each learnt from the one before.
class Series {
 public:
  Series(const std::string& program, Machine machine, Machine believed)
      : program_(kExamples + "programs/" + program),
        machine_(std::move(machine)),
        believed_(std::move(believed)) {}

  Figures next(double limit_mm = 0.01) {
    contour::offline::PredistortConfig how{.limit_mm = limit_mm};
    how.told = {{"changes", "predistort"}};
    if (!cut_file_.empty()) {
      how.parts = {CutPart{.record = part_.record, .program = cut_file_}};
    }
    predicted_ =
        contour::offline::predistort(program_, config_of(believed_), believed_, how).value();
    cut_file_ = folder_.file(fmt::format("part{}.mpf", ++count_), predicted_.replaced.text);
    part_ = cut_part(cut_file_, program_, machine_);
    return part_.figures;
  }
  [[nodiscard]] const Predistorted& predicted() const { return predicted_; }

 private:
  kernel::file::testing::OwnFolder folder_;
  std::string program_;
  Machine machine_;
  Machine believed_;
  Predistorted predicted_;
  std::string cut_file_;
  Part part_;
  int count_ = 0;
};

Machine with_gains(Machine machine, double share) {
  for (auto& axis : machine.axes) {
    axis.servo_gain_1_s *= 1.0 + share;
  }
  return machine;
}

// Every gain 5 % off and the file does not know. The first part is made by the file; what it leaves
// is measured by the encoders and taken away in the next one. What is left then are a few corners,
// other ones with any rounding of the windows (1.4 to 2.1 µm): both parts together are judged. A
// block time costs these corners more, whatever the gains.
TEST(LearntPart, TakesAwayWhatWrongGainsLeave) {
  Machine mill = machine_of("vmc-840d.toml");
  mill.control.block_time_s = 0.0;
  double squares_mm2 = 0.0;
  const auto gains = kernel::testing::cases({0.05, -0.05}, 1);
  for (const double off : gains) {
    Series parts("rib-pocket.mpf", with_gains(mill, off), mill);
    const Figures first = parts.next();
    const Figures second = parts.next();
    EXPECT_GT(first.contour_error_rms_mm, 0.004) << off;
    squares_mm2 += second.contour_error_rms_mm * second.contour_error_rms_mm;
    EXPECT_LT(second.cycle_time_s, 1.01 * first.cycle_time_s) << off;
    ASSERT_EQ(parts.predicted().learnt.size(), 1U);
    // Nearly all of the part teaches; what is left out has a reason.
    const auto& learnt = parts.predicted().learnt.front();
    EXPECT_GT(learnt.learns_s, 0.95 * learnt.cut_s);
    EXPECT_LT(learnt.convergence, 1.0);
  }
  EXPECT_LT(std::sqrt(squares_mm2 / static_cast<double>(gains.size())), 0.002);
}

}  // namespace
}  // namespace steadyrest::trial::cut
