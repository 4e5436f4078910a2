// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include <steadyrest/adapters/opcua/bridge_client.hpp>
#include <steadyrest/adapters/opcua/node_plan.hpp>
#include <steadyrest/adapters/opcua/reading.hpp>
#include <steadyrest/kernel/link/exchange.hpp>

namespace steadyrest::adapters::opcua {

/// The control behind the bridge, for the thread of an exchange.
///
/// A block that is torn (its first and last number differ) is read again at once, three times at
/// most; one that is the last one's again after 2 ms, five times at most.
class BridgeDevice final : public kernel::link::Device<Reading, Order> {
 public:
  explicit BridgeDevice(BridgeClient::Config config)
      : plan_(config.machine),
        guarded_(plan_.reads(kernel::machine::Quantity::sample_begin) &&
                 plan_.reads(kernel::machine::Quantity::sample_end)),
        patience_s_(config.machine.reply_s),
        config_(config.machine),
        client_(std::move(config), plan_) {}

  /// For those who can wait longer than a cycle may, before the thread begins.
  [[nodiscard]] kernel::outcome::Result<void> connect(double patience_s) {
    return client_.connect(patience_s);
  }
  /// What is wrong with the mapping's nodes on this control, which is connected: see node_faults().
  [[nodiscard]] kernel::outcome::Result<std::vector<kernel::outcome::Refusal>> check();
  kernel::outcome::Result<void> read(Reading& sample) override;
  kernel::outcome::Result<void> write(const Order& order) override;

  /// From any thread: bridges started, and the newest one's process.
  [[nodiscard]] std::uint64_t starts() const noexcept { return starts_.load(); }
  [[nodiscard]] pid_t process_id() const noexcept { return process_.load(); }

 private:
  NodePlan plan_;
  bool guarded_;  ///< by a number first and last
  double patience_s_;
  kernel::machine::OpcUa config_;
  BridgeClient client_;
  double last_sample_ = -1.0;
  std::atomic<std::uint64_t> starts_{0};
  std::atomic<pid_t> process_{-1};
};

}  // namespace steadyrest::adapters::opcua
