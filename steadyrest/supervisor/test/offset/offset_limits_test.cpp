// SPDX-License-Identifier: Apache-2.0
// Offsets under changing limits: reloads and restarts with other machine files, offsets of both
// kinds at once, slopes of every size. Judged at the port, in the cut.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

namespace signal = kernel::signal;
using kernel::machine::Machine;
using kernel::machine::Mode;
using kernel::outcome::Reason;
using kernel::units::kNan;
using test::kCycle_s;

constexpr kernel::port::Capability kOffsets{.feed_override = true,
                                            .spindle_override = true,
                                            .axis_offset = true,
                                            .path_offset = true,
                                            .latched_word = true};

/// Limits of every size, also none, also a heat that may move faster than the path's offset.
Machine limited() {
  Machine machine = test::mill(Mode::act);
  machine.contour.enabled = false;
  machine.thermal.enabled = false;
  auto& e = machine.envelope;
  e.max_offset_mm = *rc::gen::element(0.0, 0.01, 0.1, 0.5);
  e.max_path_offset_mm = *rc::gen::element(0.0, 0.01, 0.1, 0.5);
  e.offset_slew_mm_s = *rc::gen::element(0.05, 1.0, 20.0);
  e.path_offset_slew_mm_s = *rc::gen::element(0.5, 5.0, 50.0);
  return machine;
}

/// A layer in the cut, and what its machine has.
struct LimitedCut {
  explicit LimitedCut(const Machine& of) : machine(of) { start(); }

  void start() { layer.emplace(Supervisor::make(machine, kOffsets).value()); }
  void ask() {
    for (auto* requests : {&heat, &path}) {
      signal::OffsetRequest request{.reason = *rc::gen::element(Reason::contour_cancelled,
                                                                Reason::none, Reason::input_stale)};
      for (std::size_t i = 0; i < 3; ++i) {
        request.offset_mm[i] = 1e-3 * *rc::gen::inRange(-700, 700);
        request.slope_mm_s[i] = *rc::gen::element(0.0, 0.02, 2.0, 100.0, kNan);
      }
      *requests = {request};
    }
  }
  void cycle() {
    time_s += kCycle_s;
    signal::Frame frame;
    frame.time_s = time_s;
    frame.motion = signal::Motion::feed;
    frame.feed.panel_ratio = frame.spindle.panel_ratio = 1.0;
    command =
        layer->update(frame, {.feed = {}, .spindle = {}, .offset = heat, .path_offset = path});
    if (command.write) {
      judge();
    }
  }
  void judge() {
    const auto& e = machine.envelope;
    const double passed_s = time_s - written_s;
    for (std::size_t i = 0; i < 3; ++i) {
      const double heat_mm = command.offset_mm[i];
      const double path_mm = command.path_offset_mm[i];
      RC_ASSERT(std::abs(heat_mm - heat_before_mm[i]) <= e.offset_slew_mm_s * passed_s + 1e-12);
      RC_ASSERT(std::abs(path_mm - path_before_mm[i]) <=
                e.path_offset_slew_mm_s * passed_s + 1e-12);
      // Within the limits, or on the way there from wider ones.
      RC_ASSERT(std::abs(heat_mm) <= std::max(e.max_offset_mm, std::abs(heat_before_mm[i])));
      const double sum_mm = std::abs(heat_mm + path_mm);
      const double sum_before_mm = std::abs(heat_before_mm[i] + path_before_mm[i]);
      const double allowed_mm = std::max(e.max_path_offset_mm, std::abs(heat_mm));
      RC_ASSERT(sum_mm <= std::max({allowed_mm, std::abs(path_mm), sum_before_mm}) + 1e-12);
    }
    heat_before_mm = command.offset_mm;
    path_before_mm = command.path_offset_mm;
    written_s = time_s;
  }

  Machine machine;
  std::optional<Supervisor> layer;
  std::vector<signal::OffsetRequest> heat;
  std::vector<signal::OffsetRequest> path;
  signal::Command command;
  signal::AxisValues heat_before_mm{};
  signal::AxisValues path_before_mm{};
  double time_s = 0.0;
  double written_s = 0.0;
};

RC_GTEST_PROP(OffsetLimits, NothingJumpsWhateverLimitsARestartOrAReloadBrings, ()) {
  LimitedCut cut(limited());
  for (int act = 0; act < 12; ++act) {
    cut.ask();
    const int cycles = *rc::gen::inRange(1, 120);
    for (int i = 0; i < cycles; ++i) {
      cut.cycle();
    }
    const Machine before = cut.machine;
    switch (*rc::gen::inRange(0, 3)) {
      case 0: {  // another file, then the process starts again
        const auto state = cut.layer->state();
        cut.machine = limited();
        cut.start();
        cut.layer->restore(state);
        break;
      }
      case 1: {  // another file, between two cycles
        cut.machine = limited();
        auto old = std::move(*cut.layer);
        cut.start();
        cut.layer->take_over(old, kept(before, cut.machine));
        break;
      }
      default:
        break;
    }
  }
}

// Each lowered limit is reached and kept, in the cut, whatever is asked for.
RC_GTEST_PROP(OffsetLimits, ALowerLimitIsReachedAfterARestart, ()) {
  LimitedCut cut(limited());
  cut.ask();
  for (int i = 0; i < 300; ++i) {
    cut.cycle();
  }
  const auto state = cut.layer->state();
  cut.machine = limited();
  cut.start();
  cut.layer->restore(state);
  const auto& e = cut.machine.envelope;
  const double way_s = 0.5 / e.offset_slew_mm_s + 1.0 / std::min(e.path_offset_slew_mm_s, 20.0);
  for (double t_s = 0.0; t_s < 2.0 * way_s; t_s += kCycle_s) {
    cut.cycle();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    RC_ASSERT(std::abs(cut.command.offset_mm[i]) <= e.max_offset_mm + 1e-12);
    RC_ASSERT(std::abs(cut.command.path_offset_mm[i]) <= e.max_path_offset_mm + 1e-12);
  }
}

// A state that cannot have been in force says nothing about the machine: silent for the watchdog's
// time, then from 0.
TEST(OffsetLimits, AnImpossibleStateIsWaitedOut) {
  Machine machine = test::mill(Mode::act);
  machine.contour.enabled = false;
  machine.thermal.enabled = false;
  LimitedCut cut(machine);
  cut.heat = {{.reason = Reason::contour_cancelled}};
  cut.heat[0].offset_mm[0] = 0.02;
  for (int i = 0; i < 500; ++i) {
    cut.cycle();
  }
  auto state = cut.layer->state();
  state.offset.offset_mm[2] = 1e9;
  cut.start();
  cut.layer->restore(state);
  const double last_s = cut.written_s;
  do {
    cut.time_s += kCycle_s;
    signal::Frame frame;
    frame.time_s = cut.time_s;
    frame.motion = signal::Motion::feed;
    frame.feed.panel_ratio = frame.spindle.panel_ratio = 1.0;
    cut.command = cut.layer->update(frame, {});
  } while (!cut.command.write && cut.time_s < 60.0);
  ASSERT_TRUE(cut.command.write);
  EXPECT_GT(cut.time_s - last_s, machine.envelope.stale_after_s);
  EXPECT_LT(cut.time_s - last_s, machine.envelope.stale_after_s + 10.0 * kCycle_s);
  EXPECT_EQ(cut.command.offset_mm, signal::AxisValues{});
}

}  // namespace
}  // namespace steadyrest::supervisor
