// SPDX-License-Identifier: Apache-2.0
// The laws that every port keeps. A new port joins with one line in the list at the end.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tests/ports/subject.hpp>

#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::ports {
namespace {

using kernel::outcome::Kind;
using kernel::signal::Command;
using kernel::signal::Frame;

constexpr double kTolerance = 1e-9;
constexpr int kFrames = 500;

/// A port with the command that it gets in each cycle.
class Session {
 public:
  explicit Session(Subject subject) : subject_(std::move(subject)) { command_.write = true; }

  Frame cycle() {
    auto frame = subject_.port->read();
    EXPECT_TRUE(frame.has_value()) << kernel::outcome::text(frame.error());
    if (writes_) {
      ++command_.heartbeat;
      const auto written = subject_.port->write(command_);
      EXPECT_TRUE(written.has_value()) << kernel::outcome::text(written.error());
    }
    return frame ? *frame : Frame{};
  }
  /// The last frame before this time; `each` sees all of them.
  template <class Each>
  Frame until(double time_s, Each each) {
    Frame frame;
    while (frame.time_s < time_s && !testing::Test::HasFailure()) {
      frame = cycle();
      each(frame);
    }
    return frame;
  }
  Frame until(double time_s) {
    return until(time_s, [](const Frame&) {});
  }

  void mask_feed(double ratio) {
    const auto table = kernel::override::Table::make(subject_.machine.feed_override).value();
    const std::size_t step = table.nearest_step(ratio).value();
    EXPECT_NEAR(table.ratio(step), ratio, kTolerance) << "a step of the table";
    command_.feed_ratio = table.ratio(step);
    command_.feed_code = table.code(step);
    command_.feed_masks_panel = true;
  }
  void mask_spindle(double ratio) {
    command_.spindle_ratio = ratio;
    const auto& config = subject_.machine.spindle_override;
    if (!config.ratio.empty()) {
      const auto table = kernel::override::Table::make(config).value();
      command_.spindle_code = table.code(table.nearest_step(ratio).value());
    }
    command_.spindle_masks_panel = true;
  }
  void observe() { writes_ = false; }

  Command& command() { return command_; }
  Subject& subject() { return subject_; }

 private:
  Subject subject_;
  Command command_;
  bool writes_ = true;
};

class PortConformance : public testing::TestWithParam<PortCase> {
 protected:
  static Session session(const std::vector<Turn>& turns = {}) {
    return Session(GetParam().make(turns));
  }
};

TEST_P(PortConformance, TimeAndCyclesRise) {
  Session run = session();
  Frame before = run.cycle();
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = run.cycle();
    ASSERT_GT(frame.time_s, before.time_s);
    ASSERT_GT(frame.cycle, before.cycle);
    before = frame;
  }
}

TEST_P(PortConformance, ValuesAreFiniteAndOfTheWholeMachine) {
  Session run = session();
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = run.cycle();
    ASSERT_EQ(frame.axis_count, run.subject().machine.axes.size());
    for (std::size_t axis = 0; axis < frame.axis_count; ++axis) {
      ASSERT_TRUE(std::isfinite(frame.axis[axis].command_mm));
      ASSERT_TRUE(std::isfinite(frame.axis[axis].actual_mm));
      ASSERT_TRUE(std::isfinite(frame.axis[axis].following_error_mm));
    }
    for (const double value :
         {frame.age_s, frame.path_speed_mm_s, frame.path_position_mm, frame.spindle_actual_rev_s,
          frame.spindle_programmed_rev_s, frame.spindle_command_rev_s}) {
      ASSERT_TRUE(std::isfinite(value));
    }
    for (const auto* state : {&frame.feed, &frame.rapid, &frame.spindle}) {
      ASSERT_GE(state->panel_ratio, 0.0);
      ASSERT_GE(state->effective_ratio, 0.0);
      ASSERT_TRUE(std::isfinite(state->panel_ratio + state->effective_ratio));
    }
    ASSERT_GE(frame.programmed_feed_mm_s, 0.0);
    ASSERT_GE(frame.age_s, 0.0);
  }
}

