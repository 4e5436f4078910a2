// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <steadyrest/adapters/opcua/bridge_process.hpp>
#include <steadyrest/adapters/opcua/node_plan.hpp>
#include <steadyrest/adapters/opcua/wire.hpp>
#include <steadyrest/kernel/machine/links/opcua.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::opcua {

/// Runs the bridge and asks it, one request at a time. Of one thread, which may wait.
///
/// A bridge that ends, hangs or says what is no answer is ended and started again, after a pause
/// that doubles from 0.1 s to 5 s as long as it does not connect.
class BridgeClient {
 public:
  struct Config {
    BridgeProcess::Config process;
    kernel::machine::OpcUa machine;
    std::string state_folder;
  };

  BridgeClient(Config config, const NodePlan& plan);

  /// Waits until the bridge has a session with the control. Refused: why it has none now.
  [[nodiscard]] kernel::outcome::Result<void> connect(double patience_s);
  [[nodiscard]] kernel::outcome::Result<Answer> read() { return ask("read"); }
  [[nodiscard]] kernel::outcome::Result<Answer> write(
      const std::vector<std::vector<double>>& values);
  [[nodiscard]] kernel::outcome::Result<Answer> check() { return ask("check"); }
  /// The control's certificate, trusted or not; needs no session.
  [[nodiscard]] kernel::outcome::Result<Answer> certificate();
  [[nodiscard]] kernel::outcome::Result<Answer> trust(const std::string& fingerprint);

  /// Bridges that were started. Of the same thread, as process_id().
  [[nodiscard]] std::uint64_t starts() const noexcept { return starts_; }
  [[nodiscard]] pid_t process_id() const noexcept { return process_ ? process_->process() : -1; }

 private:
  [[nodiscard]] kernel::outcome::Result<void> start(double until_s);
  [[nodiscard]] kernel::outcome::Result<Answer> ask(std::string_view act);
  [[nodiscard]] kernel::outcome::Result<Answer> exchange(const std::string& line, std::uint64_t id,
                                                         double patience_s);
  /// Takes one line into account. None: no line within the time.
  [[nodiscard]] std::optional<Answer> take(double until_s);
  [[nodiscard]] kernel::outcome::Refusal lost() const;
  void drop() noexcept;

  Config config_;
  const NodePlan& plan_;
  std::vector<bool> writes_arrays_;
  std::unique_ptr<BridgeProcess> process_;
  std::uint64_t id_ = 0;
  std::uint64_t starts_ = 0;
  double pause_s_ = 0.0;
  double not_before_s_ = 0.0;
  bool said_hello_ = false;
  std::string state_;
  std::string why_;
  std::string detail_;
};

}  // namespace steadyrest::adapters::opcua
