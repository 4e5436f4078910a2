// SPDX-License-Identifier: Apache-2.0
// Words that the port did not take or the watchdog dropped: review findings as tests.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

namespace signal = kernel::signal;
using kernel::machine::Mode;
using kernel::outcome::Reason;
using test::Bench;
using test::kAll;
using test::kCycle_s;
using test::mill;
using test::wired;

// Away for longer than the watchdog (100 ms), or for an unknown time: the first frame has no known
// gap and is not written, the second begins at the panel and at offset 0.
TEST(Interruption, WhatTheWatchdogHasDroppedIsNotWrittenAfterARestore) {
  for (const double away_s : {60.0, 0.5, -100.0, -1e9}) {
    Bench first(wired(Mode::act));
    first.wish_feed(0.5);
    first.wish_offset(0.02);
    first.cycles(2000);
    Bench second(wired(Mode::act));
    second.wish_feed(0.5);
    second.wish_offset(0.02);
    second.frame = first.frame;
    second.frame.time_s += away_s;
    second.supervisor.restore(first.supervisor.state());
    EXPECT_FALSE(second.cycle().write) << away_s << ": the length of the gap is not known yet";
    auto command = second.cycle();
    EXPECT_TRUE(command.write) << away_s;
    EXPECT_FALSE(command.feed_masks_panel) << away_s;
    EXPECT_LE(command.offset_mm[2], 0.05 * kCycle_s + 1e-8) << away_s;
    command = second.cycles(1000);
    EXPECT_EQ(command.feed_ratio, 0.5) << away_s;
    EXPECT_EQ(command.offset_mm[2], 0.02) << away_s;
  }
}

// A module that keeps its outputs for 200 ms has everything still after 150: a layer that began at
// the panel would have the feed jump.
TEST(Interruption, WhatTheMachineKeepsLongerIsGoneOnWith) {
  for (const double keeps_s : {0.2, 0.0}) {
    auto machine = mill(Mode::act);
    machine.port = kernel::machine::PortKind::lines;
    machine.lines.cycle_s = kCycle_s;
    machine.lines.watchdog_s = keeps_s;
    auto supervisor = Supervisor::make(machine, kAll).value();
    test::FakePort port;
    port.frame.motion = signal::Motion::feed;
    port.frame.feed.panel_code = 0b11010;
    const std::vector<signal::FeedRequest> wish = {{.ratio = 0.5, .reason = Reason::contour_limit}};
    const auto cycles = [&](int count) {
      for (int i = 0; i < count; ++i) {
        static_cast<void>(
            supervisor.cycle(port, {.feed = wish, .spindle = {}, .offset = {}, .path_offset = {}}));
      }
    };
    cycles(1000);
    ASSERT_EQ(port.written.back().feed_ratio, 0.5);
    port.lost = true;
    cycles(3);  // of 50 ms each
    port.lost = false;
    port.frame.time_s += 0.15;
    const std::size_t so_far = port.written.size();
    cycles(300);
    ASSERT_GT(port.written.size(), so_far);
    EXPECT_EQ(port.written[so_far].feed_masks_panel, keeps_s > 0.0);
  }
}

/// A port that refuses to write for a while.
class DeafPort final : public kernel::port::Port {
 public:
  [[nodiscard]] kernel::port::Capability capability() const noexcept override { return kAll; }
  kernel::outcome::Result<signal::Frame> read() noexcept override {
    frame.time_s += kCycle_s;
    if (blind) {
      return std::unexpected(kernel::outcome::Refusal{});
    }
    return frame;
  }
  kernel::outcome::Result<void> write(const signal::Command& command) noexcept override {
    if (deaf) {
      return std::unexpected(kernel::outcome::Refusal{});
    }
    written.push_back(command);
    return {};
  }

  bool deaf = false;
  bool blind = false;
  signal::Frame frame;
  std::vector<signal::Command> written;
};

// A walk goes step by step, each on the wires for one scan. Sixty deaf cycles cover three scans; a
// supervisor that believed its own writes would end up three steps further down.
TEST(Interruption, AWordThatThePortDidNotTakeWasNotWritten) {
  auto supervisor = Supervisor::make(wired(Mode::act), kAll);
  ASSERT_TRUE(supervisor);
  DeafPort port;
  port.frame.motion = signal::Motion::feed;
  const std::vector<signal::FeedRequest> wish = {{.ratio = 0.2, .reason = Reason::contour_limit}};
  const auto cycles = [&](int count) {
    for (int i = 0; i < count; ++i) {
      static_cast<void>(supervisor->cycle(port, {.feed = wish, .spindle = {}, .offset = {}}));
    }
  };
  cycles(100);
  const double before = port.written.back().feed_ratio;
  port.deaf = true;
  cycles(60);
  port.deaf = false;
  cycles(1);
  EXPECT_GE(port.written.back().feed_ratio, before - 0.05 - 1e-9)
      << "for three scans no step was written: the next one follows, not the fourth";
  EXPECT_TRUE(port.written.back().feed_masks_panel);
}

