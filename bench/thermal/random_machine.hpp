// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include <steadyrest/thermal/offline/log/log.hpp>

/// A thermal test of a machine drawn at random: two modes (8 … 40 and 60 … 240 min) of 1 … 4 and
/// 1 … 8 µm per 1000 rpm, a room with its day and its weather that moves the machine with a lag,
/// and a draught that no sensor sees. Six runs of 2 … 4 h, each followed by 1 … 3 h of rest, a row
/// every 2 min. Sensors: the room, a column that the spindle heats, and one that tells nothing.
namespace steadyrest::bench {

class RandomMachine {
 public:
  explicit RandomMachine(unsigned seed) : random_(seed) {}

  thermal::offline::Log test() {
    log_.displacement.push_back({"z_um", {}});
    log_.temperature = {{"room_c", {}}, {"column_c", {}}, {"other_c", {}}};
    weather_ = normal_(random_);
    draught_ = normal_(random_);
    other_ = normal_(random_);
    for (int run = 0; run < 6; ++run) {
      const double krpm = 0.5 * std::floor(from(2.0, 10.0));
      const double on_min = from(120.0, 240.0);
      const double all_min = on_min + from(60.0, 180.0);
      for (double in_min = 0.0; in_min < all_min; in_min += kStep_min, t_min_ += kStep_min) {
        step(in_min < on_min ? krpm : 0.0);
      }
    }
    return std::move(log_);
  }

 private:
  static constexpr double kStep_min = 2.0;

  double from(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  void walk(double& x, double tau_min) {
    const double keep = std::exp(-kStep_min / tau_min);
    x = keep * x + std::sqrt(1.0 - keep * keep) * normal_(random_);
  }
  static void follow(double& x, double to, double tau_min) {
    x += (to - x) * -std::expm1(-kStep_min / tau_min);
  }

  /// One row of the log, the spindle at this many thousand revolutions per minute.
  void step(double krpm) {
    walk(weather_, weather_min_);
    walk(draught_, draught_min_);
    walk(other_, 300.0);
    const double room_k =
        weather_ + day_k_ * std::sin(2.0 * std::numbers::pi * t_min_ / 1440.0 + phase_);
    lagged_k_ = t_min_ == 0.0 ? room_k : lagged_k_;
    follow(lagged_k_, room_k, room_lag_min_);
    follow(fast_, fast_um_ * krpm, fast_min_);
    follow(slow_, slow_um_ * krpm, slow_min_);
    follow(heat_, 0.5 * krpm, 50.0);
    log_.time_s.push_back(60.0 * t_min_);
    log_.speed_rev_s.push_back(1000.0 * krpm / 60.0);
    log_.displacement[0].value.push_back(1e-3 *
                                         (fast_ + slow_ + room_um_k_ * lagged_k_ +
                                          draught_um_ * draught_ + noise_um_ * normal_(random_)));
    log_.temperature[0].value.push_back(20.0 + room_k + 0.05 * normal_(random_));
    log_.temperature[1].value.push_back(20.0 + room_k + heat_ + 0.05 * normal_(random_));
    log_.temperature[2].value.push_back(21.0 + other_ + 0.05 * normal_(random_));
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  // Drawn in this order; a different order is a different machine.
  double fast_min_ = from(8.0, 40.0);
  double slow_min_ = from(60.0, 240.0);
  double fast_um_ = from(1.0, 4.0);
  double slow_um_ = from(1.0, 8.0);
  double room_um_k_ = from(-4.0, 4.0);
  double room_lag_min_ = from(10.0, 180.0);
  double day_k_ = from(0.2, 2.0);
  double phase_ = from(0.0, 2.0 * std::numbers::pi);
  double weather_min_ = from(120.0, 600.0);
  double draught_um_ = from(0.2, 1.5);
  double draught_min_ = from(30.0, 400.0);
  double noise_um_ = from(0.1, 0.5);
  // The state at t_min_.
  double t_min_ = 0.0;
  double fast_ = 0.0;
  double slow_ = 0.0;
  double weather_ = 0.0;
  double draught_ = 0.0;
  double other_ = 0.0;
  double heat_ = 0.0;
  double lagged_k_ = 0.0;
  thermal::offline::Log log_;
};

inline thermal::offline::Log random_machine(unsigned seed) {
  return RandomMachine(seed).test();
}

}  // namespace steadyrest::bench
