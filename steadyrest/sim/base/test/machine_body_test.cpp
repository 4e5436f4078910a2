// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/sim/base/test/circle_body.hpp>
#include <steadyrest/sim/base/test/switch_code.hpp>
#include <steadyrest/sim/machine_body.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Machine;
using kernel::signal::Command;
using test::body_of;
using test::CircleSource;
using test::code_of;
using test::ideal_machine;
using test::radius;
using test::run;

Machine real_machine() {
  Machine machine = ideal_machine();
  for (kernel::machine::Axis& axis : machine.axes) {
    axis.velocity_lag_s = 0.003;
    axis.drive_acceleration_au_s2 = 4000.0;
    axis.backlash_au = 0.006;
    axis.friction = {
        .coulomb_au_s2 = 200.0, .breakaway_au_s2 = 350.0, .stribeck_au_s = 1.5, .viscous_1_s = 0.5};
    axis.encoder.count_au = 0.001;
    axis.encoder.line_error_au = 0.0003;
    axis.encoder.line_period_au = 0.02;
  }
  machine.simulation.position_noise_mm = 0.0005;
  return machine;
}

// The circle's closed form has no sampling. With too coarse a fine interpolation the error would
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

// The script is out of time order on purpose. 0.5 ms of tolerance: cycles are 1 ms.
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
// RMS at six sigma; the frame must show only whole counts.
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
  EXPECT_EQ(hash_of_run(machine), 9883789723661921774ULL);
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
