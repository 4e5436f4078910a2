// SPDX-License-Identifier: Apache-2.0
// A control behind an OPC UA server, in real time, for trials of the program as a user tries it:
// steadyrest_opcua_control_server MACHINE.toml PROGRAM SECONDS. Writes a machine file with its
// endpoint, user and password beside it, names it, and ends after the time with one line of JSON.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <tests/opcua/live_rig.hpp>

#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace {

using namespace steadyrest;

/// The file's text with the server's endpoint and the test's user.
std::string changed(std::string text, const std::string& endpoint,
                    const kernel::machine::OpcUa& config) {
  const auto put = [&](const std::string& key, const std::string& value) {
    const std::size_t at = text.find("\n" + key + " = ");
    if (at != std::string::npos) {
      text.erase(at + 1, text.find('\n', at + 1) - at);
    }
    text.insert(text.find("[opcua]\n") + 8, key + " = \"" + value + "\"\n");
  };
  put("endpoint", endpoint);
  put("password_file", config.password_file);
  put("certificates", config.certificates);
  put("mapping", std::filesystem::absolute(config.mapping).string());
  put("user", config.user);
  return text;
}

int run(const std::string& machine_file, const std::string& program, double seconds) {
  auto machine = passport::read(machine_file).value();
  opcua::give_state_folder(machine);
  nc::interpret::Config interpret;
  interpret.dialect = machine.control.dialect;
  auto path = std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_file(program, interpret, machine).value());
  opcua::ControlSide control({.machine = machine, .path = path});
  opcua::Server server(machine, control);
  std::ifstream in(machine_file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string file = machine.opcua.certificates + "/machine.toml";
  std::ofstream(file) << changed(text, server.endpoint(), machine.opcua);
  std::printf("%s\n", file.c_str());
  std::fflush(stdout);
  kernel::link::Event pause;
  const double from_s = kernel::link::monotonic_s();
  const double start_s = control.time_s();
  auto order = server.order();
  double least = 1.0;
  std::size_t obeyed = 0;
  for (double now_s = 0.0; now_s < seconds; now_s = kernel::link::monotonic_s() - from_s) {
    for (auto next = server.order(); next != order; order = next) {
      control.write(server.order_node(), next);
    }
    while (control.time_s() - start_s < now_s) {
      control.step();
      least = std::min(least, control.feed_in_force());
      obeyed += control.obeys() ? 1 : 0;
    }
    server.push(control);
    pause.wait(0.002);
  }
  std::printf(
      "{\"seconds\": %.3f, \"finished\": %s, \"least_feed_ratio\": %.3f, \"obeyed_cycles\": %zu, "
      "\"feed_in_force\": %.3f}\n",
      control.time_s(), control.finished() ? "true" : "false", least, obeyed,
      control.feed_in_force());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: steadyrest_opcua_control_server MACHINE.toml PROGRAM SECONDS\n");
    return 2;
  }
  return run(argv[1], argv[2], std::atof(argv[3]));
}
