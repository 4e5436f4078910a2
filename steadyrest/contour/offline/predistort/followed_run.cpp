// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <expected>

#include <steadyrest/contour/offline/predistort/corner_errors.hpp>
#include <steadyrest/contour/offline/predistort/followed_run.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr std::size_t kBetweenProgress = 4096;  ///< samples

}  // namespace

kernel::outcome::Result<FollowedRun> follow(const Judging& by, const Changed& changed,
                                            const std::vector<Corner>& corners) {
  FollowedRun run{.figures = ErrorFigures(by.limit_mm, by.others.size()),
                  .speed = {},
                  .corner_mm = {},
                  .errors = {},
                  .over = {},
                  .runs = RunErrors(by.runs, by.others.size())};
  CornerErrors corner_errors(corners);
  const auto& origin = changed.replaced.origin;
  const PathMap map{.start_mm = changed.start_mm, .end_mm = changed.end_mm};
  ModelRun model{.machine = by.machine,
                 .path = changed.path,
                 .original = by.original,
                 .map = map,
                 .model = by.model,
                 .others = by.others,
                 .backlash_mm = backlash_mm(by.machine.axes)};
  if (!by.learnt.empty()) {
    model.unknown = [&](double foot_mm) { return by.learnt.unknown_mm(foot_mm); };
  }
  const double whole_mm = std::max(1e-9, map.end_mm.empty() ? 0.0 : map.end_mm.back());
  std::size_t samples = 0;
  const auto seconds = run_model(model, [&](const ModelSample& sample) {
    if (samples++ % kBetweenProgress == 0) {
      by.progress(sample.progress_mm / whole_mm);
    }
    run.speed.add(sample.progress_mm, sample.command_mm_s);
    corner_errors.add(sample);
    run.errors.push_back({.valid = sample.cuts && !sample.arriving,
                          .time_s = sample.time_s,
                          .foot_mm = sample.foot_mm,
                          .off_mm = sample.off_mm});
    if (sample.cuts) {
      const std::uint32_t line = sample.line < origin.size() ? origin[sample.line] : sample.line;
      run.figures.add(sample, line);
      run.runs.add(sample, line, by.original.segments);
      if (by.hold_mm > 0.0 && std::abs(sample.error_mm) > by.hold_mm) {
        run.over.push_back({.foot_mm = sample.foot_mm,
                            .progress_mm = sample.progress_mm,
                            .error_mm = std::abs(sample.error_mm)});
      }
    }
  });
  if (!seconds) {
    return std::unexpected(seconds.error());
  }
  run.seconds = *seconds;
  run.corner_mm = corner_errors.take();
  return run;
}

}  // namespace steadyrest::contour::offline
