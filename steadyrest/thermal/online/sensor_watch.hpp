// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::thermal::online {

/// Decides which temperature sensors of a running machine must not be believed.
///
/// Wild, one of:
///   T < −20 °C or T > 80 °C
///   |T − ρ| > 3 K + 10 K/h·a, where ρ follows T by at most 0.1 K/s while T is believed, and a is
///   the time since it last was: no part of a machine, and no air around it, warms by more than
///   6 K/min for long. A step is believed again once a machine could have come that far.
/// Stuck: T has been the same to the last digit for a time d, and all of
///   d ≥ 2 h, and d ≥ 3 times the longest such time that the sensor survived
///   other sensors of the machine have moved meanwhile: two excursions of 1 K
///   it would have shown a change: it has shown values between the steps of a coarse sensor
///   (0.05 K, 1/16 K, 0.1 °F and multiples); a coarse one must have moved before, and d ≥ 8 h
/// A coarse sensor in a temperature-controlled room is therefore not called stuck: it has never
/// moved, or has often been unchanged for long. A sensor without finer digits that has not moved
/// since the start looks the same, and so does the only sensor of a machine.
///
/// A stuck sensor is believed again when it moves. Unknown (NaN) is neither wild nor stuck. Fixed
/// size, noexcept, no allocation.
class SensorWatch {
 public:
  // The reasons are above; sensor_watch_test.cpp tests each limit from both sides.
  static constexpr double kColdest_c = -20.0;
  static constexpr double kHottest_c = 80.0;
  static constexpr double kStep_k = 3.0;
  static constexpr double kRate_k_s = 0.1;
  static constexpr double kWildRate_k_s = 10.0 / 3600.0;
  static constexpr double kStuck_s = 2.0 * 3600.0;
  static constexpr double kCoarseStuck_s = 8.0 * 3600.0;
  static constexpr double kLonger = 3.0;  ///< than ever before
  static constexpr double kMoved_k = 1.0;
  static constexpr std::uint32_t kMoves = 2;

  struct Sensor {
    bool seen = false;
    bool moved = false;      ///< has changed since the start
    bool away = false;       ///< unknown or wild at the last look
    std::uint8_t steps = 7;  ///< bit i: every value so far lies on the coarse steps i
    kernel::outcome::Reason fault = kernel::outcome::Reason::none;
    double value_c = 0.0;
    double follower_c = 0.0;        ///< ρ
    double away_s = 0.0;            ///< a
    double same_s = 0.0;            ///< d
    double longest_s = 0.0;         ///< of d, alive
    double anchor_c = 0.0;          ///< where its last excursion ended
    std::uint64_t excursions = 0;   ///< its own
    std::uint64_t others_then = 0;  ///< the others', when it stopped to change
  };
  struct State {
    std::array<Sensor, kernel::signal::kMaxTemperatures> sensor{};
    std::uint64_t excursions = 0;  ///< of all
  };

  /// The first `sensors` readings after `elapsed_s` ≥ 0; those that must not be believed become
  /// NaN.
  void update(double elapsed_s, std::size_t sensors,
              kernel::signal::Temperatures& temperature_c) noexcept;

  /// none, thermal_sensor_wild or thermal_sensor_stuck.
  [[nodiscard]] kernel::outcome::Reason fault(std::size_t sensor) const noexcept {
    return state_.sensor[sensor].fault;
  }

  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// A sensor whose numbers are not finite starts over.
  void restore(const State& state) noexcept;
  void reset() noexcept { state_ = {}; }

 private:
  [[nodiscard]] static bool can_be(Sensor& sensor, double elapsed_s, double temperature_c) noexcept;
  void look(Sensor& sensor, double elapsed_s, double temperature_c) noexcept;
  void live(Sensor& sensor, double elapsed_s, double temperature_c) noexcept;

  State state_;
};

}  // namespace steadyrest::thermal::online
