// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/trial/timing/demanding_path.hpp>
#include <steadyrest/trial/timing/layer_timing.hpp>

// The time of a layer cycle on this computer. The run is deterministic, so cycle n does the same
// work in each round: its shortest time over the rounds is its cost, the rest was the operating
// system's.
namespace steadyrest::trial::timing {
namespace {

using kernel::machine::Machine;
using kernel::outcome::Result;
using Clock = std::chrono::steady_clock;
using Path = std::shared_ptr<const nc::plan::PlannedPath>;

constexpr double kDecision_s = 0.010;  ///< the governor's own longest time between two decisions
// Rare enough that showing it costs nothing.
constexpr std::size_t kCyclesBetweenProgress = 1024;

/// The shortest time of each cycle, and whether the governor decided in it.
struct Cycle {
  double least_s = 0.0;
  bool decides = false;
};

Result<void> run_round(const Machine& machine, const Path& path, std::size_t most_decisions,
                       std::vector<Cycle>& cycles,
                       const std::function<void(double share)>& on_progress) {
  auto port = sim::SimulatedMachine::make({.machine = machine, .path = path});
  if (!port) {
    return std::unexpected(std::move(port.error()));
  }
  auto layer = supervisor::Supervisor::make(machine, (*port)->capability());
  if (!layer) {
    return std::unexpected(std::move(layer.error()));
  }
  layer->set_mode(kernel::machine::Mode::act);
  std::size_t decisions = 0;
  for (std::size_t n = 0; decisions < most_decisions && !(*port)->finished(); ++n) {
    const auto frame = (*port)->read();
    if (!frame) {
      return std::unexpected(frame.error());
    }
    // Reading and writing are the port's business and are not timed.
    const auto begin = Clock::now();
    const kernel::signal::Command command = layer->update(*frame);
    const double took_s = std::chrono::duration<double>(Clock::now() - begin).count();
    if (auto written = (*port)->write(command); !written) {
      return written;
    }
    const auto& contour = layer->estimates().contour;
    const bool decides = contour && contour->decided;
    decisions += decides ? 1 : 0;
    if (n == cycles.size()) {
      cycles.push_back({.least_s = took_s, .decides = decides});
    }
    // Interrupts can only add: the shortest time is closest to the work.
    cycles[n].least_s = std::min(cycles[n].least_s, took_s);
    if (n % kCyclesBetweenProgress == 0) {
      on_progress(static_cast<double>(decisions) / static_cast<double>(most_decisions));
    }
  }
  return {};
}

}  // namespace

// Rounds repeat the same run; cycles line up by number.
Result<LayerTiming> time_layer(const Machine& machine, const Effort& effort,
                               const std::function<void(double share)>& on_progress) {
  LayerTiming timing;
  timing.cycle_s = layer_cycle_s(machine);
  timing.rounds = effort.rounds;
  // Long enough for the requested number of decisions to fall due.
  const double apart_s = std::max(timing.cycle_s, kDecision_s);
  const auto path = demanding_path(machine, static_cast<double>(effort.decisions) * apart_s);
  if (!path) {
    return std::unexpected(path.error());
  }
  std::vector<Cycle> cycles;
  for (int round = 0; round < effort.rounds; ++round) {
    auto done = run_round(machine, *path, effort.decisions, cycles,
                          [&](double share) { on_progress((round + share) / effort.rounds); });
    if (!done) {
      return std::unexpected(std::move(done.error()));
    }
  }
  std::vector<double> work_s;
  std::vector<double> decision_s;
  for (const Cycle& cycle : cycles) {
    work_s.push_back(cycle.least_s);
    if (cycle.decides) {
      decision_s.push_back(cycle.least_s);
    }
  }
  timing.cycles = work_s.size();
  timing.decisions = decision_s.size();
  timing.work_s = quantiles(std::move(work_s));
  timing.decision_s = quantiles(std::move(decision_s));
  return timing;
}

}  // namespace steadyrest::trial::timing
