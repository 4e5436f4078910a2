// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <utility>

#include <tests/opcua/live_rig.hpp>
#include <tests/opcua/real_time_control.hpp>

#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::opcua {
namespace {

/// The file's text with the server's endpoint and the test's user.
std::string changed(std::string text, const std::string& endpoint,
                    const kernel::machine::OpcUa& config) {
  const auto set = [&](const std::string& key, const std::string& value) {
    const std::size_t at = text.find("\n" + key + " = ");
    if (at != std::string::npos) {
      text.erase(at + 1, text.find('\n', at + 1) - at);
    }
    text.insert(text.find("[opcua]\n") + 8, key + " = " + value + "\n");
  };
  const auto put = [&](const std::string& key, const std::string& value) {
    set(key, "\"" + value + "\"");
  };
  set("reply_ms", "10000");  // a busy computer's
  put("endpoint", endpoint);
  put("password_file", config.password_file);
  put("certificates", config.certificates);
  put("mapping", std::filesystem::absolute(config.mapping).string());
  put("user", config.user);
  return text;
}

kernel::machine::Machine with_state_folder(const std::string& machine_file) {
  auto machine = passport::read(machine_file).value();
  give_state_folder(machine);
  return machine;
}

}  // namespace

struct RealTimeControl::Parts {
  Parts(const std::string& machine_file, const std::shared_ptr<const nc::plan::PlannedPath>& path)
      : machine(with_state_folder(machine_file)),
        control({.machine = machine, .path = path}),
        server(machine, control) {}

  kernel::machine::Machine machine;
  ControlSide control;
  Server server;
  std::mutex mutex;
  Seen seen;
};

RealTimeControl::RealTimeControl(const std::string& machine_file,
                                 const std::shared_ptr<const nc::plan::PlannedPath>& path) {
  parts_ = std::make_unique<Parts>(machine_file, path);
  std::ifstream in(machine_file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  std::ofstream(this->machine_file())
      << changed(text, parts_->server.endpoint(), parts_->machine.opcua);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

RealTimeControl::~RealTimeControl() = default;

std::string RealTimeControl::machine_file() const {
  return parts_->machine.opcua.certificates + "/machine.toml";
}

RealTimeControl::Seen RealTimeControl::seen() const {
  const std::scoped_lock lock(parts_->mutex);
  return parts_->seen;
}

void RealTimeControl::run(const std::stop_token& stop) {
  auto& [machine, control, server, mutex, seen] = *parts_;
  kernel::link::Event pause;
  const double from_s = kernel::link::monotonic_s();
  const double start_s = control.time_s();
  auto order = server.order();
  while (!stop.stop_requested()) {
    const double now_s = kernel::link::monotonic_s() - from_s;
    for (auto next = server.order(); next != order; order = next) {
      control.write(server.order_node(), next);
    }
    while (control.time_s() - start_s < now_s) {
      control.step();
      const std::scoped_lock lock(mutex);
      seen.time_s = control.time_s();
      seen.finished = control.finished();
      seen.feed_in_force = control.feed_in_force();
      seen.least_feed_ratio = std::min(seen.least_feed_ratio, seen.feed_in_force);
      seen.obeyed_cycles += control.obeys() ? 1 : 0;
    }
    server.push(control);
    pause.wait(0.002);
  }
}

}  // namespace steadyrest::opcua