// The write failed, the reading did not: the operator's 0 came in with the same frame. With the
// panel's code unknown from then on, the last known value, 0, must hold.
TEST(Interruption, ThePanelThatAnUndeliveredCycleSawIsKnown) {
  auto supervisor = Supervisor::make(mill(Mode::act), kAll);
  ASSERT_TRUE(supervisor);
  DeafPort port;
  port.frame.motion = signal::Motion::feed;
  const std::vector<signal::FeedRequest> wish = {{.ratio = 0.5, .reason = Reason::contour_limit}};
  const auto cycles = [&](int count) {
    for (int i = 0; i < count; ++i) {
      static_cast<void>(supervisor->cycle(port, {.feed = wish, .spindle = {}, .offset = {}}));
    }
  };
  cycles(1000);
  ASSERT_TRUE(port.written.back().feed_masks_panel);
  port.deaf = true;
  port.frame.feed.panel_ratio = 0.0;  // the operator stops the machine
  cycles(3);
  port.deaf = false;
  port.frame.feed.panel_code_known = false;
  cycles(1);
  EXPECT_FALSE(port.written.back().feed_masks_panel);
}

// The clock stopped for 19 ms, just less than the watchdog's time, while frames and writes went on.
// A supervisor that measured the gap from the last good time would treat its own word as dropped.
TEST(Interruption, AfterAClockThatStoodNothingIsTakenForDropped) {
  auto machine = mill(Mode::act);
  machine.envelope.stale_after_s = 0.02;
  Bench first(machine);
  first.wish_feed(0.5);
  ASSERT_TRUE(first.cycles(1000).feed_masks_panel);
  for (int i = 0; i < 19; ++i) {
    first.supervisor.update(first.frame, {.feed = first.feed, .spindle = {}, .offset = {}});
  }
  first.frame.time_s += 19.0 * kCycle_s;  // the clock resumes at the right time
  ASSERT_TRUE(first.cycle().feed_masks_panel);
  Bench second(machine);
  second.wish_feed(0.5);
  second.frame = first.frame;
  second.supervisor.restore(first.supervisor.state());
  const auto command = second.cycle();
  EXPECT_TRUE(command.write);
  EXPECT_TRUE(command.feed_masks_panel) << "the last word is a cycle old";
  EXPECT_EQ(command.feed_ratio, 0.5);
}

// 500 cycles without a read or a write are five times the watchdog's 100 ms.
TEST(Interruption, AfterALostLinkLongerThanTheWatchdogItBeginsAtThePanel) {
  for (const bool blind : {false, true}) {
    auto supervisor = Supervisor::make(wired(Mode::act), kAll);
    ASSERT_TRUE(supervisor);
    DeafPort port;
    port.frame.motion = signal::Motion::feed;
    const std::vector<signal::FeedRequest> wish = {{.ratio = 0.2, .reason = Reason::contour_limit}};
    std::vector<signal::OffsetRequest> offset = {{.reason = Reason::contour_limit}};
    offset[0].offset_mm[2] = 0.02;
    const auto cycles = [&](int count) {
      for (int i = 0; i < count; ++i) {
        static_cast<void>(supervisor->cycle(port, {.feed = wish, .spindle = {}, .offset = offset}));
      }
    };
    cycles(1000);
    EXPECT_EQ(port.written.back().offset_mm[2], 0.02);
    (blind ? port.blind : port.deaf) = true;
    cycles(500);
    port.blind = port.deaf = false;
    const std::size_t so_far = port.written.size();
    cycles(3);
    ASSERT_GT(port.written.size(), so_far);
    EXPECT_FALSE(port.written[so_far].feed_masks_panel);
    EXPECT_LE(port.written[so_far].offset_mm[2], 0.05 * kCycle_s + 1e-12);
  }
}

