// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <steadyrest/contour/online/look_ahead.hpp>
#include <steadyrest/contour/online/servo_model.hpp>

namespace steadyrest::contour::online {

/// The point of the path that the tool is kept on while offsets cancel the contour error, and what
/// the axes must be commanded for it.
///
/// Law. A servo lags, so the tool cannot be where the command is; it can be on the path behind it.
/// The tool point y(s) follows the commanded path length s_c as the slowest axis would by itself:
///   ṡ = (s_c − s)/L,   L = max_i (1 − a_i)/k_i,
/// so that on lines nothing changes. Commanding what each axis needs to be at y,
///   k·c′ + a·ċ′ = k·y + ẏ + τ·ÿ    (the inverse of  τ·ẍ + ẋ = k·(c − x) + a·ċ),
/// leaves no contour error and costs no time. Half of the backlash is added in the direction of
/// travel.
///
/// Corners. At a corner ẏ breaks and c′ would jump by ẏ/k. The tool point slows down to
/// `tool_turn_mm_s` over the turn (LookAhead), brakes and accelerates as the control would along
/// the path, and catches up afterwards, while the command goes through the corner at its own speed.
/// The difference is an offset along the path, v·L − (s_c − s); it never passes −`most_behind_mm`.
///
/// Symbols: s, s_c path length, mm; v = ṡ, mm/s; h step, s; k, a, τ of ServoModel.
class ToolPoint {
 public:
  struct Config {
    std::array<double, 3> half_backlash_mm{};
    double most_behind_mm = 0.0;  ///< of that offset
  };

  struct State {
    double position_mm = 0.0;            ///< s
    double speed_mm_s = 0.0;             ///< v
    std::size_t cell = 0;                ///< that holds s
    std::array<double, 3> command_mm{};  ///< c′
    std::array<double, 3> wanted_mm{};   ///< y + ẏ/k + τ·ÿ/k
    std::array<double, 3> side{};        ///< −1, 0, 1: the flank of the screw that carries
  };

  ToolPoint() = default;
  explicit ToolPoint(const Config& config) noexcept : config_(config) {}

  /// Takes over the model that is in force.
  void set_model(std::span<const AxisModel, 3> model) noexcept;
  /// Begins on the path at `position_mm`, with the axes where they are commanded to be there.
  [[nodiscard]] State at(const LookAhead& path, double position_mm,
                         double speed_mm_s) const noexcept;
  /// One step of `h_s` while the command goes from `from_mm` to `to_mm` along the path.
  void advance(const LookAhead& path, double from_mm, double to_mm, double h_s,
               State& state) const noexcept;
  [[nodiscard]] double lag_s() const noexcept { return lag_s_; }

 private:
  [[nodiscard]] double corner_limit_mm_s(const LookAhead& path, const State& state,
                                         double h_s) const noexcept;
  void move(const LookAhead& path, double from_mm, double to_mm, double h_s,
            State& state) const noexcept;
  [[nodiscard]] std::array<double, 3> wanted(const LookAhead& path, State& state,
                                             double acceleration_mm_s2) const noexcept;

  Config config_;
  std::array<AxisModel, 3> model_{};
  double lag_s_ = 0.0;  ///< L
};

/// The point of a cell `delta_mm` after its start.
[[nodiscard]] kernel::signal::Point on_cell(const Cell& cell, double delta_mm) noexcept;

}  // namespace steadyrest::contour::online
