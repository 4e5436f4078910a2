// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <utility>
#include <vector>

#include <steadyrest/contour/offline/predistort/corner_errors.hpp>
#include <steadyrest/contour/offline/predistort/followed_run.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr std::size_t kBetweenProgress = 4096;  ///< samples
constexpr double kWake = 3.0;                   ///< in time constants of the softest axis
constexpr double kPause = 10.5;                 ///< periods without a sample of a cut

/// Notes where each block of the text begins and with what state of the axes: behind a dwell
/// before it, where there is one.
class Starts {
 public:
  void add(const ModelSample& sample, std::uint32_t line) {
    const bool begins = line != last_line_;
    if (begins || waits_) {
      const auto& error = sample.axes.servo.error_mm;
      last_.next_error_mm = {error[0], error[1], error[2]};
      if (begins) {
        all_.emplace_back();
      }
      all_.back() = last_;
    }
    waits_ = (begins || waits_) && sample.command_mm_s == 0.0;
    last_line_ = line;
    last_ = {.progress_mm = sample.progress_mm,
             .foot_mm = sample.foot_mm,
             .speed_mm_s = sample.command_mm_s,
             .axes = sample.axes};
  }
  std::vector<BlockStart> take() { return std::move(all_); }

 private:
  std::vector<BlockStart> all_;
  BlockStart last_;
  bool waits_ = false;  ///< the last sample's block has not begun to move
  std::uint32_t last_line_ = 0;
};

}  // namespace

kernel::outcome::Result<FollowedRun> follow(const Judging& by, const Changed& changed,
                                            const std::vector<Corner>& corners) {
  FollowedRun run{
      .figures = ErrorFigures(by.limit_mm, by.others.size()),
      .speed = {},
      .corner_mm = {},
      .errors = {},
      .over = {},
      .starts = {},
      .runs = RunErrors(by.runs, by.others.size(),
                        {.lasts_s = kWake / softest_gain_1_s(by.model),
                         .pause_s = kPause * by.machine.control.interpolator_period_s})};
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
  Starts starts;
  const auto seconds = run_model(model, [&](const ModelSample& sample) {
    if (samples++ % kBetweenProgress == 0) {
      by.progress(sample.progress_mm / whole_mm);
    }
    const std::uint32_t line = sample.line < origin.size() ? origin[sample.line] : sample.line;
    starts.add(sample, line);
    run.speed.add(sample.progress_mm, sample.command_mm_s);
    corner_errors.add(sample);
    run.errors.push_back({.valid = sample.cuts && !sample.arriving,
                          .time_s = sample.time_s,
                          .foot_mm = sample.foot_mm,
                          .off_mm = sample.off_mm});
    if (sample.cuts) {
      run.figures.add(sample, line);
      run.runs.add(sample, line, by.original.segments);
      if (by.hold_mm > 0.0 && std::abs(sample.error_mm) > by.hold_mm) {
        run.over.push_back({.foot_mm = sample.foot_mm,
                            .progress_mm = sample.progress_mm,
                            .error_mm = std::abs(sample.error_mm),
                            .early = run.runs.early(),
                            .since_s = run.runs.since_s()});
      }
    }
  });
  if (!seconds) {
    return std::unexpected(seconds.error());
  }
  run.seconds = *seconds;
  run.corner_mm = corner_errors.take();
  run.starts = starts.take();
  return run;
}

}  // namespace steadyrest::contour::offline
