// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <semaphore>
#include <stop_token>
#include <thread>

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
  RepeatingPort(const RepeatingPort&) = delete;
  RepeatingPort& operator=(const RepeatingPort&) = delete;
  ~RepeatingPort() override;
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
    return present_->write(command);
  }

 private:
  RepeatingPort(Make make, std::unique_ptr<sim::SimulatedMachine> first);
  void make_more(const std::stop_token& ends);
  void begin_again() noexcept;

  Make make_;
  std::unique_ptr<sim::SimulatedMachine> present_;
  double begun_s_ = 0.0;  ///< of the present machine's time
  double last_s_ = 0.0;
  double rested_s_ = 0.0;
  std::uint64_t cycle_ = 0;
  std::unique_ptr<sim::SimulatedMachine> next_;  ///< the maker's until it is made
  std::atomic<bool> is_made_{false};
  std::counting_semaphore<> wanted_{1};
  std::jthread maker_;  ///< beside the cycle; last: it uses the others
};

}  // namespace steadyrest::apps::cli::live
