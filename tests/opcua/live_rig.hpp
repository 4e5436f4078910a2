// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tests/opcua/control_side.hpp>

#include <steadyrest/adapters/opcua/bridge_client.hpp>
#include <steadyrest/adapters/opcua/bridge_device.hpp>
#include <steadyrest/adapters/opcua/bridge_process.hpp>
#include <steadyrest/adapters/opcua/opcua_port.hpp>

namespace steadyrest::opcua {

/// A node-opcua server as the control's, in a process of its own, behind a relay.
class Server {
 public:
  /// `nodes`: as the mapping names them; their values now come from `control`. Throws.
  Server(const kernel::machine::Machine& machine, ControlSide& control,
         nlohmann::json more = nlohmann::json::object());

  nlohmann::json ask(nlohmann::json message, double timeout_s = 20.0);
  [[nodiscard]] std::string endpoint() const;
  /// What the control shows goes to the server.
  void push(ControlSide& control);
  [[nodiscard]] std::vector<double> order();
  void way(const std::string& word) { ask({{"do", "way"}, {"way", word}}); }
  [[nodiscard]] pid_t process() const noexcept { return process_->process(); }
  [[nodiscard]] const std::string& order_node() const noexcept { return order_node_; }

 private:
  std::unique_ptr<adapters::opcua::BridgeProcess> process_;
  std::vector<adapters::opcua::NodePlan::Node> reads_;
  std::string order_node_;
  int port_ = 0;
  std::uint64_t id_ = 0;
};

/// The whole circle: control, server, bridge, port. Time is the control's.
class Rig {
 public:
  struct Config {
    kernel::machine::Machine machine;  ///< its endpoint is filled in
    std::shared_ptr<const nc::plan::PlannedPath> path;
    double order_delay_s = 0.0;
  };
  explicit Rig(const Config& config);

  /// The control goes on for one cycle of the layer, and the server shows where it is. `each`:
  /// after every interpolator period.
  void advance(const std::function<void()>& each = {});
  /// The newest order on the server goes to the control; false: it has it already.
  bool deliver();
  /// Hands over, waits until the server has it (at most `wait_s`), and delivers it.
  bool write(const kernel::signal::Command& command, double wait_s = 2.0);
  /// Until the port has a frame, at most 30 s of the computer's time.
  void connect();
  kernel::outcome::Result<kernel::signal::Frame> read() { return port->read(); }

  kernel::machine::Machine machine;
  ControlSide control;
  Server server;
  adapters::opcua::BridgeDevice* device = nullptr;
  std::unique_ptr<adapters::opcua::OpcUaPort> port;

 private:
  std::vector<double> last_order_;
};

/// A folder of the test's own with a password in it; machine.opcua points to it.
void give_state_folder(kernel::machine::Machine& machine);
[[nodiscard]] adapters::opcua::BridgeClient::Config client_config(
    const kernel::machine::Machine& machine);
/// Compares and trusts, as the user does by `steadyrest opcua trust`.
void trust(const kernel::machine::Machine& machine);

}  // namespace steadyrest::opcua
