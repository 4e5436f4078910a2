// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/supervisor/motion_stage.hpp>

namespace steadyrest::live {

/// A port of a machine whose encoders are read but whose control shows no commanded positions: the
/// frames get what each axis must be following.
///
/// Law, for an axis at x with velocity v and acceleration a by the motion room's estimate:
///   c = x + ((1 − α)·v + τ·a)/k
/// k servo gain, α feed-forward, τ velocity lag: the servo's law solved for its command. The path
/// speed is that of c. Error of c along the path: (1 − α)·δv/k; across it the same, which the path
/// takes away (FollowedPort::Config::estimated). Friction and backlash are not in it: some
/// micrometres more where an axis turns.
class CommandedPort final : public kernel::port::Port {
 public:
  /// `machine` outlives this. Refused: as by MotionStage.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<CommandedPort>> make(
      kernel::port::Port& port, const kernel::machine::Machine& machine);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return port_.capability();
  }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
    return port_.write(command);
  }

 private:
  CommandedPort(kernel::port::Port& port, const kernel::machine::Machine& machine,
                supervisor::MotionStage motion);

  kernel::port::Port& port_;
  std::vector<kernel::machine::Axis> axes_;
  supervisor::MotionStage motion_;
  kernel::signal::AxisValues before_mm_{};
  double before_s_ = 0.0;
  bool started_ = false;
};

}  // namespace steadyrest::live
