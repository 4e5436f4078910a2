// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <steadyrest/thermal/offline/log/log.hpp>

/// Logs of a known machine, by an independent recursion.
namespace steadyrest::thermal::offline::test {

/// (minutes, rpm): four runs of 4 h, each followed by an equally long rest.
inline const std::vector<std::pair<int, double>> kDays = {
    {240, 3000}, {240, 0}, {240, 1500}, {240, 0}, {240, 4500}, {240, 0}, {240, 2250}, {240, 0}};

struct KnownMode {
  double tau_min = 0.0;
  double um_per_krpm = 0.0;
  double (*level_um)(double rpm) = nullptr;  ///< instead of it
};

struct KnownMachine {
  std::vector<KnownMode> mode;
  double noise_um = 0.5;
  double gain_um_k = 0.0;  ///< of the first temperature
  double lag_min = 0.0;
  unsigned seed = 1;
};

/// A row each minute; steps of (minutes, rpm). Three temperatures wander; the second and third do
/// nothing.
inline Log log_of(const KnownMachine& machine, const std::vector<std::pair<int, double>>& steps,
                  int temperatures = 0) {
  std::mt19937 random(machine.seed);
  std::normal_distribution<double> normal;
  Log log;
  log.file = "known.csv";
  log.displacement.push_back({"z_um", {}});
  for (int i = 0; i < temperatures; ++i) {
    log.temperature.push_back({"t" + std::to_string(i + 1) + "_c", {}});
  }
  std::vector<double> x(machine.mode.size(), 0.0);
  std::vector<double> wander(3, 0.0);
  double lagged = 20.0;
  for (const auto& [minutes, rpm] : steps) {
    for (int k = 0; k < minutes; ++k) {
      const auto row = static_cast<double>(log.rows());
      log.time_s.push_back(60.0 * row);
      log.speed_rev_s.push_back(rpm / 60.0);
      double um = machine.gain_um_k * (lagged - 20.0) + machine.noise_um * normal(random);
      for (std::size_t i = 0; i < x.size(); ++i) {
        um += x[i];
        const KnownMode& mode = machine.mode[i];
        const double level =
            mode.level_um != nullptr ? mode.level_um(rpm) : mode.um_per_krpm * rpm / 1000.0;
        x[i] = level + (x[i] - level) * std::exp(-1.0 / machine.mode[i].tau_min);
      }
      log.displacement[0].value.push_back(1e-3 * um);
      for (std::size_t i = 0; i < log.temperature.size(); ++i) {
        wander[i] += 0.03 * normal(random) - 0.002 * wander[i];
        log.temperature[i].value.push_back(20.0 + wander[i]);
      }
      lagged =
          machine.lag_min > 0.0
              ? 20.0 + wander[0] + (lagged - 20.0 - wander[0]) * std::exp(-1.0 / machine.lag_min)
              : 20.0 + wander[0];
    }
  }
  return log;
}

}  // namespace steadyrest::thermal::offline::test
