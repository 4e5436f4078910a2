// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/live/machine_reload.hpp>
#include <steadyrest/apps/cli/live/run_chatter.hpp>
#include <steadyrest/apps/cli/live/run_page.hpp>
#include <steadyrest/apps/cli/live/run_record.hpp>
#include <steadyrest/apps/cli/live/signals.hpp>
#include <steadyrest/apps/cli/live/socket_option.hpp>
#include <steadyrest/apps/cli/live/verb_run.hpp>
#include <steadyrest/apps/cli/machine/start_checks.hpp>
#include <steadyrest/apps/cli/ports/live_port.hpp>
#include <steadyrest/apps/cli/ports/lossy_port.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/kernel/outcome/shown.hpp>
#include <steadyrest/live/control_socket.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/live/realtime.hpp>
#include <steadyrest/live/reloader.hpp>
#include <steadyrest/live/service.hpp>
#include <steadyrest/live/status_json.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/record/run_folder.hpp>
#include <steadyrest/supervisor/settings.hpp>

// The loop runs in this thread, the socket and the reloader each in another. SIGINT and SIGTERM ask
// for the end, and the layer hands back first; SIGHUP has the machine file read again.
namespace steadyrest::apps::cli {
namespace live {
namespace {

using steadyrest::live::Loop;
using steadyrest::live::LoopFigures;
using steadyrest::live::Reloader;
using steadyrest::live::ServiceManager;

constexpr double kLost_s = 0.5;

struct Options {
  std::string machine;
  ProgramOptions program;
  std::string mode;
  std::string socket;
  std::string record;  ///< folder; empty: no record
  PageOptions page;
  RunChatterOptions chatter;
  bool repeats = false;
  double for_s = 0.0;
  double lose_link_at_s = -1.0;  ///< below 0: never
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
  if (figures.listens) {
    table.row({"chatter", fmt::format("{} times, {:.2f} s in all", figures.chatter_events,
                                      figures.chatter_s)});
  }
  if (const Json stalls = json.value("stalls", Json()); stalls.is_object()) {
    table.row({"servo cycles lost, passed over",
               fmt::format("{}, {}", stalls.value("lost", 0), stalls.value("passed_over", 0))});
    table.row({"watchdog armed again", fmt::format("{} times", stalls.value("rearmed", 0))});
  }
  std::string text = table.text();
  if (figures.port_faults > 0) {
    text += fmt::format("the port could not be read or written in {} cycles{}: {}\n",
                        figures.port_faults, figures.ended_in_fault ? ", the last one too" : "",
                        figures.last_fault);
  }
  if (!figures.handed_back) {
    text +=
        "ended before all was handed back: the machine's watchdog takes over what is left, if "
        "any\n";
  }
  return text;
}

Loop::Config loop_config(const Options& options, const kernel::machine::Machine& machine,
                         const LivePort& port) {
  Loop::Config config{.period_s = port.period_s,
                      .contour_limit_mm = machine.contour.limit_mm,
                      // Twice the longest way: the link may lose cycles.
                      .handback_s = std::max(Loop::Config{}.handback_s,
                                             2.0 * supervisor::longest_hand_back_s(machine)),
                      .mode = steadyrest::live::mode_of(options.mode).value_or(machine.mode),
                      .port_paces = port.paces,
                      .holds_s = port.holds_s,
                      .finished = port.finished};
  const bool waits = machine.port == kernel::machine::PortKind::lines ||
                     machine.port == kernel::machine::PortKind::opcua;
  if (waits) {
    config.most_s = options.for_s;
  } else if (options.for_s > 0.0) {
    config.most_cycles = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(std::llround(options.for_s / port.period_s)));
  }
  return config;
}

/// What a run needs, judged.
struct Prepared {
  kernel::machine::Machine machine;
  std::vector<passport::Finding> findings;
  LivePort port;
  supervisor::Supervisor layer;
  std::optional<RunProcess> process;
  std::optional<trial::listener::Listener> listener;  ///< where there is a process
};

/// What `doctor` calls an error refuses the start. The socket comes before the port: a second layer
/// must not touch a machine that has one.
std::expected<Prepared, Refusals> prepare(const Options& options, Progress& progress) {
  auto process = read_run_process(options.chatter);
  if (!process) {
    return std::unexpected(process.error());
  }
  auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  auto findings = start_findings(*machine);
  if (auto errors = errors_of(*machine, findings); !errors.empty()) {
    return std::unexpected(std::move(errors));
  }
  if (const auto free = steadyrest::live::ControlSocket::check(options.socket); !free) {
    return refused(free.error());
  }
  if (const auto fits = check_page(options.page); !fits) {
    return refused(fits.error());
  }
  if (auto refusal = unfit(*process, *machine)) {
    return refused(std::move(*refusal));
  }
  auto port = open_port(*machine, options.program, simulated_of(*process, options.repeats));
  if (!port) {
    return std::unexpected(port.error());
  }
  if (options.lose_link_at_s >= 0.0) {
    if (machine->port != kernel::machine::PortKind::sim) {
      return refused(bad_input("--lose-link-at-s is for the simulated machine",
                               "leave it out, or set port = \"sim\""));
    }
    port->port =
        std::make_unique<LossyPort>(std::move(port->port), options.lose_link_at_s, kLost_s);
  }
  std::ranges::move(port->findings, std::back_inserter(findings));
  std::ranges::move(page_findings(options.page), std::back_inserter(findings));
  auto listener = listener_of(*process, *machine, *port, progress);
  if (!listener) {
    return refused(listener.error());
  }
  auto layer = trial::listener::layer_of(*listener ? &**listener : nullptr, *machine,
                                         port->port->capability());
  if (!layer) {
    return refused(layer.error());
  }
  return Prepared{.machine = std::move(*machine),
                  .findings = std::move(findings),
                  .port = std::move(*port),
                  .layer = std::move(*layer),
                  .process = std::move(*process),
                  .listener = std::move(*listener)};
}

/// fmt::print() throws where stderr has gone with its terminal; a run must not end for that.
void say(const std::string& line) noexcept {
  std::fputs(kernel::outcome::shown_lines(line).c_str(), stderr);
}

/// At the start, since a run may take days.
void show_warnings(const std::vector<passport::Finding>& findings) {
  for (const passport::Finding& finding : findings) {
    if (finding.severity == passport::Severity::warning) {
      say(fmt::format("steadyrest: warning: {}; {}\n", finding.what, finding.to_do));
    }
  }
}

std::string line_of(const steadyrest::live::ReloadStatus& reload) {
  return "steadyrest: " + (reload.taken ? "the machine file was read again and is in force\n"
                                        : "the machine file was not taken: " + reload.words + "\n");
}

Reloader::Config reloader_config(const Options& options, const Prepared& of, RunRecord* record,
                                 const HangupWaits& hangup, const ServiceManager& manager,
                                 Loop& loop) {
  record::RecordWriter* const writer = record != nullptr ? &record->writer() : nullptr;
  return {
      .running = of.machine,
      .make = [&hangup, &loop,
               reload = ReloadOf{.file = options.machine,
                                 .capability = of.port.port->capability(),
                                 .accepts = of.port.accepts,
                                 .listener = of.listener ? &*of.listener : nullptr,
                                 .writer = writer}](
                  const auto& running) -> Result<std::unique_ptr<steadyrest::live::Successor>> {
        if (hangup.terminal_is_gone()) {
          loop.ask_stop();
          return refuse("the terminal has gone: the run ends", "start it as a service");
        }
        return read_again(reload, running);
      },
      .utc_now = record::utc_now,
      .on_begin = [&manager] { manager.tell(steadyrest::live::reloading()); },
      .on_end =
          [&manager](const auto& reload) {
            say(line_of(reload));
            manager.tell("READY=1\nSTATUS=" + (reload.taken ? "" : "not taken: " + reload.words));
          },
      .signal = SIGHUP};
}

Result<std::unique_ptr<RunRecord>> start_record(const Options& options, const Prepared& of) {
  return RunRecord::start({.folder = options.record,
                           .machine_file = options.machine,
                           .machine = of.machine.name,
                           .program_file = options.program.file,
                           .listener = listener_text(of.listener)},
                          of.port);
}

Answer answer_of(const LoopFigures& figures, const Prepared& of,
                 const steadyrest::live::RealTime& real_time, RunRecord* record) {
  Answer answer;
  const bool mostly_faulty = 2 * figures.port_faults > figures.cycles;
  answer.exit_code =
      figures.ended_in_fault || mostly_faulty || !figures.handed_back ? kFailed : kDone;
  answer.json = steadyrest::live::figures_json(figures);
  answer.json["machine"] = of.machine.name;
  answer.json["port"] = passport::word(of.machine.port);
  if (of.port.shows) {
    answer.json.update(of.port.shows());
  }
  answer.json["memory_locked"] = real_time.memory_locked;
  answer.json["real_time_priority"] = real_time.priority;
  answer.json["findings"] = json_of(of.findings);
  answer.text = text_of(figures, answer.json);
  if (record != nullptr) {
    record->put(answer);
  }
  for (const auto& refused : real_time.refused) {
    answer.text += fmt::format("{}; {}\n", refused.what, refused.to_do);
  }
  return answer;
}

// Threads come before the real-time priority, which they would inherit. What a thread uses is made
// before it.
Outcome run(const Options& options, Progress& progress) {
  const HangupWaits hangup;
  auto prepared = prepare(options, progress);
  progress.clear();
  if (!prepared) {
    return std::unexpected(prepared.error());
  }
  Loop::Config config = loop_config(options, prepared->machine, prepared->port);
  if (auto checked = Loop::check(config); !checked) {
    return refused(checked.error());
  }
  steadyrest::live::MonotonicPace pace(config.period_s);
  auto made = start_record(options, *prepared);
  if (!made) {
    return refused(made.error());
  }
  RunRecord* const record = made->get();
  if (record != nullptr) {
    record->listen_to(config);
  }
  RunPage page(options.page);
  config.tap = page.tap();
  Loop loop(record != nullptr ? record->port() : *prepared->port.port, prepared->layer, pace,
            config);
  const auto manager = ServiceManager::from_environment();
  Reloader reloader(loop, reloader_config(options, *prepared, record, hangup, manager, loop));
  const steadyrest::live::Asked asked{.loop = loop,
                                      .port = passport::word(prepared->machine.port),
                                      .reloader = &reloader,
                                      .more_keys = status_keys(prepared->port, record)};
  const auto socket = steadyrest::live::ControlSocket::open(
      options.socket,
      [&asked](std::string_view line) { return steadyrest::live::answer(asked, line); });
  if (!socket) {
    return refused(socket.error());
  }
  if (auto opened = page.open({.asked = asked,
                               .machine = prepared->machine,
                               .machine_file = options.machine,
                               .socket = options.socket,
                               .record_folder = options.record,
                               .record = record,
                               .cycle_s = config.period_s,
                               .chatter = chatter_desk(prepared->process)});
      !opened) {
    return refused(opened.error());
  }
  std::optional<steadyrest::live::LifeSignThread> life_sign(std::in_place, loop, manager);
  const auto real_time = steadyrest::live::ask_for_real_time();
  for (auto& finding : real_time_findings(prepared->machine, real_time)) {
    prepared->findings.push_back(std::move(finding));
  }
  show_warnings(prepared->findings);
  const StopSignals signals(loop);
  const LoopFigures& figures = loop.run();
  // Before page and record end: that may take longer than the watchdog waits.
  life_sign.reset();
  page.close();
  return answer_of(figures, *prepared, real_time, record);
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
  verb.add_flag("--repeat", options->repeats,
                "Simulated machine: begin the program again whenever it has ended");
  verb.add_option("--lose-link-at-s", options->lose_link_at_s,
                  "Simulated machine: its link is lost for 0.5 s at this time, for a trial of what "
                  "happens then")
      ->check(within(0.0, 1e8));
  live::add_socket_option(verb, options->socket);
  live::add_page_options(verb, options->page);
  add_optional_program(verb, options->program,
                       "The program that the simulated machine cuts (port sim), or that the "
                       "control runs (ports lines and opcua)");
  live::add_run_chatter_options(verb, options->chatter);
  session.on(verb, [options](Progress& progress) { return live::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
