// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/machine/machine.hpp>

/// What a spindle drive and its override can follow of a speed law N(t) = N₀·(1 + RVA·S(f·t)), f =
/// RVF·N₀.
///
/// Swept laws (triangle, sine, random): |dN/dt| ≤ RVA·f·N₀·max|S'| must stay within the drive's
/// acceleration (triangle: max|S'| = 4, so RVA·RVF·N₀²/15 rpm/s with N₀ in rpm; sine: 2π).
/// Laws with jumps (square, pulse, stop) ramp at the drive's acceleration a: the ramp RVA·N₀·(max S
/// − min S)/a may take a fifth of the law's shortest part.
/// Power: J·ω·dω/dt at its greatest and the cut's own; torque: J·dω/dt and the cut's own; heat: the
/// RMS of both. The cut: Kt and the edge on the mean chip, at the mean speed. Override: its steps
/// must come within a quarter of the amplitude of the law; a period has at least 8 scans; the
/// envelope's slew, and one step per scan where the word is walked, count like an acceleration.
/// Dead time only shifts a law written ahead and limits nothing. Speed monitor: the set-point moves
/// with the override, so the actual speed is off by one step or by the law's change within one scan
/// (swept), or by the whole jump while it ramps.
namespace steadyrest::chatter::offline {

enum class DriveLimit : std::uint8_t {
  speed,         ///< spindle's limits
  levels,        ///< the override's steps or the envelope do not allow it
  scan,          ///< too few scans in a period
  acceleration,  ///< of the drive
  slew,          ///< of the envelope
  walk,          ///< a word walked step by step
  ramp,          ///< jumps take too much of the law's parts
  power,
  torque,
  heat,    ///< RMS torque
  monitor  ///< the control's tolerance band of the speed
};

struct DriveViolation {
  DriveLimit limit = DriveLimit::speed;
  std::string reason;  ///< in words, with the needed and the available value
};

struct DriveDemand {
  double acceleration_rev_s2 = 0.0;  ///< the greatest
  double power_w = 0.0;              ///< the greatest, including the cut's
  double torque_n_m = 0.0;           ///< the greatest, including the cut's
  double rms_torque_n_m = 0.0;
  double off_ratio = 0.0;             ///< actual speed off its set-point, over the set-point
  std::vector<double> written_ratio;  ///< the override's steps that the law uses, rising
  std::vector<DriveViolation> violations;

  [[nodiscard]] bool possible() const noexcept { return violations.empty(); }
};

class DriveLimits {
 public:
  struct Options {
    bool keep_speed_band = true;  ///< false: leaving the monitor's band is no violation
  };

  DriveLimits(const kernel::machine::Machine& machine, const Process& process, double depth_mm,
              const Options& options);

  /// A constant speed at the override `ratio` of the programmed one; the ratio is not checked.
  [[nodiscard]] DriveDemand constant(double programmed_rev_s, double ratio) const;
  /// A law about the programmed speed. `modulation.rva` 0 … below 1, `rvf` > 0.
  [[nodiscard]] DriveDemand modulated(double programmed_rev_s, const Modulation& modulation) const;
  /// The greatest RVF within `low` … `high` that can be followed; all demands grow with it. Empty:
  /// not even `low`.
  [[nodiscard]] std::optional<double> most_rvf(double programmed_rev_s, Modulation modulation,
                                               double low, double high) const;

  /// Override ratios that may be written at this programmed speed: steps of the table within the
  /// control's clip, the envelope and the spindle's limits; rising, each once.
  [[nodiscard]] std::vector<double> writable(double programmed_rev_s) const;
  /// Mean cutting power at a speed, W.
  [[nodiscard]] double cutting_power_w(double speed_rev_s) const noexcept;

 private:
  struct Shape;
  [[nodiscard]] Shape shape(const Modulation& modulation) const;
  void check_levels(double speed, const Modulation& m, const Shape& s, DriveDemand& out) const;
  void check_sweep(double speed, const Modulation& m, const Shape& s, DriveDemand& out) const;
  void check_jumps(double speed, const Modulation& m, const Shape& s, DriveDemand& out) const;
  void check_load(double speed, DriveDemand& out) const;
  void check_monitor(double speed, const Modulation& m, const Shape& s, DriveDemand& out) const;
  [[nodiscard]] double step_ratio(const DriveDemand& demand) const noexcept;

  kernel::machine::Spindle spindle_;
  kernel::machine::OverrideTable table_;
  kernel::machine::Envelope envelope_;
  Options options_;
  double power_per_rev_w_s_ = 0.0;  ///< cutting power at 1 rev/s
};

[[nodiscard]] const char* name(DriveLimit limit) noexcept;

}  // namespace steadyrest::chatter::offline
