// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::thermal::online {

/// Says which temperature sensors of a machine must not be believed, while it runs.
///
/// Wild, one of:
///   T < −20 °C or T > 80 °C
///   |T − ρ| > 3 K + 10 K/h·a, where ρ follows T by at most 0.1 K/s while it is believed, and a is
///   the time since it last was: no part of a machine, and no air around it, warms by more than
///   6 K/min for long. A step is believed again when a machine could have come that far.
/// Stuck: T is the same to the last digit since a time d, and all of
///   d ≥ 2 h, and d ≥ 3 times the longest such time that it has shown alive
///   other sensors of the machine have moved meanwhile: two excursions of 1 K
///   it could have shown it: it has shown values between the steps of a coarse sensor (0.05 K,
///   1/16 K, 0.1 °F and multiples); a coarse one must have moved before, and d ≥ 8 h
/// So a coarse sensor in a room that is held is not called stuck: it has never moved, or has often
/// stood for long. What has no digits between, and has not moved since the start, cannot be told
/// from it; neither can the only sensor of a machine.
///
/// A stuck sensor is believed again when it moves. Unknown (NaN) is neither: it says so itself.
/// Fixed size, noexcept, no allocation.
class SensorWatch {
 public:
  // The reasons are above; each is met from both sides by a test in sensor_watch_test.cpp.
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
    bool away = false;       ///< unknown or wild when last looked at
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

  /// `elapsed_s` ≥ 0 later the first `sensors` read so; what must not be believed becomes NaN.
  void update(double elapsed_s, std::size_t sensors,
              kernel::signal::Temperatures& temperature_c) noexcept;

  /// none, thermal_sensor_wild or thermal_sensor_stuck.
  [[nodiscard]] kernel::outcome::Reason fault(std::size_t sensor) const noexcept {
    return state_.sensor[sensor].fault;
  }

  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// A sensor whose numbers are not finite starts anew.
  void restore(const State& state) noexcept;
  void reset() noexcept { state_ = {}; }

 private:
  [[nodiscard]] static bool can_be(Sensor& sensor, double elapsed_s, double temperature_c) noexcept;
  void look(Sensor& sensor, double elapsed_s, double temperature_c) noexcept;
  void live(Sensor& sensor, double elapsed_s, double temperature_c) noexcept;

  State state_;
};

}  // namespace steadyrest::thermal::online
