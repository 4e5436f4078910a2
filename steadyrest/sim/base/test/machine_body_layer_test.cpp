// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <steadyrest/sim/base/test/circle_body.hpp>
#include <steadyrest/sim/base/test/switch_code.hpp>
#include <steadyrest/sim/machine_body.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Machine;
using kernel::signal::Command;
using nc::plan::Setpoint;
using test::body_of;
using test::CircleSource;
using test::code_of;
using test::ideal_machine;
using test::radius;
using test::run;

// 30 % of F4000: q = 0.04, ε = 10·(1 − 1/√1.0016) = 0.0080 mm.
TEST(MachineBody, TheLayersWordSlowsTheFeedAndTheErrorFollows) {
  MachineBody body = body_of(ideal_machine());
  body.reset({10.0, 0.0, 0.0});
  CircleSource source(0.001);
  run(body, source, 3000, [](int i, Command& c) {
    c.heartbeat = static_cast<std::uint64_t>(i);
    c.feed_code = code_of(30);
    c.feed_masks_panel = true;
  });
  EXPECT_NEAR(body.frame().path_speed_mm_s, 0.3 * 4000.0 / 60.0, 1e-9);
  EXPECT_NEAR(10.0 - radius(body), 0.0080, 0.0001);  // reference table, 30 %
}

// The heartbeat stops at 1 s. Afterwards the panel's 100 % comes back by no more than one scan's
// share of the rise (2 1/s · 10 ms = 0.02).
TEST(MachineBody, DeadLayerLeavesNoCorrectionInForce) {
  MachineBody body = body_of(ideal_machine());
  body.reset({10.0, 0.0, 0.0});
  CircleSource source(0.001);
  double highest_rise = 0.0;
  double before = 1.0;
  run(
      body, source, 3000,
      [](int i, Command& c) {
        c.heartbeat = static_cast<std::uint64_t>(std::min(i, 1000));
        c.feed_code = code_of(30);
        c.feed_masks_panel = true;
      },
      [&](int) {
        const double now = body.frame().feed.effective_ratio;
        highest_rise = std::max(highest_rise, now - before);
        before = now;
      });
  EXPECT_NEAR(before, 1.0, 1e-12);
  EXPECT_LT(highest_rise, 0.021);
}

// Asked 0.5 mm, allowed 0.02 mm. When the layer dies in the cut the offset must stay: moving it
// would leave a step in the part.
TEST(MachineBody, OffsetsSlewFreezeInTheCutAndRampOutElsewhere) {
  Machine machine = ideal_machine();
  machine.envelope.offset_slew_mm_s = 0.05;
  machine.envelope.max_offset_mm = 0.02;
  MachineBody body = body_of(machine);
  body.reset({});
  Command command;
  Setpoint still;
  still.motion = kernel::signal::Motion::feed;
  double largest_step = 0.0;
  double before = 0.0;
  const auto go = [&](int cycles, bool alive) {
    for (int i = 0; i < cycles; ++i) {
      command.heartbeat += alive ? 1U : 0U;
      body.begin(command);
      body.end(still);
      largest_step = std::max(largest_step, std::abs(body.truth().command_mm[2] - before));
      before = body.truth().command_mm[2];
    }
  };
  command.offset_mm[2] = 0.5;  // more than the machine allows
  go(2000, true);
  EXPECT_NEAR(body.truth().tool_mm[2], 0.02, 1e-6);
  go(2000, false);
  EXPECT_NEAR(body.truth().command_mm[2], 0.02, 1e-12);
  still.motion = kernel::signal::Motion::rapid;
  go(2000, false);
  EXPECT_NEAR(body.truth().command_mm[2], 0.0, 1e-12);
  EXPECT_LE(largest_step, 0.05 * 0.001 * (1.0 + 1e-9));
}

// Asked 0.5 mm, allowed 0.1 mm at 10 mm/s. When the layer dies this one ramps out within 0.2 s, in
// the cut too: it belongs to a direction of travel that is soon another one.
TEST(MachineBody, PathOffsetsSlewAndRampOutInTheCutToo) {
  Machine machine = ideal_machine();
  machine.envelope.path_offset_slew_mm_s = 10.0;
  machine.envelope.max_path_offset_mm = 0.1;
  MachineBody body = body_of(machine);
  body.reset({});
  Command command;
  Setpoint still;
  still.motion = kernel::signal::Motion::feed;
  const auto go = [&](int cycles, bool alive) {
    double largest_step = 0.0;
    for (int i = 0; i < cycles; ++i) {
      const double before = body.truth().command_mm[0];
      command.heartbeat += alive ? 1U : 0U;
      body.begin(command);
      body.end(still);
      largest_step = std::max(largest_step, std::abs(body.truth().command_mm[0] - before));
    }
    return largest_step;
  };
  command.path_offset_mm[0] = 0.5;
  EXPECT_NEAR(go(100, true), 10.0 * 0.001, 1e-9);
  EXPECT_NEAR(body.truth().command_mm[0], 0.1, 1e-12);
  const int until_lost = static_cast<int>(machine.envelope.stale_after_s / 0.001);
  EXPECT_NEAR(go(until_lost + 100, false), 0.1 / 0.2 * 0.001, 1e-9);
  EXPECT_NEAR(body.truth().command_mm[0], 0.05, 0.001);
  go(110, false);
  EXPECT_NEAR(body.truth().command_mm[0], 0.0, 1e-12);
}

// Both offsets add; between two setpoints they run on a straight line, and the servo is told the
// speed of that.
TEST(MachineBody, OffsetsOfBothKindsAddUp) {
  Machine machine = ideal_machine();
  machine.envelope.max_path_offset_mm = 0.1;
  machine.envelope.path_offset_slew_mm_s = 10.0;
  machine.envelope.max_offset_mm = 0.05;
  machine.envelope.offset_slew_mm_s = 1.0;
  MachineBody body = body_of(machine);
  body.reset({});
  Command command;
  Setpoint still;
  command.path_offset_mm[1] = 0.08;
  command.offset_mm[1] = -0.03;
  for (int i = 0; i < 200; ++i) {
    ++command.heartbeat;
    body.begin(command);
    body.end(still);
  }
  EXPECT_NEAR(body.truth().command_mm[1], 0.05, 1e-12);
  EXPECT_NEAR(body.truth().program_mm[1], 0.0, 1e-12);
}

}  // namespace
}  // namespace steadyrest::sim
