// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/nc/follow/path_locator.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

/// A program on the planner's interpolator, which knows where it is, and a locator that does not.
namespace steadyrest::nc::follow::test {

using kernel::signal::Frame;
using kernel::signal::ProgramState;

inline const std::string kHead = "G21 G90 G94 G17 G61\n";

inline kernel::machine::Machine mill() {
  return passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
}

inline plan::PlannedPath planned(const std::string& text) {
  interpret::Config config;
  config.dialect = read::Dialect::linuxcnc;
  config.axes = "XYZ";
  const auto path = plan::plan_text(text, config, mill(), "program.ngc");
  EXPECT_TRUE(path.has_value()) << kernel::outcome::text(path.error()) << " in\n" << text;
  return path ? *path : plan::PlannedPath{};
}

/// One cycle: what the control does, and what the locator says.
struct Step {
  plan::Setpoint truth;
  PathLocator::Output seen;
};

inline Frame frame_of(const plan::Setpoint& setpoint, std::size_t cycle) {
  Frame frame;
  frame.time_s = 0.001 * static_cast<double>(cycle);
  frame.cycle = cycle;
  for (std::size_t i = 0; i < 3; ++i) {
    frame.axis[i].command_mm = setpoint.position[i];
  }
  frame.motion = setpoint.motion;
  frame.program_line = setpoint.line;
  frame.program = ProgramState::running;
  frame.path_speed_mm_s = setpoint.path_speed_mm_s;
  return frame;
}

/// Runs `path` on the control while the locator follows `route`; `change` may alter each frame and
/// returns the override.
inline std::vector<Step> driven(
    const plan::PlannedPath& path, const Route& route,
    const std::function<double(std::size_t, Frame&)>& change = [](std::size_t, Frame&) {
      return 1.0;
    }) {
  const kernel::machine::Machine machine = mill();
  auto interpolator = plan::Interpolator::make(machine, plan::whole(path)).value();
  PathLocator locator;
  locator.follow(&route);
  std::vector<Step> steps;
  // The axes stand where the program begins, then it runs.
  Frame stopped;
  stopped.program = ProgramState::stopped;
  for (std::size_t i = 0; i < 3 && !path.segments.empty(); ++i) {
    stopped.axis[i].command_mm = path.segments.front().start_mm[i];
  }
  (void)locator.update(stopped);
  (void)locator.update(stopped);
  double ratio = 1.0;
  for (std::size_t i = 0; i < 2'000'000; ++i) {
    const auto setpoint = interpolator.update({.feed_ratio = ratio, .rapid_ratio = ratio});
    if (setpoint.finished) {
      break;
    }
    Frame frame = frame_of(setpoint, i);
    ratio = change(i, frame);
    steps.push_back({setpoint, locator.update(frame)});
  }
  return steps;
}

/// Largest |place − truth| where the locator gives one, and in how many cycles it does.
struct Told {
  double worst_mm = 0.0;
  std::size_t cycles = 0;
  std::size_t moving = 0;
};
inline Told told(const std::vector<Step>& steps) {
  Told out;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Step& step = steps[i];
    if (step.truth.path_speed_mm_s <= 0.0) {
      continue;
    }
    ++out.moving;
    if (step.seen.place == Place::on_path) {
      ++out.cycles;
      out.worst_mm =
          std::max(out.worst_mm, std::abs(step.seen.position_mm - step.truth.path_position_mm));
    }
  }
  return out;
}

}  // namespace steadyrest::nc::follow::test
