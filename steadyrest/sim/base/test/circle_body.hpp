// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/sim/base/portable.hpp>
#include <steadyrest/sim/base/test/switch_code.hpp>
#include <steadyrest/sim/machine_body.hpp>

/// A machine body that runs a circle.
namespace steadyrest::sim::test {

using kernel::machine::Machine;
using kernel::signal::Command;
using nc::plan::Setpoint;

inline Machine ideal_machine() {
  Machine machine;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    axis.encoder.count_au = 0.0;
    machine.axes.push_back(axis);
  }
  for (std::uint32_t i = 0; i <= 12; ++i) {
    machine.feed_override.ratio.push_back(0.1 * i);
    machine.feed_override.code.push_back(kernel::override::gray_code(i + 1));
  }
  machine.spindle_override = machine.feed_override;
  machine.rapid_override = machine.feed_override;
  return machine;
}

inline MachineBody body_of(const Machine& machine,
                           const std::vector<OperatorAction>& actions = {}) {
  auto made = MachineBody::make({.machine = machine, .operator_actions = actions});
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return *std::move(made);
}

/// R = 10 mm at F4000 with the override in force, from portable functions. Replaces the
/// interpolator: the body is tested without the planner.
class CircleSource {
 public:
  explicit CircleSource(double period_s) : period_s_(period_s) {}
  Setpoint next(double ratio) {
    const double rate = 4000.0 / 60.0 / 10.0 * ratio;
    turns_ += rate * period_s_ / (2.0 * std::numbers::pi);
    Setpoint s;
    const double c = portable::sin_turn(turns_ + 0.25);
    const double n = portable::sin_turn(turns_);
    s.position = {10.0 * c, 10.0 * n, 0.0};
    s.velocity = {-10.0 * rate * n, 10.0 * rate * c, 0.0};
    s.motion = kernel::signal::Motion::feed;
    s.path_speed_mm_s = 10.0 * rate;
    s.programmed_feed_mm_s = 4000.0 / 60.0;
    s.spindle_rev_s = 50.0;
    return s;
  }

 private:
  double period_s_;
  double turns_ = 0.0;
};

/// Runs cycles; `layer` may change the command before each.
inline void run(MachineBody& body, CircleSource& source, int cycles,
                const std::function<void(int, Command&)>& layer = {},
                const std::function<void(int)>& look = {}) {
  Command command;
  for (int i = 1; i <= cycles; ++i) {
    if (layer) {
      layer(i, command);
    }
    const auto overrides = body.begin(command);
    body.end(source.next(overrides.feed_ratio));
    if (look) {
      look(i);
    }
  }
}

inline double radius(const MachineBody& body) {
  return std::hypot(body.truth().tool_mm[0], body.truth().tool_mm[1]);
}

}  // namespace steadyrest::sim::test
