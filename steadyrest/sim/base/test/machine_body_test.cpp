// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/sim/base/portable.hpp>
#include <steadyrest/sim/base/test/switch_code.hpp>
#include <steadyrest/sim/machine_body.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Machine;
using kernel::signal::Command;
using nc::plan::Setpoint;
using test::code_of;

Machine ideal_machine() {
  Machine machine;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    axis.encoder.count_mm = 0.0;
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

Machine real_machine() {
  Machine machine = ideal_machine();
  for (kernel::machine::Axis& axis : machine.axes) {
    axis.velocity_lag_s = 0.003;
    axis.drive_acceleration_mm_s2 = 4000.0;
    axis.backlash_mm = 0.006;
    axis.friction = {
        .coulomb_mm_s2 = 200.0, .breakaway_mm_s2 = 350.0, .stribeck_mm_s = 1.5, .viscous_1_s = 0.5};
    axis.encoder.count_mm = 0.001;
    axis.encoder.line_error_mm = 0.0003;
    axis.encoder.line_period_mm = 0.02;
  }
  machine.simulation.position_noise_mm = 0.0005;
  return machine;
}

MachineBody body_of(const Machine& machine, const std::vector<OperatorAction>& actions = {}) {
  auto made = MachineBody::make({.machine = machine, .operator_actions = actions});
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return *std::move(made);
}

/// R = 10 mm at F4000 on the override in force, from portable functions.
/// Takes the interpolator's place: the body is tested without the planner.
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
void run(MachineBody& body, CircleSource& source, int cycles,
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

double radius(const MachineBody& body) {
  return std::hypot(body.truth().tool_mm[0], body.truth().tool_mm[1]);
}

// The circle's closed form knows no sampling. With too coarse a fine interpolation the error would
// grow with the interpolator's period; all twelve must agree to 0.2 %.
TEST(MachineBody, FineInterpolationKeepsTheClosedFormAtEveryPeriod) {
  for (const double interpolator_s : {0.001, 0.002, 0.004, 0.012}) {
    for (const int ratio : {1, 2, 4}) {
      Machine machine = ideal_machine();
      machine.control.interpolator_period_s = interpolator_s;
      machine.control.servo_period_s = interpolator_s / ratio;
      MachineBody body = body_of(machine);
      body.reset({10.0, 0.0, 0.0});
      CircleSource source(interpolator_s);
      run(body, source, static_cast<int>(2.0 / interpolator_s));
      const double q = 4000.0 / 60.0 / 500.0;
      EXPECT_NEAR((10.0 - radius(body)) / (10.0 - 10.0 / std::sqrt(1.0 + q * q)), 1.0, 0.002)
          << interpolator_s << " / " << ratio;
    }
  }
}

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

// The heartbeat stops at 1 s. Afterwards the panel's 100 % comes back, by no more than one scan's
// share of the rise (2 1/s · 10 ms = 0.02).
TEST(MachineBody, DeadLayerLeavesNoCorrectionStanding) {
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

// Asked 0.5 mm, allowed 0.02 mm. A layer that dies in the cut must leave the offset where it is:
// moving it would leave a step in the part.
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

// The script is not in order of time on purpose. 0.5 ms of tolerance: cycles are 1 ms.
TEST(MachineBody, OperatorActsAtTheScriptedTimes) {
  const std::vector<OperatorAction> script = {
      {.time_s = 0.6, .act = OperatorAct::feed_start},
      {.time_s = 0.2, .act = OperatorAct::turn_feed, .code = code_of(50)},
      {.time_s = 0.4, .act = OperatorAct::feed_hold},
      {.time_s = 0.8, .act = OperatorAct::turn_spindle, .code = code_of(80)},
      {.time_s = 0.8, .act = OperatorAct::turn_rapid, .code = code_of(0)}};
  MachineBody body = body_of(ideal_machine(), script);
  body.reset({10.0, 0.0, 0.0});
  Command none;
  for (int i = 1; i <= 3000; ++i) {
    const auto overrides = body.begin(none);
    CircleSource source(0.001);
    body.end(source.next(0.0));
    const double t = 0.001 * i;
    const double feed = t < 0.1995 ? 1.0 : t > 0.3995 && t < 0.5995 ? 0.0 : 0.5;
    if (std::abs(t - 0.2) > 0.011) {  // one scan
      ASSERT_NEAR(overrides.feed_ratio, feed, 1e-12) << t;
    }
    if (t > 0.82) {
      ASSERT_EQ(overrides.rapid_ratio, 0.0);
    }
  }
  EXPECT_NEAR(body.frame().spindle_command_rev_s, 40.0, 1e-9);
  EXPECT_NEAR(body.frame().spindle_actual_rev_s, 40.0, 1e-9);
}

// The truth includes half of the backlash (3 µm), half a count, the line error and noise of 0.5 µm
// RMS at six sigma; the frame must show none of it but whole counts.
TEST(MachineBody, ControlSeesTheEncoderAndNotTheTruth) {
  MachineBody body = body_of(real_machine());
  body.reset({10.0, 0.0, 0.0});
  CircleSource source(0.001);
  double largest = 0.0;
  int whole_counts = 0;
  run(body, source, 2000, {}, [&](int) {
    const auto frame = body.frame();
    const auto& axis = frame.axis[0];
    ASSERT_EQ(axis.following_error_mm, axis.command_mm - axis.actual_mm);
    largest = std::max(largest, std::abs(axis.actual_mm - body.truth().tool_mm[0]));
    whole_counts += std::abs(axis.actual_mm - 0.001 * std::round(axis.actual_mm / 0.001)) < 1e-9;
  });
  EXPECT_EQ(whole_counts, 2000);
  EXPECT_GT(largest, 0.003);  // half the backlash at least
  EXPECT_LT(largest, 0.003 + 0.0005 + 0.0003 + 6.0 * 0.0005);
}

// FNV-1a over the bits: one bit of difference anywhere changes it.
std::uint64_t hash_of_run(const Machine& machine) {
  MachineBody body =
      body_of(machine, {{.time_s = 0.7, .act = OperatorAct::turn_feed, .code = code_of(60)}});
  body.reset({10.0, 0.0, 0.0});
  CircleSource source(machine.control.interpolator_period_s);
  std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a over the words
  const auto add = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211ULL;
  };
  run(
      body, source, 3000,
      [](int i, Command& c) {
        c.heartbeat = static_cast<std::uint64_t>(i);
        c.feed_masks_panel = i > 1500;
        c.feed_code = code_of(40);
        c.offset_mm = {0.01, 0.0, 0.0};
      },
      [&](int) {
        for (std::size_t a = 0; a < 3; ++a) {
          add(body.truth().tool_mm[a]);
          add(body.truth().velocity_mm_s[a]);
          add(body.frame().axis[a].actual_mm);
        }
        add(body.truth().spindle_rev_s);
        add(body.frame().feed.effective_ratio);
      });
  return hash;
}

// The number was recorded once. Fused multiply-add, another exp or another order of summation
// changes it: a run must not depend on the compiler.
TEST(MachineBody, SameSeedSameBytesWithEveryCompiler) {
  Machine machine = real_machine();
  EXPECT_EQ(hash_of_run(machine), hash_of_run(machine));
  EXPECT_EQ(hash_of_run(machine), 624364899645838801ULL);
  machine.simulation.seed = 2;
  EXPECT_NE(hash_of_run(machine), hash_of_run(real_machine()));
}

// One fault each, NaN among them.
TEST(MachineBody, RefusesWhatCannotBeBuilt) {
  const std::vector<std::function<void(Machine&)>> faults = {
      [](Machine& m) { m.axes.clear(); },
      [](Machine& m) { m.axes.resize(9); },
      [](Machine& m) { m.control.servo_period_s = 0.0007; },
      [](Machine& m) { m.control.servo_period_s = 0.002; },
      [](Machine& m) { m.control.interpolator_period_s = 0.0; },
      [](Machine& m) { m.axes[1].servo_gain_1_s = -1.0; },
      [](Machine& m) { m.spindle.inertia_kg_m2 = 0.0; },
      [](Machine& m) { m.feed_override.ratio = {1.0, 0.5}; },
      [](Machine& m) { m.simulation.position_noise_mm = std::numeric_limits<double>::quiet_NaN(); },
  };
  for (const auto& fault : faults) {
    Machine machine = ideal_machine();
    fault(machine);
    const auto made = MachineBody::make({.machine = machine});
    ASSERT_FALSE(made);
    EXPECT_FALSE(made.error().what.empty());
  }
}

}  // namespace
}  // namespace steadyrest::sim
