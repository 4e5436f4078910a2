// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::machine::Mode;
using kernel::outcome::Reason;
using kernel::signal::Motion;
using test::Bench;
using test::kAll;
using test::kCycle_s;

constexpr double kSlope_mm_s = 0.060 / 60.0;
constexpr double kMost_mm = 0.020;
constexpr std::size_t kHeatZ = 2;

/// Z grows fast, so that a test of a few seconds shows something.
kernel::machine::Machine warming(Mode mode) {
  auto machine = test::mill(mode);
  machine.axes[1].name = "Y";
  machine.axes[2].name = "Z";
  machine.axes[3].name = "A";
  machine.thermal.enabled = true;
  machine.thermal.max_offset_mm = kMost_mm;
  machine.thermal.slope_mm_s = kSlope_mm_s;
  kernel::machine::ThermalAxis z;
  z.name = "Z";
  z.mode.emplace_back();
  z.mode[0].tau_s = 10.0;
  z.mode[0].speed_rev_s = {0.0, 100.0};
  z.mode[0].level_mm = {0.0, 0.010};
  z.ambient.push_back({.sensor = "room", .tau_s = 0.0, .gain_mm_k = 0.001});
  machine.thermal.axis = {z};
  return machine;
}

struct Warm : Bench {
  explicit Warm(Mode mode = Mode::act, const kernel::port::Capability& capability = kAll)
      : Bench(warming(mode), capability) {
    frame.spindle_actual_rev_s = 50.0;
    frame.temperature_c[0] = 20.0;
  }
};

