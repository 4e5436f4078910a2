// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <steadyrest/nc/plan/time/setpoint.hpp>

namespace steadyrest::nc::plan {

/// What a machine does with one tool and one spindle speed.
enum class Load : std::uint8_t {
  standing,  ///< the spindle is stopped
  running,   ///< it turns, no feed moves
  cutting    ///< it turns, with feed moves
};
[[nodiscard]] std::string_view name(Load load) noexcept;

/// A technological transition: from one change of tool, commanded spindle speed or coolant to the
/// next.
struct Transition {
  std::int64_t tool = 0;
  double speed_rev_s = 0.0;  ///< commanded at its beginning, signed
  double start_s = 0.0;
  double seconds = 0.0;
  double cut_s = 0.0;      ///< of these, in feed moves
  double cut_mm = 0.0;     ///< their length
  double path_mm = 0.0;    ///< length of all moves, rapids included
  bool coolant = false;    ///< it flows
  std::uint32_t line = 0;  ///< where it begins

  [[nodiscard]] Load load() const noexcept {
    return speed_rev_s == 0.0 ? Load::standing : cut_s > 0.0 ? Load::cutting : Load::running;
  }
  /// Mean feed of the feed moves, mm/s.
  [[nodiscard]] double feed_mm_s() const noexcept { return cut_s > 0.0 ? cut_mm / cut_s : 0.0; }
  /// Mean speed along the path over all of it, rapids and standstill included.
  [[nodiscard]] double path_speed_mm_s() const noexcept {
    return seconds > 0.0 ? path_mm / seconds : 0.0;
  }
  /// Share of its time in feed moves.
  [[nodiscard]] double cut_share() const noexcept { return seconds > 0.0 ? cut_s / seconds : 0.0; }
};

/// The cyclogram of a program (Marusich's first block): transitions in order, without gaps.
///
/// A varying speed (G96) begins a new transition once it is 5 % off the transition's first speed.
/// After `kMost` transitions the last one takes everything, so memory is bounded.
class Cyclogram {
 public:
  static constexpr std::size_t kMost = 100'000;

  /// One interpolator period of the running program.
  void add(const Setpoint& setpoint, std::int64_t tool, double time_s, double period_s);
  [[nodiscard]] const std::vector<Transition>& transitions() const noexcept { return transitions_; }

 private:
  [[nodiscard]] bool goes_on(const Setpoint& setpoint, std::int64_t tool) const noexcept;

  std::vector<Transition> transitions_;
};

}  // namespace steadyrest::nc::plan
