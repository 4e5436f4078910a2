// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <tests/opcua/live_rig.hpp>

#include <steadyrest/kernel/link/event.hpp>

namespace steadyrest::opcua {
namespace {

using adapters::opcua::Answer;
using adapters::opcua::BridgeClient;
using adapters::opcua::BridgeDevice;
using adapters::opcua::BridgeProcess;
using adapters::opcua::NodePlan;
using adapters::opcua::OpcUaPort;
using kernel::machine::Machine;
using Json = nlohmann::json;

constexpr const char* kUser = "steadyrest";
constexpr const char* kPassword = "Pa55 of the test";

/// Without `s=`, as the server adds it.
std::string bare(const std::string& node) {
  return node.substr(2);
}

Json value_of(const NodePlan::Node& node, const Answer::Value& shown) {
  return node.text         ? Json(shown.text)
         : node.length > 0 ? Json(shown.numbers)
                           : Json(shown.numbers.at(0));
}

Machine with_endpoint(Machine machine, const std::string& endpoint) {
  machine.opcua.endpoint = endpoint;
  return machine;
}

/// Gone when the process ends.
class StateFolders {
 public:
  StateFolders() = default;
  StateFolders(const StateFolders&) = delete;
  StateFolders& operator=(const StateFolders&) = delete;
  ~StateFolders() {
    for (const auto& folder : all_) {
      std::error_code error;
      std::filesystem::remove_all(folder, error);
    }
  }
  std::filesystem::path next() {
    const auto name = fmt::format("opcua-{}-{}", ::getpid(), all_.size());
    return all_.emplace_back(std::filesystem::path(testing::TempDir()) / name);
  }

 private:
  std::vector<std::filesystem::path> all_;
};

}  // namespace

void give_state_folder(Machine& machine) {
  static StateFolders folders;
  const auto folder = folders.next();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "server");
  const auto password = folder / "password";
  std::ofstream(password) << kPassword << "\n";
  std::filesystem::permissions(
      password, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  machine.opcua.certificates = folder.string();
  machine.opcua.password_file = password.string();
  machine.opcua.user = kUser;
}

BridgeClient::Config client_config(const Machine& machine) {
  return {.process = {.script = STEADYREST_OPCUA_BRIDGE},
          .machine = machine.opcua,
          .state_folder = machine.opcua.certificates};
}

void trust(const Machine& machine) {
  const NodePlan plan(machine.opcua);
  BridgeClient client(client_config(machine), plan);
  const double until_s = kernel::link::monotonic_s() + 60.0;
  auto shown = client.certificate();
  while (!shown && kernel::link::monotonic_s() < until_s) {  // a busy computer's
    shown = client.certificate();
  }
  ASSERT_TRUE(shown) << kernel::outcome::text(shown.error());
  const auto done = client.trust(shown->fingerprint);
  ASSERT_TRUE(done) << kernel::outcome::text(done.error());
}

Server::Server(const Machine& machine, ControlSide& control, Json more) {
  auto started = BridgeProcess::start(
      {.script = STEADYREST_SOURCE_DIR "/steadyrest/adapters/opcua/bridge/test/server.mjs"});
  if (!started) {
    throw std::runtime_error(kernel::outcome::text(started.error()));
  }
  process_ = std::move(*started);
  const NodePlan plan(machine.opcua);
  reads_ = plan.reads();
  order_node_ = plan.writes().front().id;
  Json variables = Json::array();
  for (const auto& node : reads_) {
    variables.push_back({{"id", bare(node.id)},
                         {"type", node.text ? "String" : "Double"},
                         {"value", value_of(node, control.show(node.id))},
                         {"read_only", true}});
  }
  for (const auto& node : plan.writes()) {
    variables.push_back({{"id", bare(node.id)},
                         {"value", value_of(node, control.show(node.id))},
                         {"read_only", more.value("orders_read_only", false)}});
  }
  Json message = {{"do", "start"},
                  {"folder", machine.opcua.certificates + "/server"},
                  {"users", {{kUser, kPassword}}},
                  {"variables", std::move(variables)}};
  message.update(more);
  port_ = ask(std::move(message), 60.0).at("port").get<int>();
}

std::string Server::endpoint() const {
  return "opc.tcp://127.0.0.1:" + std::to_string(port_);
}

Json Server::ask(Json message, double timeout_s) {
  message["id"] = ++id_;
  if (!process_->send(message.dump() + "\n")) {
    throw std::runtime_error("the server has ended");
  }
  const auto line = process_->next_line(timeout_s);
  if (!line) {
    throw std::runtime_error("the server does not answer " + message.dump().substr(0, 100));
  }
  Json answer = Json::parse(*line);
  if (!answer.at("ok").get<bool>()) {
    throw std::runtime_error(answer.dump());
  }
  return answer;
}

void Server::push(ControlSide& control) {
  Json values = Json::object();
  for (const auto& node : reads_) {
    values[bare(node.id)] = value_of(node, control.show(node.id));
  }
  ask({{"do", "set"}, {"values", std::move(values)}});
}

std::vector<double> Server::order() {
  return ask({{"do", "get"}, {"ids", {bare(order_node_)}}})
      .at("values")
      .at(0)
      .get<std::vector<double>>();
}

Rig::Rig(const Config& config)
    : machine(config.machine),
      control(
          {.machine = config.machine, .path = config.path, .order_delay_s = config.order_delay_s}),
      server(config.machine, control) {
  machine = with_endpoint(machine, server.endpoint());
  trust(machine);
  auto made = std::make_unique<BridgeDevice>(client_config(machine));
  device = made.get();
  port = OpcUaPort::make(machine, std::move(made)).value();
  last_order_ = server.order();
  connect();
}

void Rig::connect() {
  const double until_s = kernel::link::monotonic_s() + 30.0;
  auto frame = port->read();
  while (!frame && kernel::link::monotonic_s() < until_s) {
    control.step();
    server.push(control);
    frame = port->read();
  }
  EXPECT_TRUE(frame) << kernel::outcome::text(frame.error());
}

void Rig::advance(const std::function<void()>& each) {
  const auto periods =
      static_cast<int>(std::lround(machine.opcua.cycle_s / machine.control.interpolator_period_s));
  for (int i = 0; i < periods; ++i) {
    control.step();
    if (each) {
      each();
    }
  }
  server.push(control);
}

bool Rig::deliver() {
  auto order = server.order();
  if (order == last_order_) {
    return false;
  }
  last_order_ = order;
  control.write(server.order_node(), order);
  return true;
}

bool Rig::write(const kernel::signal::Command& command, double wait_s) {
  const auto before = last_order_;
  // A refusal is of an earlier order; this one is on its way.
  static_cast<void>(port->write(command));
  kernel::link::Event pause;
  const double until_s = kernel::link::monotonic_s() + wait_s;
  for (;;) {
    deliver();
    if (last_order_ != before) {
      return true;
    }
    if (kernel::link::monotonic_s() > until_s) {
      return false;
    }
    pause.wait(0.0005);
  }
}

}  // namespace steadyrest::opcua
