// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <utility>

#include <steadyrest/apps/cli/shared/findings.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::machine::Machine;
using passport::Finding;
using passport::Severity;

constexpr std::string_view kOtherLayer = "other_layer";

}  // namespace

std::vector<Finding> by_severity(const std::vector<Finding>& findings) {
  std::vector<Finding> sorted;
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    std::ranges::copy_if(findings, std::back_inserter(sorted), [severity](const Finding& finding) {
      return finding.severity == severity;
    });
  }
  return sorted;
}

Finding error_of(std::string_view check, const Refusal& refusal) {
  return {.severity = Severity::error,
          .check = check,
          .what = (refusal.file.empty() ? "" : refusal.file + ": ") + refusal.what,
          .to_do = refusal.to_do,
          .kind = refusal.kind};
}

Finding other_layer(std::string what, std::string to_do) {
  return {.severity = Severity::warning,
          .check = kOtherLayer,
          .what = std::move(what),
          .to_do = std::move(to_do),
          .kind = kernel::outcome::Kind::unavailable};
}

Refusals errors_of(const Machine& machine, const std::vector<Finding>& findings) {
  Refusals errors;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error || finding.check == kOtherLayer) {
      Refusal refusal = bad_input(machine.file, finding.what, finding.to_do);
      refusal.kind = finding.kind;
      errors.push_back(std::move(refusal));
    }
  }
  return errors;
}

Json json_of(const std::vector<Finding>& findings) {
  Json all = Json::array();
  for (const Finding& finding : findings) {
    all.push_back({{"severity", passport::word(finding.severity)},
                   {"check", finding.check},
                   {"what", finding.what},
                   {"to_do", finding.to_do}});
  }
  return all;
}

}  // namespace steadyrest::apps::cli
