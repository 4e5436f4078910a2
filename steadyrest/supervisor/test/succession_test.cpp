// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/supervisor/succession.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::machine::Machine;
using test::Bench;
using test::kAll;
using test::kCycle_s;
using test::Mode;

constexpr std::size_t kZ = 2;

/// Another file takes over.
void change(Bench& bench, const Machine& running, const Machine& wanted) {
  auto next = Supervisor::make(wanted, kAll).value();
  next.take_over(bench.supervisor, kept(running, wanted));
  std::swap(bench.supervisor, next);
}

struct Asking : Bench {
  explicit Asking(const Machine& machine) : Bench(machine) {
    wish_feed(0.4);
    wish_spindle(0.8);
    wish_offset(0.02);
    cycles(2000);
  }
};

// The unchanged file is the hardest case: nothing at all may show.
TEST(Succession, TheSameFileChangesNoCommand) {
  const Machine machine = test::mill(Mode::act);
  Asking one(machine);
  Asking other(machine);
  for (int i = 0; i < 500; ++i) {
    if (i % 7 == 0) {
      change(other, machine, machine);
    }
    if (i == 100) {
      one.wish_feed(0.9);
      other.wish_feed(0.9);
    }
    const auto expected = one.cycle();
    const auto command = other.cycle();
    ASSERT_EQ(command.feed_ratio, expected.feed_ratio) << i;
    ASSERT_EQ(command.feed_code, expected.feed_code) << i;
    ASSERT_EQ(command.spindle_code, expected.spindle_code) << i;
    ASSERT_EQ(command.offset_mm, expected.offset_mm) << i;
    ASSERT_EQ(command.heartbeat, expected.heartbeat) << i;
    ASSERT_TRUE(command.write) << i;
  }
}

TEST(Succession, ANarrowerFeedRangeIsReachedThroughTheSlew) {
  const Machine running = test::mill(Mode::act);
  Asking bench(running);
  bench.wish_feed(0.9);
  bench.cycles(2000);
  Machine wanted = running;
  wanted.envelope.max_feed_ratio = 0.5;
  change(bench, running, wanted);
  const double fall = wanted.envelope.feed_fall_1_s * kCycle_s;
  double before = bench.supervisor.in_force().feed.ratio;
  EXPECT_NEAR(before, 0.9, 1e-9);
  for (int i = 0; i < 200; ++i) {
    bench.cycle();
    const double now = bench.supervisor.in_force().feed.ratio;
    ASSERT_GE(now, before - fall - 1e-12);
    before = now;
  }
  EXPECT_NEAR(before, 0.5, 1e-9);
}

TEST(Succession, ANarrowerOffsetRangeIsReachedThroughTheSlewEvenWhereItIsFrozen) {
  const Machine running = test::mill(Mode::act);
  for (const bool frozen : {false, true}) {
    Asking bench(running);
    bench.offset[0].slope_mm_s.fill(0.0);
    if (frozen) {
      bench.offset.clear();
    }
    Machine wanted = running;
    wanted.envelope.max_offset_mm = 0.01;
    change(bench, running, wanted);
    double before = 0.02;
    for (int i = 0; i < 100; ++i) {
      const double now = bench.cycle().offset_mm[kZ];
      ASSERT_LT(now, before) << i;
      ASSERT_GE(now, before - wanted.envelope.offset_slew_mm_s * kCycle_s - 1e-12) << i;
      before = now;
    }
    EXPECT_NEAR(bench.cycles(150).offset_mm[kZ], 0.01, 1e-12) << "and stays at its limit";
  }
}

// A command that the port does not take leaves the offset where the machine has it.
TEST(Succession, ANarrowerOffsetRangeIsReachedThroughTheSlewThoughAWriteFails) {
  const Machine running = test::mill(Mode::act);
  Asking bench(running);
  Machine wanted = running;
  wanted.envelope.max_offset_mm = 0.01;
  change(bench, running, wanted);
  test::FakePort port;
  port.frame = bench.frame;
  double before = 0.02;
  for (int i = 0; i < 100; ++i) {
    port.deaf = i == 50;
    const auto command =
        bench.supervisor.cycle(port, {.feed = bench.feed, .spindle = {}, .offset = bench.offset});
    ASSERT_EQ(command.has_value(), i != 50);
    if (command && command->write) {
      const double now = command->offset_mm[kZ];
      ASSERT_LE(now, before) << i;
      ASSERT_GE(now, before - 2.0 * wanted.envelope.offset_slew_mm_s * kCycle_s - 1e-12) << i;
      before = now;
    }
  }
  EXPECT_LT(before, 0.0165);
}

