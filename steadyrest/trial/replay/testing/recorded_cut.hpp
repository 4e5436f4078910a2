// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/record_writer.hpp>
#include <steadyrest/record/recording_port.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/wish_text.hpp>
#include <steadyrest/trial/listener/listener.hpp>
#include <steadyrest/trial/test/examples.hpp>

namespace steadyrest::trial::replay::testing {

struct RecordedCut {
  std::uint64_t cycles = 0;
  std::uint64_t dropped = 0;
  std::uint64_t reduced = 0;  ///< cycles in which the layer took feed away
  std::uint64_t slowed = 0;   ///< cycles in which it took spindle speed away
  std::vector<supervisor::WishOutcome> outcomes;
};

/// A machine file that takes over during the cut.
struct Takeover {
  std::uint64_t at = 0;  ///< cycle; 0: never
  std::string text;
};

/// What the tool cuts, and the ear of the layer.
struct Heard {
  std::string program = "circle-r10.mpf";
  // NOLINTBEGIN(readability-redundant-member-init)
  std::optional<sim::CuttingVibration::Config> cutting = {};
  std::optional<listener::Listener> listener = {};
  // NOLINTEND(readability-redundant-member-init)
};

/// A layer for the machine file's values, with its ear.
inline supervisor::Supervisor layer_of(const kernel::machine::Machine& machine,
                                       const kernel::port::Capability& capability,
                                       const Heard& heard) {
  const listener::Listener* const ear = heard.listener ? &*heard.listener : nullptr;
  return listener::layer_of(ear, listener::machine_for(ear, machine), capability).value();
}

/// What somebody asks for during the cut.
struct WishAt {
  std::uint64_t at = 0;  ///< cycle
  supervisor::Wish wish;
};

/// Cuts an example with the layer acting, and records it. `lose_at`: the cycle that the record
/// loses; 0: none.
inline RecordedCut record_cut(const std::string& file, const kernel::machine::Machine& machine,
                              std::uint64_t most_cycles, std::uint64_t lose_at = 0,
                              record::RunInfo info = {}, const Takeover& takeover = {},
                              const std::vector<WishAt>& wishes = {}, const Heard& heard = {}) {
  nc::interpret::Config config;
  config.dialect = nc::read::Dialect::sinumerik;
  nc::plan::PathBuilder builder(machine);
  if (!nc::interpret::run_file(trial::test::kExamples + "programs/" + heard.program, config,
                               builder)) {
    return {};
  }
  const auto simulated =
      sim::SimulatedMachine::make(
          {.machine = machine,
           .path = std::make_shared<const nc::plan::PlannedPath>(builder.take().value()),
           .cutting = heard.cutting})
          .value();
  info.machine = machine.name;
  info.program = heard.program;
  info.listener = heard.listener ? listener::text_of(*heard.listener) : "";
  info.cycle_s = layer_cycle_s(machine);
  info.capability = simulated->capability();
  const auto writer = record::RecordWriter::make({.file = file, .info = info}).value();
  auto layer = layer_of(machine, simulated->capability(), heard);
  layer.set_mode(kernel::machine::Mode::act);
  writer->event(record::EventKind::mode, "act");
  record::RecordingPort port(*simulated, *writer);
  RecordedCut cut;
  while (!simulated->finished() && cut.cycles < most_cycles) {
    if (takeover.at > 0 && cut.cycles == takeover.at) {
      const auto wanted = passport::parse(takeover.text, "other.toml").value();
      auto next = layer_of(wanted, simulated->capability(), heard);
      next.take_over(layer, supervisor::kept(machine, wanted));
      layer = std::move(next);
      writer->event(record::EventKind::reload, writer->hold(takeover.text));
    }
    for (const WishAt& asked : wishes) {
      if (asked.at == cut.cycles) {
        const auto outcome = supervisor::grant(layer, asked.wish);
        cut.outcomes.push_back(outcome);
        writer->event(record::EventKind::wish, supervisor::text_of(asked.wish, outcome).view());
      }
    }
    const auto command = layer.cycle(port, {}).value();
    if (++cut.cycles == lose_at) {
      kernel::signal::Frame lost;
      const std::vector<double> too_many(record::kMaxVibration + 1);
      lost.vibration = too_many;
      writer->add(lost, command);
    } else {
      port.record(command);
    }
    cut.reduced += command.feed_ratio < 1.0 ? 1 : 0;
    cut.slowed += command.spindle_ratio < 1.0 ? 1 : 0;
    // The simulation is faster than any machine; the ring is made for a real one.
    if (cut.cycles % 1000 == 0) {
      writer->flush();
    }
  }
  cut.dropped = writer->dropped();
  return cut;
}

}  // namespace steadyrest::trial::replay::testing
