// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine/start_checks.hpp>
#include <steadyrest/apps/cli/machine/verb_doctor.hpp>
#include <steadyrest/apps/cli/ports/lines_live.hpp>
#include <steadyrest/apps/cli/ports/live_port.hpp>
#include <steadyrest/apps/cli/ports/opcua_live.hpp>
#include <steadyrest/apps/cli/ports/program_place.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/live/realtime.hpp>
#include <steadyrest/passport/file/consistency.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/trial/timing/judgement.hpp>
#include <steadyrest/trial/timing/layer_timing.hpp>

// Will this machine file work, and is this computer fast enough for it? The file is judged first
// (passport/file/consistency.cpp), then the clock and the real-time settings, then the layer is run
// on a path full of decisions and timed cycle by cycle.
namespace steadyrest::apps::cli {
namespace doctor {
namespace {

using kernel::machine::Machine;
using passport::Finding;
using passport::Severity;
using trial::timing::LayerTiming;

/// The shop's unit for cycle times.
double us(double seconds) {
  return 1e6 * seconds;
}

/// The layer's share of a cycle on this computer, or why it does not run on this machine.
struct Measured {
  std::optional<LayerTiming> timing;
  std::vector<Finding> findings;
};

/// A layer that refuses the machine is a finding too, with the reason that it gives.
Measured measure(const Machine& machine, Progress& progress) {
  auto timing = trial::timing::time_layer(
      machine, {}, [&](double share) { progress.update(share, "measuring the layer"); });
  // The findings print next, and no bar may remain in between.
  progress.clear();
  if (!timing) {
    return {std::nullopt,
            {{Severity::error, "layer", std::move(timing.error().what),
              std::move(timing.error().to_do)}}};
  }
  return {*timing, trial::timing::judge(*timing, machine)};
}

/// All findings, errors first.
std::vector<Finding> examine(const Machine& machine, const std::vector<Finding>& measured) {
  std::vector<Finding> all = start_findings(machine);
  for (const auto& more :
       {real_time_findings(machine, steadyrest::live::real_time_allowed()), measured}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return by_severity(all);
}

/// `most_share` is the part of a cycle that the layer may take; port and operating system need the
/// rest.
Json json_of(const LayerTiming& timing) {
  return {{"cycle_us", us(timing.cycle_s)},
          {"most_share", trial::timing::kMostShare},
          {"rounds", timing.rounds},
          {"cycles", timing.cycles},
          {"work_p50_us", us(timing.work_s.p50)},
          {"work_p999_us", us(timing.work_s.p999)},
          {"decisions", timing.decisions},
          {"decision_p50_us", us(timing.decision_s.p50)},
          {"decision_p999_us", us(timing.decision_s.p999)},
          {"decision_worst_us", us(timing.decision_s.worst)}};
}

std::string text_of(const LayerTiming& timing) {
  std::string text = fmt::format(
      "  measured here: of each {:.0f} µs control cycle the layer takes {:.1f} µs (median)",
      us(timing.cycle_s), us(timing.work_s.p50));
  if (timing.decisions > 0) {
    text += fmt::format(", with a decision {:.0f} µs, {:.0f} µs at p99.9 of {}",
                        us(timing.decision_s.p50), us(timing.decision_s.p999), timing.decisions);
  }
  return text + "\n";
}

/// Findings by severity; `timing` is null where the layer does not run.
Answer report(const Machine& machine, const Measured& measured,
              const std::vector<Finding>& findings) {
  const bool ok = std::ranges::none_of(
      findings, [](const Finding& f) { return f.severity == Severity::error; });
  // Exit code 1, not 2: the file could be read, but the machine does not pass.
  Answer answer;
  answer.exit_code = ok ? kDone : kFailed;
  answer.json["ok"] = ok;
  answer.json["machine"] = machine.name;
  answer.json["file"] = machine.file;
  answer.json["port"] = passport::word(machine.port);
  answer.json["timing"] = measured.timing ? json_of(*measured.timing) : Json();
  answer.json["findings"] = steadyrest::apps::cli::json_of(findings);
  answer.text =
      fmt::format("{} ({}), port {}\n", machine.name, machine.file, passport::word(machine.port));
  if (measured.timing) {
    answer.text += text_of(*measured.timing);
  }
  for (const Finding& finding : findings) {
    answer.text += fmt::format("  {}: {}; {}\n", passport::word(finding.severity), finding.what,
                               finding.to_do);
  }
  answer.text +=
      ok ? (findings.empty() ? "ok\n" : "ok, subject to the remarks above\n") : "not ok\n";
  return answer;
}

/// A refused file is a finding too, so that scripts look in one place.
Answer report_refused(Refusals refusals) {
  Answer answer;
  answer.json["ok"] = false;
  answer.json["findings"] = Json::array();
  for (const auto& refusal : refusals) {
    answer.json["findings"].push_back({{"severity", "error"},
                                       {"check", "machine_file"},
                                       {"file", refusal.file},
                                       {"line", refusal.line},
                                       {"what", refusal.what},
                                       {"to_do", refusal.to_do}});
  }
  answer.refusals = std::move(refusals);
  answer.exit_code = kRefused;
  return answer;
}

Outcome run(const std::string& path, Progress& progress) {
  auto machine = read_machine(path);
  if (!machine) {
    return report_refused(std::move(machine.error()));
  }
  Measured measured = measure(*machine, progress);
  if (const auto there = live::check_port(*machine); !there) {
    measured.findings.push_back(error_of("port", there.error()));
  }
  if (machine->port == kernel::machine::PortKind::lines) {
    std::ranges::move(live::lines_findings(*machine), std::back_inserter(measured.findings));
  }
  if (machine->port == kernel::machine::PortKind::opcua) {
    std::ranges::move(live::opcua_findings(*machine), std::back_inserter(measured.findings));
    if (const auto there = live::check_program_file(machine->opcua.program); !there) {
      measured.findings.push_back(error_of("opcua", there.error().front()));
    }
  }
  return report(*machine, measured, examine(*machine, measured.findings));
}

}  // namespace
}  // namespace doctor

void add_verb_doctor(Session& session, Verb& verb) {
  auto path = std::make_shared<std::string>();
  add_machine_option(verb, *path);
  session.on(verb, [path](Progress& progress) { return doctor::run(*path, progress); });
}

}  // namespace steadyrest::apps::cli
