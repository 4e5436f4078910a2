// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <bench/clairvoyant/simulated_schedule.hpp>
#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::bench::clairvoyant {
namespace {

using kernel::outcome::Result;
using kernel::signal::Command;
using kernel::signal::Frame;
using trial::cut::Figures;
using trial::cut::Job;
using trial::cut::Recorder;
using trial::cut::Sample;
using Tell = std::function<void(const std::string&)>;

/// Short against any feature of a part, long against the way of one cycle.
constexpr double kStation_mm = 0.25;

/// A layer that always puts one step of the table in force. It masks the panel, as the real layer
/// does.
class FixedStep {
 public:
  explicit FixedStep(const kernel::machine::OverrideTable& table) : table_(table) {}

  Command command(std::size_t step) {
    Command command;
    command.feed_ratio = table_.ratio[step];
    command.feed_code = table_.code[step];
    command.feed_masks_panel = true;
    command.write = true;
    command.heartbeat = ++heartbeat_;
    return command;
  }

 private:
  kernel::machine::OverrideTable table_;
  std::uint64_t heartbeat_ = 0;
};

/// Spreads samples over the stretches they pass through: time in proportion to the way, the largest
/// error to each of them.
class Stations {
 public:
  Stations(double length_mm, std::size_t steps)
      : stations_(static_cast<std::size_t>(length_mm / kStation_mm) + 1) {
    for (Station& station : stations_) {
      station.length_mm = kStation_mm;
      station.time_s.assign(steps, 0.0);
      station.error_mm.assign(steps, 0.0);
    }
  }

  void add(std::size_t step, const Sample& before, const Sample& now) {
    const double from = before.path_position_mm;
    const double to = std::max(now.path_position_mm, from);
    const double time_s = now.time_s - before.time_s;
    const std::size_t first = index(from);
    const std::size_t last = index(to);
    for (std::size_t j = first; j <= last; ++j) {
      const double lower = std::max(from, static_cast<double>(j) * kStation_mm);
      const double upper = std::min(to, static_cast<double>(j + 1) * kStation_mm);
      // A dwell does not move; its time goes to its own stretch.
      const double share = to > from ? std::max(0.0, upper - lower) / (to - from)
                                     : 1.0 / static_cast<double>(last - first + 1);
      stations_[j].time_s[step] += share * time_s;
      // Rapids cut nothing, so their error is not an error of the part.
      if (now.motion == kernel::signal::Motion::feed) {
        stations_[j].error_mm[step] =
            std::max(stations_[j].error_mm[step], std::abs(now.contour_error_mm));
      }
    }
  }

  [[nodiscard]] std::size_t index(double position_mm) const {
    const auto j = static_cast<std::size_t>(std::max(0.0, position_mm) / kStation_mm);
    return std::min(j, stations_.size() - 1);
  }
  [[nodiscard]] const std::vector<Station>& all() const { return stations_; }

