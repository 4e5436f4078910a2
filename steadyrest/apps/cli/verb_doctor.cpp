// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <ctime>
#include <iterator>
#include <memory>

#include <fmt/core.h>
#include <sys/resource.h>

#include <steadyrest/apps/cli/machine_option.hpp>
#include <steadyrest/apps/cli/verb_doctor.hpp>
#include <steadyrest/kernel/machine/consistency.hpp>
#include <steadyrest/kernel/machine/schema.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::machine::Finding;
using kernel::machine::Machine;
using kernel::machine::PortKind;
using kernel::machine::Severity;

/// Is the machine there?
std::vector<Finding> check_port(const Machine& machine) {
  if (machine.port == PortKind::sim) {
    return {};
  }
  return {{Severity::error, "port",
           fmt::format("port = \"{}\": this build has no adapter for it",
                       kernel::machine::word(machine.port)),
           "set port = \"sim\" to work with the simulated machine"}};
}

/// The monotonic clock must be far finer than a cycle.
std::vector<Finding> check_clock(const Machine& machine) {
  timespec resolution{};
  if (clock_getres(CLOCK_MONOTONIC, &resolution) != 0) {
    return {{Severity::error, "clock", "this system has no monotonic clock",
             "run on a system with CLOCK_MONOTONIC"}};
  }
  const double resolution_s =
      static_cast<double>(resolution.tv_sec) + 1e-9 * static_cast<double>(resolution.tv_nsec);
  if (resolution_s > 0.01 * machine.control.interpolator_period_s) {
    return {{Severity::warning, "clock",
             fmt::format("the clock's resolution is {:.3g} ms, more than 1 % of a cycle",
                         resolution_s * 1e3),
             "use a kernel with high-resolution timers"}};
  }
  return {};
}

/// The simulated machine has its own time; a real one needs a real-time priority.
std::vector<Finding> check_real_time(const Machine& machine) {
  rlimit limit{};
  if (machine.port == PortKind::sim || getrlimit(RLIMIT_RTPRIO, &limit) != 0 ||
      limit.rlim_cur > 0) {
    return {};
  }
  return {{Severity::warning, "real_time", "this user may not ask for a real-time priority",
           "raise rtprio for the user in /etc/security/limits.d"}};
}

/// All findings, the worst first.
std::vector<Finding> examine(const Machine& machine) {
  std::vector<Finding> all = kernel::machine::findings(machine);
  for (auto* check : {check_port, check_clock, check_real_time}) {
    std::vector<Finding> more = check(machine);
    all.insert(all.end(), more.begin(), more.end());
  }
  std::vector<Finding> sorted;
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    std::copy_if(all.begin(), all.end(), std::back_inserter(sorted),
                 [severity](const Finding& finding) { return finding.severity == severity; });
  }
  return sorted;
}

Answer report(const Machine& machine, const std::vector<Finding>& findings) {
  const bool ok = std::none_of(findings.begin(), findings.end(),
                               [](const Finding& f) { return f.severity == Severity::error; });
  Answer answer;
  answer.exit_code = ok ? kDone : kFailed;
  answer.json["ok"] = ok;
  answer.json["machine"] = machine.name;
  answer.json["file"] = machine.file;
  answer.json["port"] = kernel::machine::word(machine.port);
  answer.json["findings"] = Json::array();
  answer.text = fmt::format("{} ({}), port {}\n", machine.name, machine.file,
                            kernel::machine::word(machine.port));
  for (const Finding& finding : findings) {
    const std::string_view severity = kernel::machine::word(finding.severity);
    answer.json["findings"].push_back({{"severity", severity},
                                       {"check", finding.check},
                                       {"what", finding.what},
                                       {"to_do", finding.to_do}});
    answer.text += fmt::format("  {}: {}; {}\n", severity, finding.what, finding.to_do);
  }
  answer.text += ok ? (findings.empty() ? "ok\n" : "ok, with the remarks above\n") : "not ok\n";
  return answer;
}

/// A file that is refused is a finding too, so that scripts find it where they look.
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

}  // namespace

void add_verb_doctor(Session& session) {
  Verb& verb = session.verb(session.root(), "doctor",
                            "Check a machine file, its port, the clock and real-time settings",
                            "doctor --machine examples/machines/vmc-840d.toml");
  auto path = std::make_shared<std::string>();
  add_machine_option(verb, *path);
  session.on(verb, [path](Progress& /*progress*/) -> Outcome {
    auto machine = read_machine(*path);
    if (!machine) {
      return report_refused(std::move(machine.error()));
    }
    return report(*machine, examine(*machine));
  });
}

}  // namespace steadyrest::apps::cli
