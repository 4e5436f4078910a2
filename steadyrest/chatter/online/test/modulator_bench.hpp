// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>

/// A modulator in a control whose spindle and feed follow at once.
namespace steadyrest::chatter::online::test {

namespace tables = kernel::override::test;
using kernel::signal::Motion;

inline constexpr double kCycle_s = 0.002;
inline constexpr double kSpeed_rev_s = 50.0;

inline Modulator::Config sine_config() {
  Modulator::Config c;
  c.modulation = {.law = Law::sine, .amplitude_ratio = 0.1, .period_s = 1.0};
  c.spindle_table = tables::spindle_840d();
  c.spindle_table.layer_may_exceed_panel = true;
  c.feed_table = tables::feed_840d();
  c.fade_s = 0.2;
  return c;
}

/// A modulator, its frame and the result of its requests; the spindle and the feed follow at once.
class Bench {
 public:
  explicit Bench(const Modulator::Config& c = sine_config())
      : modulator(Modulator::make(c).value()) {
    frame.motion = Motion::feed;
    frame.speed_modulation = true;
    frame.programmed_feed_mm_s = 10.0;
    frame.path_speed_mm_s = 10.0;
    frame.spindle_programmed_rev_s = kSpeed_rev_s;
    frame.spindle_actual_rev_s = kSpeed_rev_s;
  }

  Modulator::Output cycle() {
    frame.time_s += kCycle_s;
    const auto out = modulator.update(frame, in_force);
    frame.spindle.effective_ratio = out.spindle.ratio;
    frame.spindle_actual_rev_s = out.spindle.ratio * frame.spindle_programmed_rev_s;
    frame.feed.effective_ratio = std::min(frame.feed.panel_ratio, out.feed.ratio);
    frame.path_speed_mm_s = frame.feed.effective_ratio * frame.programmed_feed_mm_s;
    in_force.feed = {frame.feed.effective_ratio, frame.feed.effective_ratio};
    in_force.spindle = {out.spindle.ratio, out.spindle.ratio};
    return out;
  }
  std::vector<Modulator::Output> run(double time_s) {
    std::vector<Modulator::Output> all;
    for (double t = 0.0; t < time_s; t += kCycle_s) {
      all.push_back(cycle());
    }
    return all;
  }

  Modulator modulator;
  kernel::signal::Frame frame;
  kernel::signal::InForce in_force{.written = true};
};

inline std::vector<double> ratios(const std::vector<Modulator::Output>& outputs) {
  std::vector<double> all;
  all.reserve(outputs.size());
  for (const auto& out : outputs) {
    all.push_back(out.spindle.ratio);
  }
  return all;
}

}  // namespace steadyrest::chatter::online::test
