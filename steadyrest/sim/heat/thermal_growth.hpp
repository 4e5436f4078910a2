// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/sim/base/noise.hpp>

namespace steadyrest::sim {

/// Thermal growth of the simulated machine: the true effect of heat on each displacement.
///
/// A machine with a thermal passport is a set of bodies, one for each mode of the passport and one
/// for each ambient input. A body stores heat, gains it from spindle, feed and coolant state, and
/// loses it in proportion to its own warmth:
///   q' = P − q/τ,   P = G/τ,   displacement Σ q + Σ b·(θ − θ at the start),   θ' = (T_room − θ)/τ
/// solved exactly over a period of constant inputs (existing warmth decays, incoming warmth adds
/// up). τ, G and b are the passport's times 1 + error (`simulation.thermal_*_error`): the layer's
/// belief and the truth differ by that on purpose. On top comes what no model knows, a first-order
/// process of RMS `drift_mm` that begins at 0.
///
/// Room: T = room_c + swing·cos(2π·(hour − 15)/24) + coloured noise (correlation 10 min).
/// It starts cold: no body is warm, and the surroundings have settled at the room's temperature.
/// The part's zero is set in this state, so every displacement begins at 0. Same machine, seed and
/// inputs: same bytes with every compiler (portable.hpp).
class ThermalGrowth {
 public:
  struct Config {
    kernel::machine::Thermal passport;
    // Designated initialisers may leave it out.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    kernel::machine::Simulation simulation = {};
    double period_s = 1.0;  ///< of update(), 1e-4 … 60
    double drift_mm = 0.0;  ///< RMS, on each axis, with the passport's `drift_tau`; 0 … 10
  };
  /// Means over one period.
  struct Input {
    double speed_rev_s = 0.0;  ///< actual, not commanded
    double feed_mm_s = 0.0;    ///< along the path
    double cutting = 0.0;      ///< share of the period in feed moves
    bool coolant = false;
  };

  /// Refuses time constants that are not positive, levels that do not match their speeds, and
  /// simulation numbers out of range.
  static kernel::outcome::Result<ThermalGrowth> make(const Config& config);

  /// One period.
  void update(const Input& input) noexcept;

  /// In the order of the passport's axes, mm since the start: positive moves the tool towards
  /// larger positions.
  [[nodiscard]] std::size_t axes() const noexcept { return axis_.size(); }
  [[nodiscard]] double displacement_mm(std::size_t axis) const noexcept {
    return axis_[axis].displacement_mm;
  }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  [[nodiscard]] double room_c() const noexcept { return room_c_; }
  /// Reads the room's temperature, with the sensor's noise.
  double read_room_c() noexcept;
  /// Reads a length whose true value is `true_mm`, with the probe's noise.
  double read_probe_mm(double true_mm) noexcept;

 private:
  struct Body {
    kernel::machine::ThermalMode mode;  ///< the true one
    double turning_decay = 0.0;         ///< share of its warmth left after a period
    double resting_decay = 0.0;
    double warmth_mm = 0.0;
  };
  struct Surrounding {
    double gain_mm_c = 0.0;
    double decay = 0.0;
    double start_c = 0.0;
    double lagged_c = 0.0;
  };
  struct Axis {
    std::vector<Body> body;
    std::vector<Surrounding> surrounding;
    double drift_decay = 0.0;
    double drift_fresh_mm = 0.0;  ///< RMS of what each period adds
    double drift_mm = 0.0;
    double displacement_mm = 0.0;
  };

  explicit ThermalGrowth(const Config& config);
  void room() noexcept;

  double period_s_;
  kernel::machine::Simulation simulation_;
  NormalNoise weather_;  ///< of the truth; readings have their own
  NormalNoise readings_;
  ColouredNoise draught_;
  std::vector<Axis> axis_;
  double time_s_ = 0.0;
  double room_c_ = 0.0;
  std::uint64_t periods_ = 0;
};

}  // namespace steadyrest::sim
