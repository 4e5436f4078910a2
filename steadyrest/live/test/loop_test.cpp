// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::live {
namespace {

using kernel::machine::Mode;
using kernel::outcome::Reason;
using kernel::outcome::Result;
using kernel::signal::Command;
using kernel::signal::Frame;
using test::Desk;

/// Passes everything on, counts what is written, and fails when it is told to.
class Spy final : public kernel::port::Port {
 public:
  explicit Spy(kernel::port::Port& inner) : inner_(inner) {}
  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return inner_.capability();
  }
  Result<Frame> read() noexcept override {
    ++reads;
    if (at_read) {
      at_read(reads);
    }
    if (lost) {
      return std::unexpected(kernel::outcome::Refusal{.kind = kernel::outcome::Kind::unavailable,
                                                      .file = {},
                                                      .what = "the link is lost",
                                                      .to_do = "look at the cable"});
    }
    auto frame = inner_.read();
    if (frame && motion) {
      frame->motion = *motion;
    }
    return frame;
  }
  Result<void> write(const Command& command) noexcept override {
    ++writes;
    lowest = std::min(lowest, command.feed_ratio);
    last = command;
    return inner_.write(command);
  }
  bool lost = false;
  std::optional<kernel::signal::Motion> motion;  ///< instead of the machine's
  int reads = 0;
  int writes = 0;
  double lowest = 10.0;
  Command last;
  std::function<void(int)> at_read;

 private:
  kernel::port::Port& inner_;
};

Loop::Config until_finished(const Desk& desk, Mode mode) {
  return {.period_s = desk.machine.control.interpolator_period_s,
          .contour_limit_mm = 0.01,
          .mode = mode,
          .finished = [&desk] { return desk.port->finished(); }};
}

TEST(Loop, PassesNotesOnInOrderOneACycle) {
  Desk desk;
  std::vector<std::string> notes;
  Loop::Config config = until_finished(desk, Mode::observe);
  config.most_cycles = 10;
  config.on_note = [&](std::string_view words) { notes.emplace_back(words); };
  Loop loop(*desk.port, *desk.layer, desk.pace, config);
  EXPECT_TRUE(loop.note("anna asked for act"));
  EXPECT_TRUE(loop.note(std::string(500, 'x')));
  loop.run();
  EXPECT_EQ(notes, (std::vector<std::string>{"anna asked for act", std::string(160, 'x')}));
}

TEST(Loop, ObservesWithoutWriting) {
  Desk desk;
  Spy spy(*desk.port);
  Loop loop(spy, *desk.layer, desk.pace, until_finished(desk, Mode::observe));
  const LoopFigures figures = loop.run();
  EXPECT_EQ(spy.writes, 0);
  EXPECT_EQ(figures.cycles, static_cast<std::uint64_t>(spy.reads));
  EXPECT_TRUE(figures.handed_back);
  // (v/k)²/(2·R) = 88 µm on the whole circle: 2π·R/v, and v/a + a/j for its two ends.
  EXPECT_NEAR(figures.over_limit_s, 0.942 + 0.083, 0.05);
}

TEST(Loop, ActsAndHandsBack) {
  Desk desk;
  Spy spy(*desk.port);
  Loop loop(spy, *desk.layer, desk.pace, until_finished(desk, Mode::act));
  const LoopFigures figures = loop.run();
  EXPECT_GT(spy.writes, 100);
  EXPECT_LT(spy.lowest, 0.5);
  EXPECT_TRUE(figures.handed_back);
  EXPECT_EQ(desk.layer->mode_in_force(), Mode::observe);
  EXPECT_FALSE(spy.last.feed_masks_panel);
  EXPECT_LT(figures.over_limit_s, 0.15);
}