// 20 000 cycles of 1 ms are 20 s = 2τ; at 50 of 100 rev/s the level is half of 0.010 mm: 0.005·(1
// − e⁻²) = 0.00432 mm, and the axis goes the other way.
TEST(ThermalRoom, MovesTheAxisAgainstItsGrowth) {
  Warm bench;
  const auto command = bench.cycles(20'000);
  const double grown = 0.005 * (1.0 - std::exp(-2.0));
  EXPECT_NEAR(command.offset_mm[kHeatZ], -grown, 6e-4) << "handed on once a second";
  EXPECT_EQ(command.offset_reason, Reason::thermal_correcting);
  EXPECT_TRUE(command.write);
  ASSERT_TRUE(bench.supervisor.estimates().thermal);
  EXPECT_NEAR(bench.supervisor.estimates().thermal->displacement_mm[kHeatZ], grown, 6e-4);
}

TEST(ThermalRoom, IsOffUnlessTheMachineFileSaysSo) {
  auto machine = warming(Mode::act);
  machine.thermal.enabled = false;
  Bench bench(machine);
  bench.frame.spindle_actual_rev_s = 50.0;
  EXPECT_EQ(bench.cycles(5000).offset_mm[kHeatZ], 0.0);
  EXPECT_FALSE(bench.supervisor.estimates().thermal);
  EXPECT_EQ(bench.supervisor.thermal(), nullptr);
}

// After 5 s the axis has grown 0.005·(1 − e^−0.5) = 0.00197 mm.
TEST(ThermalRoom, ObservingItForecastsAndWritesNothing) {
  Warm bench(Mode::observe);
  const auto command = bench.cycles(5000);
  EXPECT_EQ(command.offset_mm[kHeatZ], 0.0);
  EXPECT_FALSE(command.write);
  EXPECT_GT(bench.supervisor.estimates().thermal->displacement_mm[kHeatZ], 0.001);
}

// On the way to act the advised offset must not appear at once: it has never been on the machine,
// so it starts from 0 and moves by no more than the slope in each cycle.
TEST(ThermalRoom, WhatWasOnlyAdvisedIsNotTakenOverByAJump) {
  Warm bench(Mode::observe);
  bench.cycles(20'000);
  bench.supervisor.set_mode(Mode::act);
  double before = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double offset = bench.cycle().offset_mm[kHeatZ];
    ASSERT_LE(std::abs(offset - before), kSlope_mm_s * kCycle_s * (1.0 + 1e-6));
    before = offset;
  }
  EXPECT_LT(before, -0.001);
}

// Stale in air: out within 500 ms at the envelope's slew; back in the cut at the room's much
// gentler slope.
TEST(ThermalRoom, AfterStaleInputTheOffsetComesBackByTheSlope) {
  Warm bench;
  bench.cycles(20'000);
  bench.frame.motion = Motion::rapid;
  bench.cycle();
  bench.frame.age_s = 1.0;
  EXPECT_EQ(bench.cycles(500).offset_mm[kHeatZ], 0.0)
      << "out of the cut: ramped out by the envelope";
  bench.frame.age_s = 0.0;
  bench.frame.motion = Motion::feed;
  double before = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double offset = bench.cycle().offset_mm[kHeatZ];
    ASSERT_LE(std::abs(offset - before), kSlope_mm_s * kCycle_s * (1.0 + 1e-6));
    before = offset;
  }
}

TEST(ThermalRoom, APortThatTakesNoOffsetsGetsNone) {
  Warm bench(Mode::act, {.feed_override = true, .spindle_override = true, .latched_word = true});
  const auto command = bench.cycles(5000);
  EXPECT_EQ(command.offset_mm[kHeatZ], 0.0);
  EXPECT_EQ(command.offset_reason, Reason::port_cannot_write);
}

// Truth: the run without a restart. Lost heat would show as an offset that starts at 0.
TEST(ThermalRoom, ItsHeatOutlivesARestart) {
  Warm bench;
  bench.cycles(20'000);
  Warm restarted;
  restarted.supervisor.restore(bench.supervisor.state());
  restarted.frame = bench.frame;
  for (int i = 0; i < 1500; ++i) {
    ASSERT_EQ(bench.cycle().offset_mm, restarted.cycle().offset_mm);
  }
}

// Sensors drop out more often than frames: the thermal room withdraws alone.
TEST(ThermalRoom, AnUnknownTemperatureDoesNotMakeTheFrameUnfit) {
  Warm bench;
  bench.frame.temperature_c = kernel::signal::unknown_temperatures();
  const auto command = bench.cycles(100);
  EXPECT_EQ(command.offset_reason, Reason::thermal_sensor_lost);
  EXPECT_EQ(command.feed_reason, Reason::none);
}

// The probe finds the growth plus whatever offset is in force; only act has an offset in force.
TEST(ThermalRoom, AReadingOfThePortIsOfWhatStandsInEveryMode) {
  for (const Mode mode : {Mode::observe, Mode::advise, Mode::act}) {
    Warm bench(mode);
    const auto command = bench.cycles(20'000);
    const double stands = mode == Mode::act ? command.offset_mm[kHeatZ] : 0.0;
    const auto& thermal = bench.supervisor.estimates().thermal;
    bench.frame.probe = {.number = 1,
                         .axis = kHeatZ,
                         .displacement_mm = thermal->displacement_mm[kHeatZ] + stands + 0.0003,
                         .sd_mm = 0.0002};
    bench.cycle();
    EXPECT_EQ(thermal->probed.verdict.reason, Reason::thermal_reading_taken);
    EXPECT_NEAR(thermal->probed.verdict.innovation_mm, 0.0003, 1e-4) << "but for a second's heat";
    bench.cycles(100);
    EXPECT_EQ(bench.supervisor.thermal()->state().axis[kHeatZ].filter.readings, 1U);
  }
}

// The thermal room rejects a probe that reports NaN; the feed goes on.
TEST(ThermalRoom, AReadingThatIsNoneDoesNotMakeTheFrameUnfit) {
  Warm bench;
  bench.cycles(10);
  bench.frame.probe = {
      .number = 1, .axis = kHeatZ, .displacement_mm = kernel::units::kNan, .sd_mm = 0.0};
  const auto command = bench.cycle();
  EXPECT_EQ(command.feed_reason, Reason::none);
  EXPECT_EQ(bench.supervisor.estimates().thermal->probed.verdict.reason, Reason::input_not_finite);
}

TEST(ThermalRoom, DoesNotAllocateInTheCycle) {
  Warm bench;
  bench.cycles(10);
  const kernel::rt::testing::AllocationGuard guard;
  bench.cycles(2000);
  EXPECT_EQ(guard.allocations(), 0U);
}

/// Slope while the room's offset is in force, the envelope's slew while it ramps out, nothing while
/// frozen.
RC_GTEST_PROP(ThermalRoomSafety, NoHistoryLeavesClampSlopeOrFreeze, ()) {
  Warm bench;
  const double slew = warming(Mode::act).envelope.offset_slew_mm_s;
  bench.cycles(4000);
  double before = bench.cycle().offset_mm[kHeatZ];
  bool in_cut = true;
  for (int k = 0; k < 30; ++k) {
    bench.frame.motion = static_cast<Motion>(*rc::gen::inRange(0, 9));
    bench.frame.spindle_actual_rev_s = *rc::gen::inRange(0, 120);
    bench.frame.temperature_c[0] =
        *rc::gen::weightedElement<double>({{5, 20.0}, {2, 25.0}, {1, kernel::units::kNan}});
    bench.frame.age_s = *rc::gen::weightedElement<double>({{4, 0.0}, {1, 5.0}});
    const bool unfit = bench.frame.age_s > 0.0;
    const int cycles = *rc::gen::inRange(1, 60);
    for (int i = 0; i < cycles; ++i) {
      const auto command = bench.cycle();
      const double offset = command.offset_mm[kHeatZ];
      if (!unfit) {
        const Motion m = bench.frame.motion;
        in_cut = m == Motion::feed || m == Motion::thread || m == Motion::tap
                     ? true
                     : (m == Motion::rapid || m == Motion::tool_change ? false : in_cut);
      }
      RC_ASSERT(std::abs(offset) <= kMost_mm);
      const double moved = std::abs(offset - before);
      RC_ASSERT(!unfit || !in_cut || moved == 0.0);
      RC_ASSERT(unfit || moved <= kSlope_mm_s * kCycle_s * (1.0 + 1e-6));
      RC_ASSERT(moved <= slew * kCycle_s * (1.0 + 1e-6));
      RC_ASSERT(!unfit || std::abs(offset) <= std::abs(before));
      before = offset;
    }
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
