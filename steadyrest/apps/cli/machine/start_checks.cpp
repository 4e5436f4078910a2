// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <ctime>
#include <iterator>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine/start_checks.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::machine::Machine;
using passport::Finding;
using passport::Severity;

/// Cycles are timed with the monotonic clock; a resolution coarser than 1 % of a cycle would show
/// up in the figures as jitter.
std::vector<Finding> check_clock(const Machine& machine) {
  timespec resolution{};
  if (clock_getres(CLOCK_MONOTONIC, &resolution) != 0) {
    return {{Severity::error, "clock", "this system has no monotonic clock",
             "run on a system with CLOCK_MONOTONIC"}};
  }
  const double resolution_s =
      static_cast<double>(resolution.tv_sec) + 1e-9 * static_cast<double>(resolution.tv_nsec);
  if (resolution_s > 0.01 * layer_cycle_s(machine)) {
    return {{Severity::warning, "clock",
             fmt::format("the clock's resolution is {:.3g} ms, more than 1 % of a cycle",
                         resolution_s * 1e3),
             "use a kernel with high-resolution timers"}};
  }
  return {};
}

}  // namespace

std::vector<Finding> start_findings(const Machine& machine) {
  std::vector<Finding> all = passport::findings(machine);
  std::ranges::copy(check_clock(machine), std::back_inserter(all));
  return all;
}

std::vector<Finding> real_time_findings(const Machine& machine,
                                        const steadyrest::live::RealTime& granted) {
  const bool real = machine.port != kernel::machine::PortKind::sim;
  std::vector<Finding> all;
  all.reserve(granted.refused.size());
  for (const steadyrest::live::RealTime::Refused& refused : granted.refused) {
    all.push_back(
        {real ? Severity::warning : Severity::note, "real_time", refused.what, refused.to_do});
  }
  return all;
}

}  // namespace steadyrest::apps::cli