TEST(Loop, AStopInTheCutGoesToNeutralThroughTheSlew) {
  Desk desk;
  Spy spy(*desk.port);
  Loop loop(spy, *desk.layer, desk.pace, until_finished(desk, Mode::act));
  double at_stop = 0.0;
  double largest_step = 0.0;
  double before = 1.0;
  spy.at_read = [&](int reads) {
    if (reads == 300) {
      at_stop = spy.last.feed_ratio;
      loop.ask_stop();
    }
    if (reads > 301) {
      largest_step = std::max(largest_step, spy.last.feed_ratio - before);
    }
    before = spy.last.feed_ratio;
  };
  const LoopFigures figures = loop.run();
  EXPECT_LT(at_stop, 0.6);
  EXPECT_TRUE(figures.handed_back);
  EXPECT_GT(spy.reads, 303) << "it takes some cycles";
  EXPECT_LT(largest_step, 0.11) << "a step of the panel's switch at most";
  EXPECT_FALSE(desk.port->finished());
}

// A process that is stopped and goes on: the machine has handed back meanwhile.
TEST(Loop, AfterAStandstillItBeginsAtThePanelAndGoesByTheSlew) {
  for (const double still_s : {0.15, 0.25, 10.0}) {
    Desk desk;
    Spy spy(*desk.port);
    Loop::Config config = until_finished(desk, Mode::act);
    config.holds_s = 0.2;
    Loop loop(spy, *desk.layer, desk.pace, config);
    double before = 0.0;
    std::optional<double> after;
    int writes = 0;
    spy.at_read = [&](int reads) {
      if (reads == 300) {
        before = spy.last.feed_ratio;
        writes = spy.writes;
        desk.pace.now += still_s;
      }
      if (reads > 300 && !after && spy.writes > writes) {
        after = spy.last.feed_ratio;
      }
    };
    loop.run();
    ASSERT_LT(before, 0.6);
    ASSERT_TRUE(after.has_value());
    if (still_s < config.holds_s) {
      EXPECT_NEAR(*after, before, 0.1) << "the machine still holds it";
    } else {
      EXPECT_GT(*after, 0.9) << "from the panel by the slew";
    }
  }
}

TEST(Loop, ALostLinkDoesNotEndIt) {
  Desk desk;
  Spy spy(*desk.port);
  Loop::Config config = until_finished(desk, Mode::act);
  config.most_cycles = 400;
  Loop loop(spy, *desk.layer, desk.pace, config);
  bool shown = false;
  spy.at_read = [&](int reads) {
    spy.lost = reads >= 200 && reads < 250;
    if (reads == 240) {
      const LiveStatus& status = loop.status();
      shown = status.port_fault && std::strcmp(status.port_words.data(), "the link is lost") == 0;
    }
  };
  const LoopFigures figures = loop.run();
  EXPECT_EQ(figures.port_faults, 50U);
  EXPECT_GE(figures.cycles, 400U);
  EXPECT_TRUE(shown);
  EXPECT_FALSE(loop.status().port_fault);
}

TEST(Loop, ALostLinkCountsNoTimeOverTheLimit) {
  Desk desk;
  Spy spy(*desk.port);
  Loop loop(spy, *desk.layer, desk.pace, until_finished(desk, Mode::observe));
  bool known = false;
  bool unknown = false;
  spy.at_read = [&](int reads) {
    spy.lost = reads >= 200 && reads < 250;
    known = known || (reads == 200 && loop.status().error_known);
    unknown = unknown || (reads == 240 && !loop.status().error_known);
  };
  const LoopFigures figures = loop.run();
  EXPECT_EQ(figures.port_faults, 50U);
  EXPECT_TRUE(known);
  EXPECT_TRUE(unknown);
  EXPECT_NEAR(figures.over_limit_s, 0.942 + 0.083, 0.05) << "as without the fault";
}

TEST(Loop, TellsARecordWhereAFaultBegins) {
  Desk desk;
  Spy spy(*desk.port);
  Loop::Config config = until_finished(desk, Mode::act);
  config.most_cycles = 400;
  config.handback_s = 0.001;
  std::vector<std::string> reasons;
  config.on_fault = [&](std::string_view reason) { reasons.emplace_back(reason); };
  Loop loop(spy, *desk.layer, desk.pace, config);
  spy.at_read = [&](int reads) { spy.lost = reads >= 200 && reads < 250; };
  loop.run();
  ASSERT_EQ(reasons.size(), 2U);
  EXPECT_EQ(reasons[0], "kept: the port could not be read or written");
  EXPECT_EQ(reasons[1], "kept: ended before all was handed back");
}

