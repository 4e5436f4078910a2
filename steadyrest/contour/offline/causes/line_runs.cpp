// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/contour/offline/causes/places.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kBetter = 0.95;

LineRun run_at(const std::map<std::uint32_t, LineRun>& runs, std::uint32_t line) {
  const auto found = runs.find(line);
  return found == runs.end() ? LineRun{} : found->second;
}

}  // namespace

kernel::outcome::Result<std::map<std::uint32_t, LineRun>> line_runs(const OverTask& task) {
  std::map<std::uint32_t, LineRun> runs;
  double last_s = 0.0;
  const auto seconds =
      run_model({.machine = task.machine,
                 .path = task.path,
                 .original = task.original,
                 .map = task.map,
                 .model = servo_models(task.machine.axes),
                 .others = {},
                 .backlash_mm = backlash_mm(task.machine.axes),
                 .unknown = task.unknown},
                [&](const ModelSample& sample) {
                  LineRun& run = runs[task.origin(sample.line)];
                  run.seconds += sample.time_s - last_s;
                  last_s = sample.time_s;
                  if (!sample.cuts) {
                    return;
                  }
                  const double error = std::abs(sample.error_mm) + sample.more_mm;
                  run.error_mm = std::max(run.error_mm, error);
                  const double speed = sample.command_mm_s;
                  run.least_mm_s = run.least_mm_s > 0.0 ? std::min(run.least_mm_s, speed) : speed;
                });
  if (!seconds) {
    return std::unexpected(seconds.error());
  }
  return runs;
}

void add_cure(std::vector<OverLine>& over, const std::map<std::uint32_t, LineRun>& now,
              const std::map<std::uint32_t, LineRun>& other, const std::string& name,
              double limit_mm) {
  for (OverLine& one : over) {
    const LineRun there = run_at(other, one.line);
    if (there.seconds <= 0.0 || there.error_mm > kBetter * one.error_mm) {
      continue;
    }
    double price_s = 0.0;
    for (const std::uint32_t line : {one.line - 1, one.line, one.line + 1}) {
      price_s += run_at(other, line).seconds - run_at(now, line).seconds;
    }
    one.cures.push_back({.what = fmt::format("{} (down to F{:.0f} there)", name,
                                             kernel::units::mm_min_from_mm_s(there.least_mm_s)),
                         .seconds = price_s,
                         .leaves_mm = there.error_mm});
    sort_cures(one.cures, limit_mm);
  }
}

}  // namespace steadyrest::contour::offline
