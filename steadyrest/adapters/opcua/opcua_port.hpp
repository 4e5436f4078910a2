// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <steadyrest/adapters/opcua/frame.hpp>
#include <steadyrest/adapters/opcua/order_watch.hpp>
#include <steadyrest/adapters/opcua/reading.hpp>
#include <steadyrest/kernel/link/exchange.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/kernel/rt/snapshot.hpp>

namespace steadyrest::adapters::opcua {

/// The NC program as the last frame showed it.
struct ShownProgram {
  std::array<char, kLongestName + 1> name{};  ///< empty: not known
  kernel::signal::ProgramState state = kernel::signal::ProgramState::unknown;
};

/// A control behind an OPC UA server as a machine.
///
/// read() asks for the control's newest sample and waits for it, `reply_s` at most. Time is the
/// control's own (`time_s` of the mapping) where it shows one, else the server's time stamp; where
/// it goes back (the control was started again), it continues from the last frame. write() leaves
/// an order with a new heartbeat and returns. Once the control has shown that it takes another
/// layer's orders, this one has let go for good: both are refused. Orders that the control's side
/// does not take (it shows that it is not alive for a second and three dead men) go out all the
/// same, and write() says so.
class OpcUaPort final : public kernel::port::Port {
 public:
  using Device = kernel::link::Device<Reading, Order>;

  static kernel::outcome::Result<std::unique_ptr<OpcUaPort>> make(
      const kernel::machine::Machine& machine, std::unique_ptr<Device> device);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override;
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;

  /// The control's side obeys the layer, by the last frame; none: it does not show it. Any thread.
  [[nodiscard]] std::optional<bool> in_force() const noexcept;
  /// One thread, which is not the cycle's.
  [[nodiscard]] ShownProgram program() noexcept { return program_.load(); }

 private:
  OpcUaPort(const kernel::machine::Machine& machine,
            std::optional<kernel::override::Table> feed_table, std::unique_ptr<Device> device);
  [[nodiscard]] double time_of(const Reading& reading) noexcept;
  [[nodiscard]] kernel::outcome::Result<void> check_alone() const noexcept;
  [[nodiscard]] kernel::outcome::Result<void> check_heeded() const noexcept;

  kernel::machine::Machine machine_;
  Mapped mapped_;
  std::optional<kernel::override::Table> feed_table_;
  kernel::port::Capability capability_;
  std::uint64_t cycle_ = 0;
  double last_s_ = 0.0;            ///< of the last frame
  double shift_s_ = 0.0;           ///< frame's time less the control's
  std::uint32_t first_heartbeat_;  ///< by chance: two layers that begin together differ
  bool beats_in_bytes_;            ///< the control takes heartbeats as a PLC's byte
  OrderWatch orders_;
  bool ordered_ = false;     ///< since the last reading
  double unheeded_s_ = 0.0;  ///< the control has not been alive for so long, in spite of orders
  std::atomic<int> in_force_{-1};
  kernel::rt::Snapshot<ShownProgram> program_;
  kernel::link::Exchange<Reading, Order> exchange_;  ///< last: its thread ends first
};

}  // namespace steadyrest::adapters::opcua