TEST(Loop, GivesUpHandingBackAfterItsTime) {
  Desk desk;
  Spy spy(*desk.port);
  Loop::Config config = until_finished(desk, Mode::act);
  config.handback_s = 0.001;
  Loop loop(spy, *desk.layer, desk.pace, config);
  spy.at_read = [&](int reads) {
    if (reads == 300) {
      loop.ask_stop();
    }
  };
  EXPECT_FALSE(loop.run().handed_back);
}

// What holds the overrides in a thread must not be let go in it.
TEST(Loop, AThreadAtTheEndDoesNotCountAsHandingBack) {
  Desk desk;
  Spy spy(*desk.port);
  Loop::Config config = until_finished(desk, Mode::act);
  config.handback_s = 0.3;
  Loop loop(spy, *desk.layer, desk.pace, config);
  spy.at_read = [&](int reads) {
    spy.motion = reads >= 300 && reads < 1000 ? kernel::signal::Motion::thread
                                              : std::optional<kernel::signal::Motion>();
    if (reads == 400) {
      loop.ask_stop();
    }
  };
  const LoopFigures figures = loop.run();
  EXPECT_TRUE(figures.handed_back);
  EXPECT_GE(figures.cycles, 1000U);
}

TEST(Loop, CountsLatenessWorkOverrunsAndReasons) {
  Desk desk;
  desk.pace.wake = {.lateness_s = 2e-4, .missed = 1};
  desk.pace.work_s = 3e-5;
  Loop::Config config = until_finished(desk, Mode::observe);
  config.most_cycles = 50;
  Loop loop(*desk.port, *desk.layer, desk.pace, config);
  const LoopFigures figures = loop.run();
  EXPECT_EQ(figures.cycles, 50U);
  EXPECT_EQ(figures.overruns, 50U);
  EXPECT_NEAR(figures.work.quantile_s(0.5), 3e-5, 2e-6);
  EXPECT_NEAR(figures.lateness.quantile_s(0.999), 2e-4, 1e-5);
  std::uint64_t all = 0;
  for (const std::uint64_t of : figures.by_reason) {
    all += of;
  }
  EXPECT_GE(all, 50U);
}

TEST(Loop, APortThatWaitsSetsThePace) {
  Desk desk;
  desk.pace.work_s = 3e-3;
  Loop::Config config = until_finished(desk, Mode::observe);
  config.most_cycles = 50;
  config.port_paces = true;
  Loop loop(*desk.port, *desk.layer, desk.pace, config);
  EXPECT_EQ(loop.run().overruns, 0U) << "3 ms of 4";
  EXPECT_EQ(desk.pace.waits, 0);
  EXPECT_EQ(loop.figures().lateness.largest_s(), 0.0);
}

TEST(Loop, APortThatFailsAtOnceSetsNoPace) {
  Desk desk;
  Spy spy(*desk.port);
  spy.lost = true;
  Loop::Config config = until_finished(desk, Mode::observe);
  config.most_cycles = 50;
  config.port_paces = true;
  Loop loop(spy, *desk.layer, desk.pace, config);
  loop.run();
  EXPECT_EQ(desk.pace.waits, 50);
}

TEST(Loop, TellsARecordModesAndCommands) {
  Desk desk;
  Loop::Config config = until_finished(desk, Mode::advise);
  config.most_cycles = 50;
  std::vector<Mode> modes;
  int commands = 0;
  config.on_mode = [&](Mode mode) { modes.push_back(mode); };
  config.on_command = [&](const Command& command) { commands += command.write ? 0 : 1; };
  Loop loop(*desk.port, *desk.layer, desk.pace, config);
  loop.run();
  EXPECT_EQ(modes, (std::vector<Mode>{Mode::advise}));
  EXPECT_EQ(commands, 50);
}