TEST_P(PortConformance, SpansHoldUntilTheNextRead) {
  Session run = session();
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = run.cycle();
    double length_mm = 0.0;
    for (const auto& segment : frame.path) {
      ASSERT_GE(segment.length_mm, 0.0);
      length_mm += segment.length_mm;
    }
    if (!frame.path.empty()) {
      ASSERT_LT(frame.path_index, frame.path.size());
      ASSERT_GE(frame.path_position_mm, 0.0);
      ASSERT_LE(frame.path_position_mm, length_mm + 1e-6);
    }
    ASSERT_TRUE(frame.vibration.empty() || frame.vibration_rate_hz > 0.0);
  }
}

TEST_P(PortConformance, CapabilityIsConstant) {
  Session run = session();
  const auto first = run.subject().port->capability();
  run.mask_feed(0.5);
  for (int i = 0; i < kFrames; ++i) {
    run.cycle();
    ASSERT_EQ(run.subject().port->capability(), first);
  }
  if (run.subject().cut_link) {
    run.subject().cut_link();
    EXPECT_FALSE(run.subject().port->read().has_value());
    EXPECT_EQ(run.subject().port->capability(), first);
  }
}

TEST_P(PortConformance, ACommandThatMustNotBeWrittenIsRefused) {
  Session written = session();
  Session left_alone = session();
  written.observe();
  left_alone.observe();
  Command command;
  command.feed_ratio = 0.5;
  command.feed_masks_panel = true;
  command.offset_mm[0] = 0.05;
  for (int i = 0; i < kFrames / 2; ++i) {
    const Frame frame = written.cycle();
    const auto answer = written.subject().port->write(command);
    ASSERT_FALSE(answer.has_value());
    EXPECT_EQ(answer.error().kind, Kind::bad_input);
    const Frame other = left_alone.cycle();
    ASSERT_EQ(frame.feed.effective_ratio, other.feed.effective_ratio);
    ASSERT_EQ(frame.axis[0].command_mm, other.axis[0].command_mm);
  }
}

TEST_P(PortConformance, AFeedRatioIsInForceInTimeAndNeverAboveThePanel) {
  Session run = session();
  ASSERT_TRUE(run.subject().port->capability().feed_override);
  const double written_s = run.cycle().time_s + 0.5;
  run.until(written_s, [](const Frame& frame) { ASSERT_EQ(frame.feed.effective_ratio, 1.0); });
  run.mask_feed(0.5);
  const Frame frame = run.until(written_s + run.subject().in_force_s, [](const Frame& seen) {
    ASSERT_LE(seen.feed.effective_ratio, seen.feed.panel_ratio + kTolerance);
  });
  EXPECT_NEAR(frame.feed.effective_ratio, run.subject().obeys ? 0.5 : 1.0, kTolerance);
}

TEST_P(PortConformance, TheLowerOfLayerAndPanelIsInForce) {
  Session run = session({{.time_s = 0.5, .ratio = 0.2}, {.time_s = 1.0, .ratio = 0.8}});
  const double late_s = run.subject().in_force_s;
  run.mask_feed(0.5);
  run.until(0.5 + late_s);
  run.until(0.95, [](const Frame& frame) {
    ASSERT_NEAR(frame.feed.panel_ratio, 0.2, kTolerance);
    ASSERT_NEAR(frame.feed.effective_ratio, 0.2, kTolerance);
  });
  run.until(1.0 + late_s);
  const double expected = run.subject().obeys ? 0.5 : 0.8;
  run.until(1.5, [expected](const Frame& frame) {
    ASSERT_NEAR(frame.feed.panel_ratio, 0.8, kTolerance);
    ASSERT_NEAR(frame.feed.effective_ratio, expected, kTolerance);
  });
}

