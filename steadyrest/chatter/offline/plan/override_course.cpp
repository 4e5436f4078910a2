// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <utility>

#include <steadyrest/chatter/offline/plan/override_course.hpp>
#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/override/channel.hpp>

// A small simulated machine: modulator, hand-over, scan and dead time of both overrides, and a
// drive with constant acceleration. Once it has settled, one period of its speed is the course.
namespace steadyrest::chatter::offline {
namespace {

using kernel::machine::Machine;
using kernel::machine::OverrideTable;
using kernel::outcome::Reason;
using kernel::outcome::Result;
using kernel::override::Channel;
using online::Modulator;

constexpr double kCycle_s = 0.002;
constexpr double kSettle_s = 2.0;  ///< fade and slew
constexpr double kAtOnce = 1e-9;   ///< of a cycle: the ramp of a drive without a limit

/// One override as the control sees it: scanned, then delayed.
class LateWord {
 public:
  LateWord(const OverrideTable& table, double cycle_s)
      : scan_(std::max(1.0, std::round(table.scan_period_s / cycle_s))),
        dead_(static_cast<std::size_t>(std::round(table.dead_time_s / cycle_s)), 1.0) {}

  /// What is in force in this cycle.
  double pass(std::size_t cycle, double ratio) {
    if (cycle % static_cast<std::size_t>(scan_) == 0) {
      seen_ = ratio;
    }
    dead_.push_back(seen_);
    const double out = dead_.front();
    dead_.pop_front();
    return out;
  }

 private:
  double scan_;  ///< cycles
  double seen_ = 1.0;
  std::deque<double> dead_;
};

Result<Modulator> modulator_of(Machine machine, double programmed_rev_s, const Modulation& m) {
  machine.chatter.law = m.law;
  machine.chatter.amplitude_ratio = m.rva;
  machine.chatter.amplitude_rev_s = 0.0;
  machine.chatter.period_s = 1.0 / (m.rvf * programmed_rev_s);
  machine.chatter.mean_ratio = 1.0;
  machine.chatter.seed = m.seed;
  // Always on: no program switches it here.
  machine.chatter.m_code_on = 0;
  return Modulator::make(machine);
}

/// Adds a ramp, extending the last one if the slope is the same.
void add(std::vector<SpeedRamp>& course, const SpeedRamp& ramp) {
  if (ramp.duration_s <= 0.0) {
    return;
  }
  const auto slope = [](const SpeedRamp& r) { return (r.to_rev_s - r.from_rev_s) / r.duration_s; };
  if (!course.empty() &&
      std::abs(slope(course.back()) - slope(ramp)) <= 1e-6 * (1.0 + std::abs(slope(ramp)))) {
    course.back().duration_s += ramp.duration_s;
    course.back().to_rev_s = ramp.to_rev_s;
    return;
  }
  course.push_back(ramp);
}

// The same channel as in the real cycle, so that steps, walks and slew are the machine's.
Result<Channel> spindle_channel(const Machine& machine) {
  return Channel::make({.table = machine.spindle_override,
                        .min_ratio = machine.envelope.min_spindle_ratio,
                        .max_ratio = machine.envelope.max_spindle_ratio,
                        .fall_1_s = machine.envelope.spindle_slew_1_s,
                        .rise_1_s = machine.envelope.spindle_slew_1_s,
                        .max_step_s = machine.envelope.stale_after_s,
                        .latched = machine.spindle_override.latched_word});
}

kernel::signal::Frame frame_in_cut(const Machine& machine, double programmed_rev_s) {
  kernel::signal::Frame frame;
  frame.motion = kernel::signal::Motion::feed;
  // Only ratios matter: feed and path speed are in units of the programmed feed.
  frame.programmed_feed_mm_s = 1.0;
  frame.path_speed_mm_s = 1.0;
  frame.spindle_programmed_rev_s = programmed_rev_s;
  // The operator's switch is at its highest step, so that the panel clips nothing; a note of the
  // planner says how high it must be.
  frame.spindle.panel_ratio = *std::ranges::max_element(machine.spindle_override.ratio);
  frame.spindle.effective_ratio = 1.0;
  return frame;
}

}  // namespace

Result<std::vector<SpeedRamp>> override_course(const Machine& machine, double programmed_rev_s,
                                               const Modulation& modulation) {
  auto modulator = modulator_of(machine, programmed_rev_s, modulation);
  if (!modulator) {
    return std::unexpected(modulator.error());
  }
  auto spindle = spindle_channel(machine);
  if (!spindle) {
    return std::unexpected(spindle.error());
  }
  const double period_s = 1.0 / (modulation.rvf * programmed_rev_s);
  const double scans = std::max(1.0, std::round(period_s / machine.spindle_override.scan_period_s));
  // Whole cycles per scan and whole scans per period; otherwise the course would not repeat and
  // could not be a period for the solver.
  const double per_scan = std::max(1.0, std::round(period_s / scans / kCycle_s));
  const auto cycles = static_cast<std::size_t>(scans * per_scan);
  const double dt_s = period_s / static_cast<double>(cycles);
  OverrideTable fitted = machine.spindle_override;
  fitted.scan_period_s = per_scan * dt_s;
  LateWord spindle_word(fitted, dt_s);
  LateWord feed_word(machine.feed_override, dt_s);
  // Whole periods, so that the period taken begins at phase 0 of the law.
  const auto settle = static_cast<std::size_t>(std::ceil(kSettle_s / period_s)) + 2;

  kernel::signal::Frame frame = frame_in_cut(machine, programmed_rev_s);
  double feed_asked = 1.0;
  double speed = programmed_rev_s;
  const double reach = machine.spindle.acceleration_rev_s2 * dt_s;
  std::vector<SpeedRamp> course;
  for (std::size_t i = 0; i < (settle + 1) * cycles; ++i) {
    frame.time_s = static_cast<double>(i) * dt_s;
    frame.spindle_actual_rev_s = speed;
    const auto asked =
        modulator->update(frame, {.feed = {.ratio = feed_asked, .word_ratio = feed_asked},
                                  .spindle = spindle->in_force(),
                                  .written = true});
    feed_asked = std::min(1.0, asked.feed.ratio);
    const auto written = spindle->update({.step_s = i > 0 ? dt_s : 0.0,
                                          .ratio = asked.spindle.ratio,
                                          .reason = asked.spindle.reason,
                                          .panel = frame.spindle,
                                          .unfit = Reason::none,
                                          .hold = false});
    frame.spindle.effective_ratio = spindle_word.pass(i, written.ratio);
    frame.feed.effective_ratio = feed_word.pass(i, feed_asked);
    frame.path_speed_mm_s = frame.feed.effective_ratio;
    const double goal = frame.spindle.effective_ratio * programmed_rev_s;
    // The drive's constant acceleration; power and torque limits are left to drive_limits.
    const double next = std::clamp(goal, speed - reach, speed + reach);
    if (i >= settle * cycles) {
      // The drive reaches its goal within the cycle and holds it for the rest: two ramps.
      const double ramp_s = std::min(
          dt_s, std::isfinite(reach) ? dt_s * std::abs(next - speed) / reach : kAtOnce * dt_s);
      add(course, {ramp_s, speed, next});
      add(course, {dt_s - ramp_s, next, next});
    }
    speed = next;
  }
  return course;
}

}  // namespace steadyrest::chatter::offline