/// A cut in act; at its 300th cycle, in the circle, the file with this limit takes over, if any.
struct Reloaded {
  explicit Reloaded(std::optional<double> limit_mm) {
    Loop::Config config = until_finished(desk, Mode::act);
    config.on_reload = [this](std::uint32_t text) { told = text; };
    config.on_command = [this](const Command& command) { commands.push_back(command); };
    Loop loop(spy, *desk.layer, desk.pace, config);
    kernel::machine::Machine wanted = desk.machine;
    wanted.contour.limit_mm = limit_mm.value_or(wanted.contour.limit_mm);
    Successor next{.machine = wanted,
                   .layer = supervisor::Supervisor::make(wanted, desk.port->capability()).value(),
                   .kept = supervisor::kept(desk.machine, wanted),
                   .text = 7};
    spy.at_read = [&](int reads) {
      if (reads == 300 && limit_mm) {
        loop.offer(next);
      }
    };
    handed_back = loop.run().handed_back;
    taken = loop.taken();
    limit_shown_mm = loop.status().contour_limit_mm;
    EXPECT_FALSE(loop.withdraw());
  }
  Desk desk;
  Spy spy{*desk.port};
  std::vector<Command> commands;
  std::uint32_t told = 0;
  std::uint64_t taken = 0;
  double limit_shown_mm = 0.0;
  bool handed_back = false;
};

TEST(Loop, AReloadOfTheSameFileChangesNoCommand) {
  const Reloaded without(std::nullopt);
  const Reloaded with(without.desk.machine.contour.limit_mm);
  EXPECT_EQ(with.taken, 1U);
  EXPECT_EQ(with.told, 7U);
  ASSERT_EQ(with.commands.size(), without.commands.size());
  for (std::size_t i = 0; i < with.commands.size(); ++i) {
    ASSERT_EQ(with.commands[i].feed_code, without.commands[i].feed_code) << i;
    ASSERT_EQ(with.commands[i].feed_ratio, without.commands[i].feed_ratio) << i;
    ASSERT_EQ(with.commands[i].heartbeat, without.commands[i].heartbeat) << i;
  }
}

TEST(Loop, AReloadWithAnotherLimitGoesThereWithoutAJump) {
  const Reloaded reloaded(0.002);
  EXPECT_EQ(reloaded.taken, 1U);
  EXPECT_TRUE(reloaded.handed_back);
  EXPECT_DOUBLE_EQ(reloaded.limit_shown_mm, 0.002);
  const auto feed = [&](std::size_t cycle) { return reloaded.commands[cycle].feed_ratio; };
  double highest = 0.0;
  for (std::size_t i = 300; i < 320; ++i) {
    EXPECT_TRUE(reloaded.commands[i].write);
    EXPECT_LE(std::abs(feed(i) - feed(i - 1)), 0.11) << "one step of the switch";
    highest = std::max(highest, feed(i));
  }
  EXPECT_LE(highest, feed(299)) << "it does not let go in between";
  EXPECT_LT(feed(400), 0.6 * feed(299)) << "ε goes with the square of the feed";
}

TEST(Loop, AllocatesNothingInTheCycle) {
  Desk desk;
  Loop::Config config = until_finished(desk, Mode::act);
  config.most_cycles = 600;
  Loop loop(*desk.port, *desk.layer, desk.pace, config);
  const kernel::rt::testing::AllocationGuard guard;
  loop.run();
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Loop, TakesPeriodsFromFourKilohertzToAHundredHertz) {
  EXPECT_TRUE(Loop::check({.period_s = 0.00025}));
  EXPECT_TRUE(Loop::check({.period_s = 1.0}));
  EXPECT_FALSE(Loop::check({.period_s = 0.0002}));
  EXPECT_FALSE(Loop::check({.period_s = 1.1}));
  EXPECT_FALSE(Loop::check({.period_s = 0.0}));
}

}  // namespace
}  // namespace steadyrest::live
