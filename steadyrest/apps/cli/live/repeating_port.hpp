// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::apps::cli::live {

/// A simulated machine that begins its program again whenever it has finished, cold and at the
/// start, after a pause; time goes on. For showing the layer at work.
class RepeatingPort final : public kernel::port::Port {
 public:
  using Make = std::function<kernel::outcome::Result<std::unique_ptr<sim::SimulatedMachine>>()>;

  /// Refused: what `make` refuses.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<RepeatingPort>> open(Make make);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return present_->capability();
  }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
    return present_->write(command);
  }

 private:
  using Made = kernel::outcome::Result<std::unique_ptr<sim::SimulatedMachine>>;

  RepeatingPort(Make make, std::unique_ptr<sim::SimulatedMachine> first)
      : make_(std::move(make)),
        present_(std::move(first)),
        next_(std::async(std::launch::async, make_)) {}
  void begin_again();

  Make make_;
  std::unique_ptr<sim::SimulatedMachine> present_;
  std::future<Made> next_;  ///< made beside the cycle
  double begun_s_ = 0.0;    ///< of the present machine's time
  double last_s_ = 0.0;
  double rested_s_ = 0.0;
  std::uint64_t cycle_ = 0;
};

}  // namespace steadyrest::apps::cli::live
