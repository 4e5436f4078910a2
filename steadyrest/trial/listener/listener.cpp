// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <utility>

#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/plan/speed_table_of.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/sim/cut/cutting_vibration.hpp>
#include <steadyrest/trial/listener/listener.hpp>

namespace steadyrest::trial::listener {
namespace {

using chatter::online::SpeedTable;
using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kSpeedOfControl = 0.001;  // what a control says of it may be off, relative
constexpr double kMostDepth = 5.0;         ///< of the wanted one: the planner's search depth
constexpr double kSlowestShare = 0.2;  ///< of the fastest speed: slower ones have countless lobes
constexpr double kSilence_mm_s = 0.1;

/// What the machine file says of the steps, and nothing of the process.
void put_limits(const Machine& machine, bool acts, SpeedTable::Config& table) {
  const SpeedTable::Config of = chatter::offline::steps_of(machine);
  table.step_ratio = of.step_ratio;
  table.min_ratio = of.min_ratio;
  table.max_ratio = of.max_ratio;
  table.min_rev_s = of.min_rev_s;
  table.max_rev_s = of.max_rev_s;
  // The listener has no operator to ask: steps above 100 % are out of reach.
  if (!machine.spindle_override.layer_may_exceed_panel) {
    table.max_ratio = std::min(table.max_ratio, 1.0);
  }
  if (!acts && table.step_ratio.empty()) {
    table.step_ratio = {1.0};  // nobody asks for one
  }
}

/// The border as a table, for programmed speeds that nobody knows yet.
Result<void> add_border(const chatter::offline::Process& process, double most_depth_mm,
                        SpeedTable::Config& table) {
  const double slowest_rev_s = std::max(table.min_rev_s, kSlowestShare * table.max_rev_s);
  const auto border =
      chatter::offline::border_line(process, {.speed_rev_s = {slowest_rev_s, table.max_rev_s},
                                              .most_depth_mm = most_depth_mm,
                                              .modulation = {}});
  if (!border) {
    return std::unexpected(border.error());
  }
  for (std::size_t i = 0; i < border->speed_rev_s.size(); ++i) {
    table.speed_rev_s.push_back(border->speed_rev_s[i]);
    table.limit_depth_mm.push_back(border->depth_mm[i].value_or(most_depth_mm));
  }
  return {};
}

/// The ear of a layer that was made from machine_for()'s machine.
Result<void> give(const Listener& listener, const Machine& machine, supervisor::Supervisor& layer) {
  const auto cannot_act = [] {
    return refuse("there is no spindle override to act against chatter with",
                  "add [override.spindle] to the machine file, or use --chatter machine");
  };
  supervisor::ListeningStage::Config config = listener.stage;
  std::ranges::transform(listener.modes, std::back_inserter(config.better.modes_hz),
                         &chatter::offline::Mode::frequency_hz);
  put_limits(machine, config.acts, config.better.table);
  if (config.acts && config.better.table.step_ratio.size() < 2) {
    return cannot_act();
  }
  auto stage = supervisor::ListeningStage::make(config);
  if (!stage) {
    return std::unexpected(std::move(stage.error()));
  }
  if (!layer.listen(*stage)) {
    return cannot_act();
  }
  return {};
}

}  // namespace

Sensor simulated_sensor() {
  return {.rate_hz = sim::CuttingVibration::Config{}.sensor_rate_hz, .silence = kSilence_mm_s};
}

Result<supervisor::ListeningStage::Config> stage_for(const chatter::offline::Process& process,
                                                     const Machine& machine,
                                                     const std::vector<double>& speeds_rev_s,
                                                     double depth_mm, const Sensor& sensor) {
  supervisor::ListeningStage::Config stage{.better = {}, .depth_mm = depth_mm};
  chatter::online::BetterSpeed::Config& better = stage.better;
  better.detector.sample_rate_hz = sensor.rate_hz;
  better.detector.teeth = process.tool.teeth;
  better.detector.least_energy = sensor.silence * sensor.silence;
  better.detector.speed_sd = kSpeedOfControl;
  better.detector.folds = chatter::online::Detector::folds_at(sensor.rate_hz);
  better.table.teeth = process.tool.teeth;
  put_limits(machine, stage.acts, better.table);
  const double most_depth_mm = kMostDepth * depth_mm;
  auto added = speeds_rev_s.empty() ? add_border(process, most_depth_mm, better.table)
                                    : chatter::offline::add_depths(process, speeds_rev_s,
                                                                   most_depth_mm, better.table);
  if (!added) {
    return std::unexpected(std::move(added.error()));
  }
  return stage;
}

// The room is on and idle from the start; the choices tell it what to do.
Machine with_modulator(Machine machine) {
  machine.chatter.enabled = true;
  machine.chatter.m_code_on = machine.chatter.m_code_off = 0;
  machine.chatter.amplitude_ratio = 0.0;
  machine.chatter.amplitude_rev_s = 0.0;
  machine.chatter.mean_ratio = 1.0;
  return machine;
}

Machine machine_for(const Listener* listener, Machine machine) {
  const bool acts = listener != nullptr && listener->stage.acts;
  return acts ? with_modulator(std::move(machine)) : machine;
}

Result<supervisor::Supervisor> layer_of(const Listener* listener, const Machine& machine,
                                        const kernel::port::Capability& capability) {
  auto layer = supervisor::Supervisor::make(machine, capability);
  if (layer && listener != nullptr) {
    if (auto given = give(*listener, machine, *layer); !given) {
      return std::unexpected(std::move(given.error()));
    }
  }
  return layer;
}

}  // namespace steadyrest::trial::listener
