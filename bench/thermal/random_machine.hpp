// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include <steadyrest/thermal/offline/log/log.hpp>

/// A thermal test of a machine drawn at random: two modes (8 … 40 and 60 … 240 min) of 1 … 4 and
/// 1 … 8 µm per 1000 rpm, a room with its day and its weather that moves the machine with a lag,
/// and a draught that no sensor sees. Six runs of 2 … 4 h, each followed by 1 … 3 h of rest, a row
/// every 2 min. Sensors: the room, a column that the spindle heats, and one that tells nothing.
namespace steadyrest::bench {

inline thermal::offline::Log random_machine(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto from = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  constexpr double kStep_min = 2.0;
  const double fast_min = from(8.0, 40.0);
  const double slow_min = from(60.0, 240.0);
  const double fast_um = from(1.0, 4.0);
  const double slow_um = from(1.0, 8.0);
  const double room_um_k = from(-4.0, 4.0);
  const double room_lag_min = from(10.0, 180.0);
  const double day_k = from(0.2, 2.0);
  const double phase = from(0.0, 2.0 * std::numbers::pi);
  const double weather_min = from(120.0, 600.0);
  const double draught_um = from(0.2, 1.5);
  const double draught_min = from(30.0, 400.0);
  const double noise_um = from(0.1, 0.5);
  const auto walk = [&](double& x, double tau_min) {
    const double keep = std::exp(-kStep_min / tau_min);
    x = keep * x + std::sqrt(1.0 - keep * keep) * normal(random);
  };
  const auto follow = [](double& x, double to, double tau_min) {
    x += (to - x) * -std::expm1(-kStep_min / tau_min);
  };

  thermal::offline::Log log;
  log.displacement.push_back({"z_um", {}});
  log.temperature = {{"room_c", {}}, {"column_c", {}}, {"other_c", {}}};
  double fast = 0.0;
  double slow = 0.0;
  double weather = normal(random);
  double draught = normal(random);
  double other = normal(random);
  double heat = 0.0;
  double lagged_k = 0.0;
  double t_min = 0.0;
  for (int run = 0; run < 6; ++run) {
    const double krpm = 0.5 * std::floor(from(2.0, 10.0));
    const double on_min = from(120.0, 240.0);
    const double all_min = on_min + from(60.0, 180.0);
    for (double in_min = 0.0; in_min < all_min; in_min += kStep_min, t_min += kStep_min) {
      const double turns = in_min < on_min ? krpm : 0.0;
      walk(weather, weather_min);
      walk(draught, draught_min);
      walk(other, 300.0);
      const double room_k =
          weather + day_k * std::sin(2.0 * std::numbers::pi * t_min / 1440.0 + phase);
      lagged_k = t_min == 0.0 ? room_k : lagged_k;
      follow(lagged_k, room_k, room_lag_min);
      follow(fast, fast_um * turns, fast_min);
      follow(slow, slow_um * turns, slow_min);
      follow(heat, 0.5 * turns, 50.0);
      log.time_s.push_back(60.0 * t_min);
      log.speed_rev_s.push_back(1000.0 * turns / 60.0);
      log.displacement[0].value.push_back(
          1e-3 *
          (fast + slow + room_um_k * lagged_k + draught_um * draught + noise_um * normal(random)));
      log.temperature[0].value.push_back(20.0 + room_k + 0.05 * normal(random));
      log.temperature[1].value.push_back(20.0 + room_k + heat + 0.05 * normal(random));
      log.temperature[2].value.push_back(21.0 + other + 0.05 * normal(random));
    }
  }
  return log;
}

}  // namespace steadyrest::bench
