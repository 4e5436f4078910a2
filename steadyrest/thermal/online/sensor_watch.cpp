// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <steadyrest/thermal/online/sensor_watch.hpp>

// Two questions for each reading: can a machine be that warm, coming from where it was (can_be),
// and is a sensor that repeats itself for hours still alive (live)? Doubtful readings become NaN,
// so the model treats such a sensor as missing.
namespace steadyrest::thermal::online {

using kernel::outcome::Reason;
using kernel::signal::Temperatures;

namespace {

/// Steps per kelvin of coarse sensors: 0.05 K, 1/16 K, 0.1 °F; their multiples are included.
constexpr std::array kStepsInK = {20.0, 16.0, 18.0};
/// Distance of a single-precision value from its step.
constexpr double kOnStep = 1e-3;

std::uint8_t steps_of(double temperature_c) noexcept {
  std::uint8_t steps = 0;
  for (std::size_t i = 0; i < kStepsInK.size(); ++i) {
    const double scaled = temperature_c * kStepsInK[i];
    if (std::abs(scaled - std::round(scaled)) < kOnStep) {
      steps = static_cast<std::uint8_t>(steps | (1U << i));
    }
  }
  return steps;
}

bool usable_sensor(const SensorWatch::Sensor& s) noexcept {
  return std::isfinite(s.value_c) && std::isfinite(s.follower_c) && std::isfinite(s.same_s) &&
         std::isfinite(s.longest_s) && std::isfinite(s.anchor_c) && std::isfinite(s.away_s);
}

}  // namespace

void SensorWatch::update(double elapsed_s, std::size_t sensors,
                         Temperatures& temperature_c) noexcept {
  // A clock that jumps back must not shorten the waits.
  const double elapsed = elapsed_s >= 0.0 && std::isfinite(elapsed_s) ? elapsed_s : 0.0;
  for (std::size_t i = 0; i < std::min(sensors, temperature_c.size()); ++i) {
    Sensor& sensor = state_.sensor[i];
    if (std::isfinite(temperature_c[i])) {
      look(sensor, elapsed, temperature_c[i]);
    } else {
      sensor.fault = Reason::none;  // unknown, hence neither
      sensor.away = true;
      sensor.away_s += elapsed;
    }
    if (sensor.fault != Reason::none) {
      temperature_c[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

bool SensorWatch::can_be(Sensor& sensor, double elapsed_s, double temperature_c) noexcept {
  if (temperature_c < kColdest_c || temperature_c > kHottest_c) {
    return false;
  }
  if (!sensor.seen) {
    return true;
  }
  // Follows only while the sensor is believed: after a step it waits until the machine could have
  // come that far.
  if (!sensor.away) {
    const double reach = kRate_k_s * elapsed_s;
    sensor.follower_c += std::clamp(temperature_c - sensor.follower_c, -reach, reach);
  }
  return std::abs(temperature_c - sensor.follower_c) <= kStep_k + kWildRate_k_s * sensor.away_s;
}

void SensorWatch::look(Sensor& sensor, double elapsed_s, double temperature_c) noexcept {
  sensor.away_s += sensor.away ? elapsed_s : 0.0;
  if (!can_be(sensor, elapsed_s, temperature_c)) {
    sensor.fault = Reason::thermal_sensor_wild;
    sensor.away = true;
    return;
  }
  if (!sensor.seen) {
    sensor = {.seen = true,
              .steps = steps_of(temperature_c),
              .value_c = temperature_c,
              .follower_c = temperature_c,
              .anchor_c = temperature_c,
              .others_then = state_.excursions};
    return;
  }
  if (sensor.away) {
    sensor.away = false;
    sensor.away_s = 0.0;
    sensor.follower_c = temperature_c;
  }
  live(sensor, elapsed_s, temperature_c);
}

/// A plausible value.
void SensorWatch::live(Sensor& sensor, double elapsed_s, double temperature_c) noexcept {
  // An excursion ends a kelvin away from where the last one ended: noise never adds up to that.
  if (std::abs(temperature_c - sensor.anchor_c) >= kMoved_k) {
    sensor.anchor_c = temperature_c;
    ++sensor.excursions;
    ++state_.excursions;
  }
  // Excursions of the other sensors only.
  const std::uint64_t others = state_.excursions - sensor.excursions;
  if (temperature_c != sensor.value_c) {
    if (sensor.fault != Reason::thermal_sensor_stuck) {
      // Learnt only from times when it was alive, or a stuck sensor would raise its own limit.
      sensor.longest_s = std::max(sensor.longest_s, sensor.same_s);
    }
    sensor.value_c = temperature_c;
    // A single value between the steps proves a sensor fine for good.
    sensor.steps = static_cast<std::uint8_t>(sensor.steps & steps_of(temperature_c));
    sensor.moved = true;
    sensor.same_s = 0.0;
    sensor.others_then = others;
    sensor.fault = Reason::none;
    return;
  }
  sensor.same_s += elapsed_s;
  const bool coarse = sensor.steps != 0;
  const double least_s = std::max(coarse ? kCoarseStuck_s : kStuck_s, kLonger * sensor.longest_s);
  const bool stuck = sensor.same_s >= least_s && others - sensor.others_then >= kMoves &&
                     (sensor.moved || !coarse);
  sensor.fault = stuck ? Reason::thermal_sensor_stuck : Reason::none;
}

void SensorWatch::restore(const State& state) noexcept {
  state_ = state;
  for (Sensor& sensor : state_.sensor) {
    if (!usable_sensor(sensor)) {
      sensor = {};
    }
  }
}

}  // namespace steadyrest::thermal::online
