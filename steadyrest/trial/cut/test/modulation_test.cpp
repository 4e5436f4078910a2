// SPDX-License-Identifier: Apache-2.0
// The modulator on the simulated machine, from the program's M words to the spindle's true speed.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::trial::cut {
namespace {

namespace machine = kernel::machine;
using kernel::outcome::Reason;
using kernel::signal::Motion;

constexpr double kSpeed_rev_s = 50.0;  // S3000
constexpr double kSlot_mm = 200.0;

// Drive of 50 rev/s² and a triangle of ± 5 rev/s in 2 s: its slope is 10 rev/s², well within.
machine::Machine mill() {
  machine::Machine m;
  m.mode = machine::Mode::act;
  m.axes.resize(3);
  m.axes[1].name = "Y";
  m.axes[2].name = "Z";
  m.feed_override = kernel::override::test::feed_840d();
  m.feed_override.latched_word = false;
  m.rapid_override = m.feed_override;
  m.rapid_override.ratio.back() = 1.2;
  m.spindle_override = kernel::override::test::spindle_840d();
  m.spindle_override.latched_word = false;
  m.spindle_override.layer_may_exceed_panel = true;
  m.spindle.acceleration_rev_s2 = 50.0;
  m.envelope.feed_rise_1_s = 10.0;
  m.contour.enabled = false;
  m.chatter.enabled = true;
  m.chatter.law = machine::SpeedLaw::triangle;
  m.chatter.amplitude_rev_s = 5.0;  // 300 rpm
  m.chatter.period_s = 2.0;
  m.chatter.max_feed_per_tooth_ratio = 1.05;
  return m;
}

/// A slot of 200 mm at F1000: 12 s, modulated unless the program says otherwise.
std::string slot(const std::string& before = "M38", const std::string& after = "M39") {
  return "G21 G90 G94 S3000 M3\nG0 X0 Y0 Z0\n" + before + "\nG1 X200 F1000\n" + after +
         "\nG1 X300\nM2\n";
}

struct Moment {
  kernel::signal::Frame frame;
  kernel::signal::Command command;
  chatter::online::Modulator::Output modulator;
  double true_rev_s = 0.0;
};

std::vector<Moment> play(const machine::Machine& m, const std::string& program,
                         std::vector<sim::OperatorAction> actions = {}, double most_s = 30.0) {
  nc::plan::PathBuilder builder(m);
  nc::interpret::Config control;
  control.axes = "XYZ";
  control.modulation_on = 38;
  control.modulation_off = 39;
  const auto report = nc::interpret::run_text(program, control, builder);
  EXPECT_TRUE(report && report->refused.empty());
  auto path = std::make_shared<const nc::plan::PlannedPath>(builder.take().value());
  auto port = sim::SimulatedMachine::make(
                  {.machine = m, .path = path, .operator_actions = std::move(actions)})
                  .value();
  auto layer = supervisor::Supervisor::make(m, port->capability()).value();
  std::vector<Moment> samples;
  while (!port->finished()) {
    Moment sample;
    sample.frame = port->read().value();
    if (sample.frame.time_s > most_s) {
      break;
    }
    sample.command = layer.update(sample.frame);
    sample.modulator = layer.estimates().chatter.value_or(chatter::online::Modulator::Output{});
    sample.true_rev_s = port->truth().spindle_rev_s;
    if (sample.command.write) {
      EXPECT_TRUE(port->write(sample.command));
    }
    samples.push_back(sample);
  }
  return samples;
}

/// In the slot and after the fade and the first scans.
std::vector<Moment> in_slot(const std::vector<Moment>& all) {
  std::vector<Moment> out;
  for (const auto& s : all) {
    if (s.frame.motion == Motion::feed && s.frame.path_position_mm > 30.0 &&
        s.frame.path_position_mm < kSlot_mm - 1.0) {
      out.push_back(s);
    }
  }
  return out;
}

struct Band {
  double low = 1e9;
  double high = -1e9;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Band speeds(const std::vector<Moment>& samples) {
  Band band;
  for (const auto& s : samples) {
    band.take(s.true_rev_s / kSpeed_rev_s);
  }
  return band;
}

// ± 5 of 50 rev/s are 90 … 110 %. The word moves in steps of 5 %, the drive rounds them off by its
// ramp.
TEST(Modulation, TheSpindleFollowsTheTriangleWithinWhatItsDriveCan) {
  const auto samples = in_slot(play(mill(), slot()));
  ASSERT_GT(samples.size(), 5000U);
  const Band band = speeds(samples);
  EXPECT_NEAR(band.low, 0.90, 0.002);
  EXPECT_NEAR(band.high, 1.10, 0.002);
  double worst = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double change = samples[i].true_rev_s - samples[i - 1].true_rev_s;
    EXPECT_LE(std::abs(change), 50.0 * 0.001 + 1e-9);
    worst = std::max(worst,
                     std::abs(samples[i].true_rev_s / kSpeed_rev_s - samples[i].modulator.ratio));
  }
  // One step of 5 %, a scan of the walk, and the feed that the spindle waits for.
  EXPECT_LT(worst, 0.075);
  EXPECT_GT(worst, 0.02) << "the steps must show";
}

// At 90 % of the speed and full feed each tooth would take 1/0.9 = 111 %; the band allows 105 %,
// so the feed must go down to 94.5 %.
TEST(Modulation, TheFeedPerToothStaysInItsBand) {
  Band band;
  double lowest_feed = 1.0;
  for (const auto& s : in_slot(play(mill(), slot()))) {
    const double feed = s.frame.path_speed_mm_s / s.frame.programmed_feed_mm_s;
    band.take(feed / (s.true_rev_s / kSpeed_rev_s));
    lowest_feed = std::min(lowest_feed, feed);
  }
  EXPECT_LE(band.high, 1.05 + 1e-3);
  EXPECT_GE(band.low, 0.80 - 1e-3);
  EXPECT_LT(lowest_feed, 0.96) << "without the feed 90 % speed would be 111 % per tooth";
}

// Modal like M3: from M38 to M39 and nowhere else.
TEST(Modulation, WithoutItsMWordAndAfterM39TheSpindleStandsStill) {
  for (const auto& s : in_slot(play(mill(), slot("", "")))) {
    ASSERT_FALSE(s.command.spindle_masks_panel);
    ASSERT_NEAR(s.true_rev_s, kSpeed_rev_s, 1e-6);
  }
  const auto all = play(mill(), slot());
  const auto& last = all[all.size() - 200];
  ASSERT_EQ(last.frame.motion, Motion::feed);
  EXPECT_FALSE(last.frame.speed_modulation);
  EXPECT_FALSE(last.command.spindle_masks_panel);
  EXPECT_FALSE(last.command.feed_masks_panel);
  EXPECT_NEAR(last.true_rev_s, kSpeed_rev_s, 1e-6);
}

TEST(Modulation, WithoutAnMWordInTheMachineFileItIsAlwaysOn) {
  auto m = mill();
  m.chatter.m_code_on = m.chatter.m_code_off = 0;
  EXPECT_NEAR(speeds(in_slot(play(m, slot("", "")))).high, 1.10, 0.002);
}

TEST(Modulation, OnlyTheCutIsModulated) {
  for (const auto& s : play(mill(), slot())) {
    if (s.frame.motion != Motion::feed && s.frame.path_position_mm == 0.0) {
      ASSERT_FALSE(s.command.spindle_masks_panel);
      ASSERT_FALSE(kernel::override::is_wish(s.modulator.spindle.reason));
    }
  }
}

// The operator's 0 is for the feed; the spindle must not stop in the cut.
TEST(Modulation, ThePanelAtZeroStopsTheFeedAndTheSpindleGoesOnWithinItsSwitch) {
  // Feed switch to 0 % at 6 s: code of the table's first step.
  const auto samples = play(
      mill(), slot(), {{.time_s = 6.0, .act = sim::OperatorAct::turn_feed, .code = 0b00001}}, 9.0);
  for (const auto& s : samples) {
    if (s.frame.time_s > 6.5) {
      ASSERT_EQ(s.frame.path_speed_mm_s, 0.0);
      ASSERT_EQ(s.command.feed_ratio, 0.0);
    }
  }
}

// Without the right to exceed the panel the swing of ± 20 % of the table lies below the 80 %.
TEST(Modulation, AnOperatorsLowerSwitchWins) {
  auto m = mill();
  m.spindle_override.layer_may_exceed_panel = false;
  // 80 % on the spindle's switch: step 6, Gray code of 7.
  const auto samples = play(
      m, slot(), {{.time_s = 4.0, .act = sim::OperatorAct::turn_spindle, .code = 0b00100}}, 12.0);
  Band band;
  for (const auto& s : samples) {
    if (s.frame.time_s > 5.5 && s.frame.motion == Motion::feed) {
      band.take(s.true_rev_s / kSpeed_rev_s);
    }
  }
  EXPECT_LE(band.high, 0.80 + 1e-6);
  EXPECT_NEAR(band.low, 0.60, 0.01) << "the whole swing moved down";
}

// To the bit: any change of speed in a thread is a spoiled thread.
TEST(Modulation, TappingAndThreadingWithdrawIt) {
  auto m = mill();
  m.chatter.m_code_on = m.chatter.m_code_off = 0;
  const std::string program =
      "G21 G90 G94 S3000 M3\nG0 X0 Y0 Z0\nG1 X60 F1000\nG95\nG33 X100 K1\nG94\nG1 X150 F1000\nM2\n";
  std::size_t threading = 0;
  double first_rev_s = 0.0;
  for (const auto& s : play(m, program)) {
    if (s.frame.motion != Motion::thread) {
      continue;
    }
    ++threading;
    EXPECT_EQ(s.modulator.spindle.reason, Reason::withdrawn_thread);
    first_rev_s = threading == 200 ? s.true_rev_s : first_rev_s;
    if (threading > 200) {
      ASSERT_EQ(s.true_rev_s, first_rev_s) << "the spindle must not move in the thread";
    }
  }
  EXPECT_GT(threading, 300U);
}

// In G95 the control itself keeps the feed per tooth; a second hand would correct twice.
TEST(Modulation, FeedPerRevolutionFollowsTheSpindleByItself) {
  const auto samples =
      in_slot(play(mill(), "G21 G90 G95 S3000 M3\nG0 X0 Y0 Z0\nM38\nG1 X300 F0.333\nM2\n"));
  for (const auto& s : samples) {
    ASSERT_FALSE(s.command.feed_masks_panel);
  }
  EXPECT_NEAR(speeds(samples).low, 0.90, 0.002);
}

}  // namespace
}  // namespace steadyrest::trial::cut
