// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/plan/speed_table_of.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/trial/cut/chatter_choice.hpp>

// The planner's answer for each spindle speed that the program cuts at, turned into what the layer
// can do: a law, a constant ratio, or nothing.
namespace steadyrest::trial::cut {
namespace {

using chatter::offline::PlanDecision;
using chatter::online::Law;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using nc::plan::PathEventKind;

constexpr double kSameSpeed = 1e-6;  ///< of the speed

bool same(double a, double b) noexcept {
  return std::abs(a - b) <= kSameSpeed * std::max(std::abs(a), std::abs(b));
}

chatter::online::Modulation modulation_of(const chatter::offline::Plan& plan, double speed_rev_s) {
  const chatter::offline::Alternative& chosen = plan.chosen;
  switch (plan.decision) {
    case PlanDecision::constant:
      return {.law = Law::constant, .mean_ratio = chosen.ratio};
    case PlanDecision::law:
      return {.law = chosen.modulation.law,
              .amplitude_ratio = chosen.modulation.rva,
              .period_s = 1.0 / (speed_rev_s * chosen.modulation.rvf)};
    case PlanDecision::keep:
    case PlanDecision::nothing:
      break;
  }
  return {.law = Law::constant};
}

// The layer may not exceed the panel: for a faster spindle the operator must turn his switch up
// first.
double switch_of(const chatter::offline::Alternative& chosen,
                 const kernel::machine::Machine& machine) {
  if (machine.spindle_override.layer_may_exceed_panel) {
    return 1.0;
  }
  const std::vector<double>& written = chosen.demand.written_ratio;
  return std::max(1.0, written.empty() ? chosen.ratio : std::ranges::max(written));
}

}  // namespace

// Speeds that nothing is cut at need no plan; events come before the segment that they act on.
std::vector<double> cutting_speeds(const nc::plan::PlannedPath& path) {
  std::vector<double> speeds;
  double speed_rev_s = 0.0;
  auto event = path.events.begin();
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    for (; event != path.events.end() && event->segment <= i; ++event) {
      if (event->kind == PathEventKind::spindle) {
        speed_rev_s = std::abs(event->value);
      }
    }
    const bool cuts = path.segments[i].motion == kernel::signal::Motion::feed;
    // Under G96 (constant cutting speed) the speed changes along the segment: there is no one speed
    // to plan for.
    const bool known = speed_rev_s > 0.0 && path.plans[i].spindle_rev_s == 0.0;
    if (cuts && known &&
        std::ranges::none_of(speeds, [&](double s) { return same(s, speed_rev_s); })) {
      speeds.push_back(speed_rev_s);
    }
  }
  std::ranges::sort(speeds);
  return speeds;
}

Result<std::vector<ChatterChoice>> choose(
    const chatter::offline::Process& process, const kernel::machine::Machine& machine,
    const std::vector<double>& speeds_rev_s, double depth_mm,
    const std::function<void(double share, std::string_view what)>& progress) {
  if (speeds_rev_s.size() > kMostSpeeds) {
    return refuse(fmt::format("the program cuts at {} spindle speeds; the planner takes {}",
                              speeds_rev_s.size(), kMostSpeeds),
                  "plan each cut with `chatter plan`, or set law and amplitude in [chatter] of the "
                  "machine file");
  }
  std::vector<ChatterChoice> choices;
  const auto count = static_cast<double>(speeds_rev_s.size());
  for (std::size_t i = 0; i < speeds_rev_s.size(); ++i) {
    chatter::offline::PlanOptions options;
    options.progress = [&](double share, std::string_view what) {
      progress((static_cast<double>(i) + share) / count, what);
    };
    // The offline planner, once for each speed: it takes seconds and has no place in the cycle.
    auto plan = chatter::offline::plan(process, machine, speeds_rev_s[i], depth_mm, options);
    if (!plan) {
      return std::unexpected(plan.error());
    }
    choices.push_back({.speed_rev_s = speeds_rev_s[i],
                       .decision = plan->decision,
                       .modulation = modulation_of(*plan, speeds_rev_s[i]),
                       .switch_ratio = switch_of(plan->chosen, machine),
                       .notes = std::move(plan->notes)});
  }
  return choices;
}

const ChatterChoice* choice_for(const std::vector<ChatterChoice>& choices,
                                double programmed_rev_s) noexcept {
  const auto found = std::ranges::find_if(choices, [&](const ChatterChoice& c) {
    return same(c.speed_rev_s, std::abs(programmed_rev_s));
  });
  return found == choices.end() ? nullptr : &*found;
}

Result<supervisor::ListeningStage> listener_for(const chatter::offline::Process& process,
                                                const kernel::machine::Machine& machine,
                                                const std::vector<double>& speeds_rev_s,
                                                double depth_mm, double sensor_rate_hz) {
  constexpr double kMostDepth = 5.0;  // of the wanted one: as deep as the planner looks
  // The detector sees the listening tool only; thresholds are of its sensor, the vibration's
  // velocity.
  constexpr double kSilence_mm_s = 0.1;  // a quieter tool is not in a cut
  chatter::online::BetterSpeed::Config config;
  config.detector.sample_rate_hz = sensor_rate_hz;
  config.detector.teeth = process.tool.teeth;
  config.detector.least_energy = kSilence_mm_s * kSilence_mm_s;
  config.table = chatter::offline::steps_of(machine);
  config.table.teeth = process.tool.teeth;
  // The listener has no operator to ask: steps above 100 % are out of reach.
  if (!machine.spindle_override.layer_may_exceed_panel) {
    config.table.max_ratio = std::min(config.table.max_ratio, 1.0);
  }
  auto added =
      chatter::offline::add_depths(process, speeds_rev_s, kMostDepth * depth_mm, config.table);
  if (!added) {
    return std::unexpected(added.error());
  }
  return supervisor::ListeningStage::make({.better = std::move(config), .depth_mm = depth_mm});
}

// One turn of the switch before the program begins, to the first step that reaches what any of the
// cuts needs.
std::vector<sim::OperatorAction> operator_for(const std::vector<ChatterChoice>& choices,
                                              const kernel::machine::Machine& machine) {
  double wanted = 1.0;
  for (const ChatterChoice& choice : choices) {
    wanted = std::max(wanted, choice.switch_ratio);
  }
  const kernel::machine::OverrideTable& table = machine.spindle_override;
  for (std::size_t i = 0; i < std::min(table.ratio.size(), table.code.size()); ++i) {
    if (wanted > 1.0 && table.ratio[i] >= wanted * (1.0 - kSameSpeed)) {
      return {{.time_s = 0.0, .act = sim::OperatorAct::turn_spindle, .code = table.code[i]}};
    }
  }
  return {};
}

// The room on and idle from the start; the choices tell it what to do.
kernel::machine::Machine with_modulator(kernel::machine::Machine machine) {
  machine.chatter.enabled = true;
  machine.chatter.m_code_on = machine.chatter.m_code_off = 0;
  machine.chatter.amplitude_ratio = 0.0;
  machine.chatter.amplitude_rev_s = 0.0;
  machine.chatter.mean_ratio = 1.0;
  return machine;
}

}  // namespace steadyrest::trial::cut
