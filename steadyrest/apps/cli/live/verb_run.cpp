// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/live/live_port.hpp>
#include <steadyrest/apps/cli/live/run_record.hpp>
#include <steadyrest/apps/cli/live/socket_option.hpp>
#include <steadyrest/apps/cli/live/verb_run.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/live/control_socket.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/live/realtime.hpp>
#include <steadyrest/live/status_json.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// The loop runs in this thread, the socket in another. A signal asks for the end; the layer hands
// back first.
namespace steadyrest::apps::cli {
namespace live {
namespace {

using steadyrest::live::Loop;
using steadyrest::live::LoopFigures;

struct Options {
  std::string machine;
  ProgramOptions program;
  std::string mode;
  std::string socket;
  std::string record;  ///< folder; empty: no record
  double for_s = 0.0;
};

std::atomic<Loop*> running{nullptr};

/// A second signal ends the process at once: the machine's watchdog hands back then.
void on_signal(int /*signal*/) {
  if (Loop* const loop = running.exchange(nullptr); loop != nullptr) {
    loop->ask_stop();
  }
}

/// SIGINT and SIGTERM end the loop while this lives.
class StopSignals {
 public:
  explicit StopSignals(Loop& loop) {
    running.store(&loop);
    struct sigaction now{};
    now.sa_handler = on_signal;
    now.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &now, &interrupt_);
    ::sigaction(SIGTERM, &now, &terminate_);
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals() {
    ::sigaction(SIGINT, &interrupt_, nullptr);
    ::sigaction(SIGTERM, &terminate_, nullptr);
    running.store(nullptr);
  }

 private:
  struct sigaction interrupt_{};
  struct sigaction terminate_{};
};

std::string text_of(const LoopFigures& figures, const Json& json) {
  Table table({"run", ""});
  const auto us = [&](const char* key) { return fmt::format("{:.1f} µs", json.value(key, 0.0)); };
  table.row({"cycles, overruns", fmt::format("{}, {}", figures.cycles, figures.overruns)})
      .row({"work, median and p99.9", us("work_p50_us") + ", " + us("work_p999_us")})
      .row({"lateness, p99.9", us("lateness_p999_us")})
      .row({"over the limit", fmt::format("{:.2f} s", figures.over_limit_s)});
  for (const auto& [name, cycles] : json["reasons"].items()) {
    table.row({name, fmt::format("{} cycles", cycles.get<std::uint64_t>())});
  }
  std::string text = table.text();
  if (figures.port_faults > 0) {
    text +=
        fmt::format("the port could not be read or written in {} cycles\n", figures.port_faults);
  }
  if (!figures.handed_back) {
    text += "ended before all was handed back: the machine's watchdog takes over what was left\n";
  }
  return text;
}

Loop::Config loop_config(const Options& options, const kernel::machine::Machine& machine,
                         const LivePort& port) {
  Loop::Config config{.period_s = port.period_s,
                      .contour_limit_mm = machine.contour.limit_mm,
                      .mode = steadyrest::live::mode_of(options.mode).value_or(machine.mode),
                      .port_paces = port.paces,
                      .finished = port.finished};
  if (options.for_s > 0.0) {
    config.most_cycles = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(std::llround(options.for_s / port.period_s)));
  }
  return config;
}

Outcome run(const Options& options) {
  auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  auto port = open_port(*machine, options.program);
  if (!port) {
    return std::unexpected(port.error());
  }
  auto layer = supervisor::Supervisor::make(*machine, port->port->capability());
  if (!layer) {
    return refused(layer.error());
  }
  Loop::Config config = loop_config(options, *machine, *port);
  if (auto checked = Loop::check(config); !checked) {
    return refused(checked.error());
  }
  steadyrest::live::MonotonicPace pace(config.period_s);
  auto record = RunRecord::start({.folder = options.record,
                                  .machine_file = options.machine,
                                  .machine = machine->name,
                                  .program_file = options.program.file},
                                 *port);
  if (!record) {
    return refused(record.error());
  }
  if (*record) {
    (*record)->listen_to(config);
  }
  Loop loop(*record ? (*record)->port() : *port->port, *layer, pace, config);
  const std::string word(passport::word(machine->port));
  const auto socket =
      steadyrest::live::ControlSocket::open(options.socket, [&](std::string_view line) {
        return steadyrest::live::answer({.loop = loop, .port = word, .program = port->program},
                                        line);
      });
  if (!socket) {
    return refused(socket.error());
  }
  const auto real_time = steadyrest::live::ask_for_real_time();
  const StopSignals signals(loop);
  const LoopFigures& figures = loop.run();
  Answer answer;
  answer.json = steadyrest::live::figures_json(figures);
  answer.json["machine"] = machine->name;
  answer.json["port"] = word;
  if (port->program) {
    answer.json["program"] = port->program();
  }
  answer.json["memory_locked"] = real_time.memory_locked;
  answer.json["real_time_priority"] = real_time.priority;
  answer.text = text_of(figures, answer.json);
  if (*record) {
    (*record)->put(answer);
  }
  for (const std::string& refused : real_time.refused) {
    answer.text += refused + "\n";
  }
  return answer;
}

}  // namespace
}  // namespace live

void add_verb_run(Session& session, Verb& verb) {
  auto options = std::make_shared<live::Options>();
  add_machine_option(verb, options->machine);
  verb.add_option("--mode", options->mode,
                  "observe: writes nothing; advise: shows what it would write; act: writes; "
                  "default: the machine file's")
      ->check(CLI::IsMember({"observe", "advise", "act"}));
  verb.add_option("--for-s", options->for_s, "End after so many seconds; default: when told to")
      ->check(within(0.001, 1e8));
  verb.add_option("--record", options->record,
                  "Record the run in a new file in this folder (SQLite)")
      ->type_name("FOLDER");
  live::add_socket_option(verb, options->socket);
  add_optional_program(verb, options->program,
                       "The program that the simulated machine cuts (port sim)");
  session.on(verb, [options](Progress& /*progress*/) { return live::run(*options); });
}

}  // namespace steadyrest::apps::cli
