// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

namespace signal = kernel::signal;
using kernel::machine::Mode;
using kernel::outcome::Reason;
using kernel::units::kNan;
using test::Bench;
using test::FakePort;
using test::kAll;
using test::mill;

// 500 cycles of 1 ms: long enough for any slew to finish, had anything moved. A port without any
// capability must never see a mask, and each channel must name the port as the reason.
TEST(Supervisor, WhatThePortCannotWriteIsSaidAndNotWritten) {
  Bench bench(Mode::act, {});
  bench.wish_feed(0.4);
  bench.wish_spindle(0.8);
  bench.wish_offset(0.02);
  const auto command = bench.cycles(500);
  EXPECT_FALSE(command.feed_masks_panel);
  EXPECT_FALSE(command.spindle_masks_panel);
  EXPECT_EQ(command.offset_mm, signal::AxisValues{});
  EXPECT_EQ(command.feed_reason, Reason::port_cannot_write);
  EXPECT_EQ(command.spindle_reason, Reason::port_cannot_write);
  EXPECT_EQ(command.offset_reason, Reason::port_cannot_write);
  EXPECT_EQ(command.path_offset_reason, Reason::port_cannot_write);
}

// The operator's 70 % passes unchanged, although nothing knows its code.
TEST(Supervisor, AMachineWithoutAnOverrideTableHasNoSuchOverride) {
  auto machine = mill(Mode::act);
  machine.feed_override = {};
  Bench bench(machine);
  bench.frame.feed.panel_ratio = 0.7;
  bench.wish_feed(0.4);
  const auto command = bench.cycles(100);
  EXPECT_EQ(command.feed_ratio, 0.7);
  EXPECT_FALSE(command.feed_masks_panel);
  EXPECT_EQ(command.feed_reason, Reason::port_cannot_write);
}

// The refusal goes up to the caller; a supervisor that swallowed it would run on old frames.
TEST(Supervisor, ALostLinkIsTheCyclesRefusal) {
  auto supervisor = Supervisor::make(mill(Mode::act), kAll);
  ASSERT_TRUE(supervisor);
  FakePort port;
  ASSERT_TRUE(supervisor->cycle(port, {}));
  EXPECT_EQ(port.written.size(), 1U);
  port.lost = true;
  const auto command = supervisor->cycle(port, {});
  ASSERT_FALSE(command);
  EXPECT_EQ(command.error().kind, kernel::outcome::Kind::unavailable);
}

// Truth: the uninterrupted run. Stopped in mid-slew at 123 ms, both must agree in every code from
// there on.
TEST(Supervisor, ARestoredStateGoesOnWhereItWas) {
  Bench first;
  first.wish_feed(0.4);
  first.wish_offset(0.02);
  first.cycles(123);
  Bench second;
  second.wish_feed(0.4);
  second.wish_offset(0.02);
  second.frame = first.frame;
  second.supervisor.restore(first.supervisor.state());
  for (int i = 0; i < 500; ++i) {
    const auto a = first.cycle();
    const auto b = second.cycle();
    ASSERT_EQ(a.feed_code, b.feed_code);
    ASSERT_EQ(a.feed_masks_panel, b.feed_masks_panel);
    ASSERT_EQ(a.offset_mm, b.offset_mm);
    ASSERT_EQ(a.heartbeat, b.heartbeat);
  }
}

// The hostile cycle: threads, bad ages and unknown codes take the rare branches.
TEST(Supervisor, ACycleAllocatesNothing) {
  Bench bench;
  bench.wish_feed(0.4);
  bench.wish_spindle(0.8);
  bench.wish_offset(0.02);
  const kernel::rt::testing::AllocationGuard guard;
  for (int i = 0; i < 300; ++i) {
    bench.frame.motion = i % 100 < 50 ? signal::Motion::feed : signal::Motion::tap;
    bench.frame.age_s = i % 60 == 0 ? kNan : 0.0;
    bench.frame.feed.panel_code_known = i % 70 != 0;
    bench.cycle();
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