TEST(Succession, ALayerThatLeavesActGoesOnLeavingIt) {
  const Machine running = test::mill(Mode::act);
  Asking bench(running);
  bench.supervisor.set_mode(Mode::observe);
  bench.cycle();
  Machine wanted = running;
  wanted.envelope.feed_rise_1_s = 1.0;
  change(bench, running, wanted);
  EXPECT_EQ(bench.supervisor.mode_in_force(), Mode::act);
  bench.frame.motion = kernel::signal::Motion::rapid;
  bench.cycles(2000);
  EXPECT_EQ(bench.supervisor.mode_in_force(), Mode::observe);
}

TEST(Succession, AllocatesNothing) {
  Machine running = test::mill(Mode::act);
  running.contour.enabled = true;
  for (const double limit_mm : {running.contour.limit_mm, 0.02}) {
    Machine wanted = running;
    wanted.contour.limit_mm = limit_mm;
    Bench bench(running);
    bench.cycles(10);
    auto next = Supervisor::make(wanted, kAll).value();
    const Kept rooms = kept(running, wanted);
    EXPECT_EQ(rooms.contour, limit_mm == running.contour.limit_mm);
    const kernel::rt::testing::AllocationGuard guard;
    next.take_over(bench.supervisor, rooms);
    EXPECT_EQ(guard.allocations(), 0U);
  }
}

TEST(Succession, RefusesWhatCannotChangeUnderARunningMachine) {
  Machine running = test::mill(Mode::act);
  running.thermal.axis.resize(1);
  running.thermal.axis[0].mode.resize(1);
  const auto why = [&](const std::function<void(Machine&)>& change) {
    Machine wanted = running;
    change(wanted);
    const auto fit = fits(running, wanted);
    return fit ? std::string("fits") : fit.error().what;
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(why([](Machine& m) { m.port = kernel::machine::PortKind::linuxcnc; }),
              HasSubstr("port"));
  EXPECT_THAT(why([](Machine& m) { m.axes.pop_back(); }), HasSubstr("axes"));
  EXPECT_THAT(why([](Machine& m) { m.axes[1].name = "V"; }), HasSubstr("axes"));
  EXPECT_THAT(why([](Machine& m) { m.axes[1].rotary = true; }), HasSubstr("axes"));
  EXPECT_THAT(why([](Machine& m) { m.control.servo_period_s = 0.002; }),
              HasSubstr("servo_period_ms"));
  EXPECT_THAT(why([](Machine& m) { m.control.interpolator_period_s = 0.002; }),
              HasSubstr("interpolator_period_ms"));
  EXPECT_THAT(why([](Machine& m) { m.envelope.stale_after_s = 0.3; }), HasSubstr("stale_after_ms"));
  EXPECT_THAT(why([](Machine& m) { m.envelope.late_hold_s = 0.3; }), HasSubstr("late_hold_ms"));
  EXPECT_THAT(why([](Machine& m) { m.feed_override.coding = kernel::machine::Coding::binary; }),
              HasSubstr("override.feed"));
  EXPECT_THAT(why([](Machine& m) { m.spindle_override.scan_period_s = 0.5; }),
              HasSubstr("override.spindle"));
  EXPECT_THAT(why([](Machine& m) { m.thermal.axis[0].mode.resize(2); }), HasSubstr("thermal"));
  EXPECT_EQ(why([](Machine& m) { m.contour.limit_mm = 0.5; }), "fits");
  EXPECT_EQ(why([](Machine& m) { m.envelope.max_feed_ratio = 0.5; }), "fits");
  EXPECT_EQ(why([](Machine& m) { m.axes[0].servo_gain_1_s = 20.0; }), "fits");
  EXPECT_EQ(why([](Machine& m) { m.thermal.axis[0].mode[0].tau_s = 20.0; }), "fits");
}

}  // namespace
}  // namespace steadyrest::supervisor
