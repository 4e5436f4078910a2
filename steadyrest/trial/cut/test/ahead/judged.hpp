// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

/// Predistorted programs, judged by the true tool of the simulated machine.
namespace steadyrest::trial::cut::test {

inline nc::interpret::Config reading(const kernel::machine::Machine& machine) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  return config;
}

inline std::shared_ptr<const nc::plan::PlannedPath> planned(
    const std::string& text, const kernel::machine::Machine& machine) {
  nc::plan::PathBuilder builder(machine);
  const auto report = nc::interpret::run_text(text, reading(machine), builder).value();
  EXPECT_TRUE(report.refused.empty());
  return std::make_shared<const nc::plan::PlannedPath>(builder.take().value());
}

struct Judged {
  contour::offline::Predistorted predicted;
  Figures original;
  Figures changed;

  [[nodiscard]] double time_ratio() const { return changed.cycle_time_s / original.cycle_time_s; }
};

/// The program predistorted for `believed` and cut on `machine`, without any layer.
inline Judged judged(const std::string& file, const kernel::machine::Machine& machine,
                     const kernel::machine::Machine& believed,
                     contour::offline::PredistortConfig how = {}) {
  how.told = {{"changes", "predistort"}, {"tube-mm", fmt::format("{:g}", how.max_shift_mm)}};
  Judged out;
  out.predicted = contour::offline::predistort(file, reading(believed), believed, how).value();
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto original = planned(text, machine);
  const auto changed = planned(out.predicted.replaced.text, machine);
  out.original = run({.machine = machine, .path = original}).value().figures();
  constexpr double kTube_mm = 4.0;
  Job job{.machine = machine, .path = changed};
  job.against =
      std::make_shared<const Original>(Original::make(*changed, original, kTube_mm).value());
  out.changed = run(job).value().figures();
  return out;
}

}  // namespace steadyrest::trial::cut::test
