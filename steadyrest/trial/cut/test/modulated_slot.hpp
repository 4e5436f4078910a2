// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

/// A slot cut with modulation.
namespace steadyrest::trial::cut::test {

namespace machine = kernel::machine;
using kernel::signal::Motion;

inline constexpr double kSpeed_rev_s = 50.0;  // S3000
inline constexpr double kSlot_mm = 200.0;

// Drive of 50 rev/s² and a triangle of ± 5 rev/s in 2 s: its slope is 10 rev/s², well within.
inline machine::Machine mill() {
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
inline std::string slot(const std::string& before = "M38", const std::string& after = "M39") {
  return "G21 G90 G94 S3000 M3\nG0 X0 Y0 Z0\n" + before + "\nG1 X200 F1000\n" + after +
         "\nG1 X300\nM2\n";
}

struct Moment {
  kernel::signal::Frame frame;
  kernel::signal::Command command;
  chatter::online::Modulator::Output modulator;
  double true_rev_s = 0.0;
};

inline std::vector<Moment> play(const machine::Machine& m, const std::string& program,
                                std::vector<sim::OperatorAction> actions = {},
                                double most_s = 30.0) {
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
inline std::vector<Moment> in_slot(const std::vector<Moment>& all) {
  std::vector<Moment> out;
  for (const auto& s : all) {
    if (s.frame.motion == Motion::feed && s.frame.path_position_mm > 30.0 &&
        s.frame.path_position_mm < kSlot_mm - 1.0) {
      out.push_back(s);
    }
  }
  return out;
}

}  // namespace steadyrest::trial::cut::test
