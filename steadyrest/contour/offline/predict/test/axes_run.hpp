// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>

namespace steadyrest::contour::offline::test {

/// A run of moves on these axes.
struct AxesRun {
  explicit AxesRun(const std::string& moves)
      : path(planned_moves(machine, moves)), model(servo_models(machine.axes)) {}
  /// The samples of a line of the program, from so long after its first on.
  [[nodiscard]] std::vector<ModelSample> on_line(std::uint32_t line, double after_s) const {
    std::vector<ModelSample> out;
    double first_s = -1.0;
    const PathMap map = same_path(path);
    EXPECT_TRUE(run_model({.machine = machine,
                           .path = path,
                           .original = path,
                           .map = map,
                           .model = model,
                           .others = {},
                           .backlash_mm = backlash_mm,
                           .unknown = unknown},
                          [&](const ModelSample& sample) {
                            if (sample.line == line) {
                              first_s = first_s < 0.0 ? sample.time_s : first_s;
                              if (sample.time_s >= first_s + after_s) {
                                out.push_back(sample);
                              }
                            }
                          })
                    .has_value());
    EXPECT_GT(out.size(), 50U);
    return out;
  }

  kernel::machine::Machine machine = ideal_mill();
  nc::plan::PlannedPath path;
  ServoModels model;
  std::array<double, 3> backlash_mm{};
  std::function<kernel::signal::Point(double)> unknown = nullptr;
};

}  // namespace steadyrest::contour::offline::test
