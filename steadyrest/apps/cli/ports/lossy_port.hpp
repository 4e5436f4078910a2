// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include <steadyrest/kernel/port/port.hpp>

namespace steadyrest::apps::cli::live {

/// A simulated machine whose link is lost for a while: what does the layer do, and what is left for
/// looking at it? The machine goes on meanwhile.
class LossyPort final : public kernel::port::Port {
 public:
  /// Lost for `for_s`, from `at_s` of the control's time on.
  LossyPort(std::unique_ptr<kernel::port::Port> machine, double at_s, double for_s) noexcept
      : machine_(std::move(machine)), at_s_(at_s), for_s_(for_s) {}

  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return machine_->capability();
  }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
    return machine_->write(command);
  }

 private:
  std::unique_ptr<kernel::port::Port> machine_;
  double at_s_;
  double for_s_;
};

}  // namespace steadyrest::apps::cli::live
