// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/trial/cut/chatter_choice.hpp>
#include <steadyrest/trial/listener/listener.hpp>

// Turns the planner's answer for each cutting spindle speed into what the layer can do: a law, a
// constant ratio, or nothing.
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

// The layer may not exceed the panel: for a faster spindle the operator must first turn his switch
// up.
double switch_of(const chatter::offline::Alternative& chosen,
                 const kernel::machine::Machine& machine) {
  if (machine.spindle_override.layer_may_exceed_panel) {
    return 1.0;
  }
  const std::vector<double>& written = chosen.demand.written_ratio;
  return std::max(1.0, written.empty() ? chosen.ratio : std::ranges::max(written));
}

/// visit(segment, spindle speed, whether G96 changes it) for each cutting segment; events come
/// before the segment that they act on.
template <class Visit>
void for_each_cut(const nc::plan::PlannedPath& path, const Visit& visit) {
  double speed_rev_s = 0.0;
  auto event = path.events.begin();
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    for (; event != path.events.end() && event->segment <= i; ++event) {
      if (event->kind == PathEventKind::spindle) {
        speed_rev_s = std::abs(event->value);
      }
    }
    const double by_radius = std::abs(path.plans[i].spindle_rev_s);
    if (path.segments[i].motion == kernel::signal::Motion::feed) {
      visit(i, by_radius > 0.0 ? by_radius : speed_rev_s, by_radius > 0.0);
    }
  }
}

/// The slowest instant of a law is its lower turning point.
double least_ratio(const chatter::online::Modulation& m) noexcept {
  return m.law == Law::constant ? m.mean_ratio : m.mean_ratio * (1.0 - m.amplitude_ratio);
}

}  // namespace

// Speeds without a cut need no plan.
std::vector<double> cutting_speeds(const nc::plan::PlannedPath& path) {
  std::vector<double> speeds;
  for_each_cut(path, [&](std::size_t, double speed_rev_s, bool changes) {
    // Under G96 (constant cutting speed) the speed changes along the segment: there is no single
    // speed to plan for.
    if (!changes && speed_rev_s > 0.0 &&
        std::ranges::none_of(speeds, [&](double s) { return same(s, speed_rev_s); })) {
      speeds.push_back(speed_rev_s);
    }
  });
  std::ranges::sort(speeds);
  return speeds;
}

double slowest_cut_rev_s(const nc::plan::PlannedPath& path) {
  const std::vector<double> speeds = cutting_speeds(path);
  double slowest = speeds.empty() ? 0.0 : speeds.front();
  for (const nc::plan::SegmentPlan& plan : path.plans) {
    const double speed = std::abs(plan.spindle_rev_s);
    if (speed > 0.0 && !plan.rapid) {
      slowest = slowest > 0.0 ? std::min(slowest, speed) : speed;
    }
  }
  return slowest;
}

std::vector<nc::plan::Warning> unplanned_cuts(const nc::plan::PlannedPath& path) {
  struct Stretch {
    std::uint32_t first, last;
    double least_rev_s, most_rev_s;
  };
  std::vector<Stretch> all;
  bool open = false;
  for_each_cut(path, [&](std::size_t i, double speed_rev_s, bool changes) {
    const std::uint32_t line = path.segments[i].line;
    if (changes && !open) {
      all.push_back({line, line, speed_rev_s, speed_rev_s});
    }
    open = changes;
    if (changes) {
      Stretch& at = all.back();
      // A subprogram or a loop jumps back.
      at = {std::min(at.first, line), std::max(at.last, line),
            std::min(at.least_rev_s, speed_rev_s), std::max(at.most_rev_s, speed_rev_s)};
    }
  });
  std::vector<nc::plan::Warning> out;
  for (const Stretch& s : all) {
    if (std::ranges::any_of(out, [&](const auto& w) { return w.line == s.first; })) {
      continue;
    }
    out.push_back(
        {s.first,
         fmt::format(
             "under G96 the spindle speed changes{} ({:.0f} … {:.0f} rpm at the moves' mean "
             "radii), so nothing is planned against chatter here; see `chatter lobes` over "
             "these speeds",
             s.last > s.first ? fmt::format(" up to line {}", s.last) : "",
             kernel::units::rpm_from_rev_s(s.least_rev_s),
             kernel::units::rpm_from_rev_s(s.most_rev_s))});
  }
  return out;
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
    // The offline planner, once per speed: it takes seconds and has no place in the cycle.
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

double least_spindle_ratio(const std::vector<ChatterChoice>& choices, bool listens,
                           const kernel::machine::Machine& machine) {
  // Nothing below the switch's lowest position can be written; 0 % is a stop, not a speed.
  double floor = 1.0;
  for (const double step : machine.spindle_override.ratio) {
    floor = step > 0.0 ? std::min(floor, step) : floor;
  }
  floor = std::clamp(machine.envelope.min_spindle_ratio, floor, 1.0);
  double least = listens ? floor : 1.0;
  for (const ChatterChoice& choice : choices) {
    least = std::min(least, least_ratio(choice.modulation));
  }
  const kernel::machine::Chatter& c = machine.chatter;
  if (c.enabled) {
    // The share of an amplitude in rev/min depends on the programmed speed.
    least =
        std::min(least, c.amplitude_rev_s > 0.0 ? floor : c.mean_ratio * (1.0 - c.amplitude_ratio));
  }
  return std::clamp(least, floor, 1.0);
}

Result<supervisor::ListeningStage> listener_for(const chatter::offline::Process& process,
                                                const kernel::machine::Machine& machine,
                                                const std::vector<double>& speeds_rev_s,
                                                double depth_mm) {
  const auto stage =
      listener::stage_for(process, machine, speeds_rev_s, depth_mm, listener::simulated_sensor());
  if (!stage) {
    return std::unexpected(stage.error());
  }
  return supervisor::ListeningStage::make(*stage);
}

// One turn of the switch before the program begins, to the first step that is enough for every cut.
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

}  // namespace steadyrest::trial::cut