/// A supervisor that holds 50 % and an offset of 20 µm on a port that can be deaf.
struct Holding {
  Holding() : supervisor(Supervisor::make(mill(Mode::act), kAll).value()) {
    port.frame.motion = signal::Motion::feed;
    offset[0].offset_mm[2] = 0.02;
    cycles(1000);
    EXPECT_TRUE(port.written.back().feed_masks_panel);
    EXPECT_EQ(port.written.back().offset_mm[2], 0.02);
  }
  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      static_cast<void>(supervisor.cycle(port, {.feed = feed, .spindle = {}, .offset = offset}));
    }
  }
  Supervisor supervisor;
  DeafPort port;
  std::vector<signal::FeedRequest> feed = {{.ratio = 0.5, .reason = Reason::contour_limit}};
  std::vector<signal::OffsetRequest> offset = {{.reason = Reason::contour_limit}};
};

// A write fails for one cycle, and the clock is set just then: by the stamps an hour has passed,
// but the machine holds word and offset still, and would take a start at the panel for a jump.
TEST(Interruption, AClockThatIsSetWhileAWriteFailsMovesNothing) {
  for (const double set_s : {3600.0, -500.0, 0.3}) {
    Holding layer;
    layer.port.deaf = true;
    layer.cycles(1);
    layer.port.deaf = false;
    layer.port.frame.time_s += set_s;
    const std::size_t so_far = layer.port.written.size();
    layer.cycles(95);
    EXPECT_EQ(layer.port.written.size(), so_far) << set_s << ": silent until the watchdog is sure";
    layer.cycles(10);
    ASSERT_GT(layer.port.written.size(), so_far) << set_s;
    EXPECT_FALSE(layer.port.written[so_far].feed_masks_panel) << set_s;
    EXPECT_LE(layer.port.written[so_far].offset_mm[2], 0.05 * kCycle_s + 1e-12) << set_s;
  }
}

// The control's clock stood while 150 ms of writes failed: the watchdog has dropped everything,
// whatever the stamps say.
TEST(Interruption, SilenceCountsWhereTheClockStands) {
  Holding layer;
  layer.port.deaf = true;
  for (int i = 0; i < 150; ++i) {
    layer.cycles(1);
    layer.port.frame.time_s -= kCycle_s;
  }
  layer.port.deaf = false;
  const std::size_t so_far = layer.port.written.size();
  layer.cycles(2);
  ASSERT_GT(layer.port.written.size(), so_far);
  EXPECT_FALSE(layer.port.written[so_far].feed_masks_panel);
  EXPECT_LE(layer.port.written[so_far].offset_mm[2], 0.05 * kCycle_s + 1e-12);
}

// The source is dead: the same frame comes again and again. No slew gets any credit, so the layer
// cannot go to neutral; after the watchdog's 100 ms it writes nothing, and the machine hands back.
TEST(Interruption, ASourceThatStandsGetsNothingMore) {
  Bench bench;
  bench.wish_feed(0.5);
  bench.wish_offset(0.02);
  ASSERT_TRUE(bench.cycles(1000).feed_masks_panel);
  const auto again = [&bench](int count) {
    signal::Command command;
    for (int i = 0; i < count; ++i) {
      command = bench.supervisor.update(
          bench.frame,
          {.feed = bench.feed, .spindle = {}, .offset = bench.offset, .path_offset = {}});
    }
    return command;
  };
  EXPECT_TRUE(again(99).feed_masks_panel) << "a glitch of the clock";
  for (const int cycles : {2, 1000}) {
    const auto command = again(cycles);
    EXPECT_FALSE(command.write);
    EXPECT_EQ(command.feed_reason, Reason::input_stale);
    EXPECT_EQ(command.offset_reason, Reason::input_stale);
  }
  const auto command = bench.cycle();
  EXPECT_TRUE(command.write);
  EXPECT_FALSE(command.feed_masks_panel);
  EXPECT_LE(command.offset_mm[2], 0.05 * kCycle_s + 1e-12);
}

TEST(Interruption, ARestoredSilenceThatIsNoNumberHasOutlastedTheWatchdog) {
  for (const double silent_s : {std::nan(""), -1.0}) {
    Bench first;
    first.wish_feed(0.5);
    first.wish_offset(0.02);
    first.cycles(1000);
    auto state = first.supervisor.state();
    state.silent_s = silent_s;
    Bench second;
    second.wish_feed(0.5);
    second.wish_offset(0.02);
    second.frame = first.frame;
    second.supervisor.restore(state);
    signal::Command command;
    for (int i = 0; i < 10 && !command.write; ++i) {
      command = second.cycle();
    }
    EXPECT_TRUE(command.write) << silent_s;
    EXPECT_LE(command.offset_mm[2], 0.05 * kCycle_s + 1e-8) << "begins at 0";
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