 private:
  std::vector<Station> stations_;
};

Result<void> run_at_constant_step(const Job& job, std::size_t step, Stations& stations) {
  FixedStep fixed(job.machine.feed_override);
  std::optional<Sample> before;
  return trial::cut::run(
      job, [&](const Frame&) { return fixed.command(step); },
      [&](const Sample& sample) {
        if (before) {
          stations.add(step, *before, sample);
        }
        before = sample;
      });
}

/// Runs a schedule. Each word is written ahead by the time it takes to act: the dead time and, on
/// average, half a scan.
Result<Figures> run_schedule(const Job& job, const Schedule& schedule, const Stations& stations) {
  const auto& table = job.machine.feed_override;
  const double ahead_s = table.dead_time_s + 0.5 * table.scan_period_s;
  FixedStep fixed(table);
  Recorder record({.limit_mm = job.machine.contour.limit_mm,
                   .cycle_s = job.machine.control.interpolator_period_s});
  const auto done = trial::cut::run(
      job,
      [&](const Frame& frame) {
        const double at_mm = frame.path_position_mm + frame.path_speed_mm_s * ahead_s;
        return fixed.command(schedule.step[stations.index(at_mm)]);
      },
      [&](const Sample& sample) { record.add(sample); });
  if (!done) {
    return std::unexpected(done.error());
  }
  return record.figures();
}

/// The fastest schedule that keeps the limit in the simulation except for `kShareOver` of the
/// samples. Foresight costs time, so the search bisects the look-ahead down to `kResolution_s`, for
/// each of a few reaches behind. It is the best of this family.
Result<Figures> best_that_keeps_the_limit(const Job& job, const Stations& stations,
                                          const Config& config, const Tell& tell) {
  constexpr double kShareOver = 0.001;
  constexpr double kFarthest_s = 0.32;
  constexpr double kResolution_s = 0.005;
  std::optional<Figures> best;
  for (const double behind_s : {0.0, 0.02, 0.06}) {
    double too_short_s = 0.0;
    double ahead_s = kFarthest_s;
    for (double width_s = kFarthest_s; width_s > kResolution_s;) {
      const Schedule schedule = best_schedule(widened(stations.all(), ahead_s, behind_s), config);
      const auto run = run_schedule(job, schedule, stations);
      if (!run) {
        return run;
      }
      const Figures& figures = *run;
      const bool keeps = share_over(figures) <= kShareOver;
      tell(fmt::format("ahead {:.3f} s behind {:.2f} s: {:.2f} s, {:.4f} % over", ahead_s, behind_s,
                       figures.cycle_time_s, 100.0 * share_over(figures)));
      if (keeps && (!best || figures.cycle_time_s < best->cycle_time_s)) {
        best = figures;
      }
      // Even the longest look-ahead fails with this reach behind: shorter ones will too.
      if (!keeps && ahead_s >= kFarthest_s) {
        break;
      }
      width_s *= 0.5;
      too_short_s = keeps ? too_short_s : ahead_s;
      ahead_s = too_short_s + width_s;
    }
  }
  if (!best) {
    return kernel::outcome::refuse("no schedule keeps the limit on this part",
                                   "raise limit_um or lower min_percent of [contour]");
  }
  return *best;
}

Config config_of(const kernel::machine::Machine& machine) {
  Config config;
  config.ratio = machine.feed_override.ratio;
  config.limit_mm = machine.contour.limit_mm;
  config.min_ratio = machine.contour.min_ratio;
  config.max_ratio = machine.contour.max_ratio;
  config.fall_1_s = machine.envelope.feed_fall_1_s;
  config.rise_1_s = machine.envelope.feed_rise_1_s;
  return config;
}

}  // namespace

double share_over(const Figures& figures) {
  return figures.samples == 0 ? 0.0
                              : static_cast<double>(figures.samples_over_limit) /
                                    static_cast<double>(figures.samples);
}

Result<Yardstick> yardstick_of(const Job& job, const Tell& tell) {
  const auto& last = job.path->segments.back();
  const Config config = config_of(job.machine);
  Stations stations(last.position_mm + last.length_mm, config.ratio.size());
  for (std::size_t step = 0; step < config.ratio.size(); ++step) {
    if (config.ratio[step] < config.min_ratio - 1e-9 ||
        config.ratio[step] > config.max_ratio + 1e-9) {
      continue;
    }
    tell(fmt::format("constant step {:.0f} %", 100.0 * config.ratio[step]));
    if (auto run = run_at_constant_step(job, step, stations); !run) {
      return std::unexpected(std::move(run.error()));
    }
  }
  auto best = best_that_keeps_the_limit(job, stations, config, tell);
  if (!best) {
    return std::unexpected(std::move(best.error()));
  }
  return Yardstick{.figures = *best, .bound = best_schedule(stations.all(), config)};
}

}  // namespace steadyrest::bench::clairvoyant
