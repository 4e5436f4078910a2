// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>
#include <steadyrest/sim/cut/cutting_vibration.hpp>
#include <steadyrest/sim/machine_body.hpp>

namespace steadyrest::sim {

/// The simulated machine: runs a planned program behind the same port as a real control.
///
/// read() runs one cycle of the layer (machine::layer_cycle_s: one interpolator period, or as many
/// as the port of the machine file leaves between two readings) and returns its Frame, including
/// the planned path. write() latches the layer's words; they act from the next period on, as
/// machine_body.hpp describes. A judge that looks in every period calls step() and frame().
/// Where the two periods do not divide, cycles end with the first period that is not before them; a
/// layer that would look more often than the interpolator moves looks once a period.
/// Time stops between calls, so the simulation is as fast as the processor allows. Deterministic:
/// same machine, path, script, commands and seed give the same bytes.
class SimulatedMachine final : public kernel::port::Port {
 public:
  struct Config {
    kernel::machine::Machine machine;
    std::shared_ptr<const nc::plan::PlannedPath> path;  ///< shared: one plan, several runs
    // Designated initialisers may leave it out.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::vector<OperatorAction> operator_actions = {};
    /// What the tool cuts during G1–G3 in the XY plane (turning: any), including vibration; a
    /// plunge along Z cuts nothing. Empty: air.
    std::optional<CuttingVibration::Config> cutting = std::nullopt;
  };

  /// The machine is at the path's start, panel at 100 % (the nearest step).
  static kernel::outcome::Result<std::unique_ptr<SimulatedMachine>> make(const Config& config);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override;
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;

  /// One interpolator period. True: with it a cycle of the layer ends.
  bool step() noexcept;
  /// As the control shows it after the last period.
  [[nodiscard]] kernel::signal::Frame frame() const noexcept;
  /// The program has ended: the command has reached the last setpoint (the axes still lag).
  [[nodiscard]] bool finished() const noexcept { return interpolator_.finished(); }
  /// What really happened at the end of the last period.
  [[nodiscard]] const Truth& truth() const noexcept { return body_.truth(); }
  /// The cut in the last cycle; nullptr when cutting air.
  [[nodiscard]] const CuttingVibration* cutting() const noexcept {
    return cutting_ ? &*cutting_ : nullptr;
  }
  [[nodiscard]] kernel::signal::PathView path() const noexcept { return path_->segments; }

 private:
  SimulatedMachine(const Config& config, MachineBody body, nc::plan::Interpolator interpolator,
                   std::optional<CuttingVibration> cutting);
  void vibrate(const nc::plan::Setpoint& setpoint, double before_rev_s) noexcept;

  std::shared_ptr<const nc::plan::PlannedPath> path_;
  kernel::port::Capability capability_;
  double periods_per_cycle_;
  std::uint64_t periods_ = 0;
  std::uint64_t cycles_ = 0;  ///< that have ended
  double period_s_;
  bool turning_;
  MachineBody body_;
  nc::plan::Interpolator interpolator_;
  std::optional<CuttingVibration> cutting_;
  kernel::signal::Command command_;
};

}  // namespace steadyrest::sim
