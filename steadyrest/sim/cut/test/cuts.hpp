// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <vector>

#include <steadyrest/sim/cut/cutting_process.hpp>

/// Cuts by hand.
namespace steadyrest::sim::test {

using std::numbers::pi;

inline CuttingMode mode(double stiffness_n_mm, double frequency_hz, double damping,
                        bool along_x = true) {
  const double w = 2.0 * pi * frequency_hz;
  return {.shape = {along_x ? 1.0 : 0.0, along_x ? 0.0 : 1.0},
          .frequency_hz = frequency_hz,
          .damping_ratio = damping,
          .mass_kg = 1000.0 * stiffness_n_mm / (w * w)};
}

/// Two teeth, slot: Insperger and Stépán's benchmark.
inline Cutting benchmark(double depth_mm) {
  Cutting cut;
  cut.modes = {CuttingMode{.frequency_hz = 922.0, .damping_ratio = 0.011, .mass_kg = 0.03993}};
  cut.depth_mm = depth_mm;
  return cut;
}

inline CuttingProcess made(const CuttingProcess::Config& config) {
  return CuttingProcess::make(config).value();
}

inline std::vector<CuttingProcess::Output> turns(CuttingProcess& process,
                                                 const CuttingProcess::Input& input,
                                                 std::size_t n) {
  std::vector<CuttingProcess::Output> out;
  out.reserve(n * process.steps());
  for (std::size_t i = 0; i < n * process.steps(); ++i) {
    out.push_back(process.step(input));
  }
  return out;
}

}  // namespace steadyrest::sim::test
