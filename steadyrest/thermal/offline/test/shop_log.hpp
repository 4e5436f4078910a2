// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <steadyrest/thermal/offline/log/log.hpp>

/// A known machine: its bed lags the room by 90 min and moves it by 3 µm/K. The room is noisy, and
/// the third sensor has nothing to do with it.
namespace steadyrest::thermal::offline::test {

inline constexpr double kShopRun_s = 300.0 * 60.0;

/// Speeds of eight runs.
inline const std::vector<double> kShopDays_rpm = {1500, 3000, 4500, 2000, 4000, 2500, 3500, 1000};

/// Runs of 3 h, each with 2 h of rest; a row each minute.
inline Log shop(unsigned seed, const std::vector<double>& runs_rpm) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Log log;
  log.file = "shop.csv";
  log.displacement.push_back({"z_um", {}});
  for (const char* name : {"room_c", "bed_c", "other_c"}) {
    log.temperature.push_back({name, {}});
  }
  double fast_um = 0.0;
  double slow_um = 0.0;
  double draught_k = 0.0;
  double bed_k = 0.0;
  double other_k = 2.0;
  for (const double run_rpm : runs_rpm) {
    for (int minute = 0; minute < 300; ++minute) {
      const double t_s = 60.0 * static_cast<double>(log.rows());
      const double krpm = minute < 180 ? run_rpm / 1000.0 : 0.0;
      draught_k += 0.05 * normal(random) - 0.01 * draught_k;
      const double room_k = 2.0 * std::sin(2.0 * std::numbers::pi * t_s / 86400.0) + draught_k;
      bed_k += (room_k - bed_k) / 90.0;
      other_k += 0.02 * normal(random) - 0.002 * (other_k - 2.0);
      fast_um += (2.7 * krpm - fast_um) / 20.0;
      slow_um += (4.7 * krpm - slow_um) / 110.0;
      log.time_s.push_back(t_s);
      log.speed_rev_s.push_back(1000.0 * krpm / 60.0);
      log.displacement[0].value.push_back(1e-3 *
                                          (fast_um + slow_um + 3.0 * bed_k + 0.3 * normal(random)));
      log.temperature[0].value.push_back(20.0 + room_k + 0.15 * normal(random));
      log.temperature[1].value.push_back(20.0 + bed_k + 0.02 * normal(random));
      log.temperature[2].value.push_back(20.0 + other_k + 0.02 * normal(random));
    }
  }
  return log;
}

}  // namespace steadyrest::thermal::offline::test