TEST_P(PortConformance, ThePanelAtZeroStops) {
  Session run = session({{.time_s = 0.5, .ratio = 0.0}});
  run.mask_feed(0.5);
  const double stopped_s = 0.5 + run.subject().in_force_s;
  EXPECT_GT(run.until(0.45).path_speed_mm_s, 1.0);
  run.until(stopped_s);
  const Frame stopped = run.until(
      stopped_s + 0.5, [](const Frame& frame) { ASSERT_EQ(frame.feed.effective_ratio, 0.0); });
  EXPECT_EQ(stopped.path_speed_mm_s, 0.0);
}

TEST_P(PortConformance, WithoutAMaskThePanelIsInForceAgain) {
  Session run = session();
  run.mask_feed(0.5);
  run.until(0.5);
  run.command().feed_masks_panel = false;
  double before = run.subject().obeys ? 0.5 : 1.0;
  const Frame last = run.until(1.0, [&before](const Frame& frame) {
    ASSERT_GE(frame.feed.effective_ratio, before - kTolerance) << "only upwards";
    before = frame.feed.effective_ratio;
  });
  EXPECT_NEAR(last.feed.effective_ratio, 1.0, kTolerance);
}

TEST_P(PortConformance, SpindleAndOffsetsActWhereThePortTakesThem) {
  Session plain = session();
  Session asked = session();
  const auto can = asked.subject().port->capability();
  const bool obeys = asked.subject().obeys;
  asked.mask_spindle(0.8);
  asked.command().offset_mm[1] = 0.02;
  asked.command().path_offset_mm[2] = 0.02;
  const Frame without = plain.until(1.0);
  const Frame with = asked.until(1.0);
  EXPECT_NEAR(with.spindle.effective_ratio, obeys && can.spindle_override ? 0.8 : 1.0, kTolerance);
  const auto moved_mm = [&](std::size_t axis) {
    return with.axis[axis].actual_mm - without.axis[axis].actual_mm;
  };
  EXPECT_NEAR(moved_mm(0), 0.0, 1e-9);
  EXPECT_NEAR(moved_mm(1), obeys && can.axis_offset ? 0.02 : 0.0, 0.004);
  EXPECT_NEAR(moved_mm(2), obeys && can.path_offset ? 0.02 : 0.0, 0.004);
}

TEST_P(PortConformance, ALostLinkIsUnavailableAndNothingBreaks) {
  Session run = session();
  Subject& subject = run.subject();
  if (!subject.cut_link) {
    // It has no link: it must go on for good.
    for (int i = 0; i < 4 * kFrames; ++i) {
      ASSERT_TRUE(subject.port->read().has_value());
    }
    return;
  }
  const double before_s = run.cycle().time_s;
  subject.cut_link();
  for (int i = 0; i < 10; ++i) {
    const auto frame = subject.port->read();
    ASSERT_FALSE(frame.has_value());
    EXPECT_EQ(frame.error().kind, Kind::unavailable);
    EXPECT_FALSE(frame.error().what.empty());
    EXPECT_FALSE(frame.error().to_do.empty());
    static_cast<void>(subject.port->write(run.command()));
  }
  if (subject.mend_link) {
    subject.mend_link();
    EXPECT_GT(run.cycle().time_s, before_s);
  }
}

TEST_P(PortConformance, AllocatesNothingInTheCycle) {
  Session run = session();
  run.mask_feed(0.5);
  run.cycle();
  kernel::rt::testing::AllocationGuard guard;
  for (int i = 0; i < kFrames; ++i) {
    run.cycle();
  }
  if (!run.subject().in_cycle) {
    guard.forgive();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Every, PortConformance,
    testing::Values(PortCase{"fake", fake},                                       //
                    PortCase{"lines", on_lines},                                  //
                    PortCase{"linuxcnc", on_linuxcnc},                            //
                    PortCase{"linuxcnc_with_offsets", on_linuxcnc_with_offsets},  //
                    PortCase{"opcua", on_opcua},                                  //
                    PortCase{"replay", replayed},                                 //
                    PortCase{"sim", simulated},                                   //
                    PortCase{"sim_without_offsets", simulated_without_offsets}),
    [](const testing::TestParamInfo<PortCase>& port) { return std::string(port.param.name); });

}  // namespace
}  // namespace steadyrest::ports
